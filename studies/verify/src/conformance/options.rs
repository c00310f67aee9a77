//! Options of the checks.

/// Counts the allocations of a call. Only the global allocator of a program can count them, so a program with a counting
/// allocator passes this function.
pub type CountAllocations = fn(&mut dyn FnMut()) -> u64;

/// Options of the checks.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// Counts allocations. Without it this check is skipped, and the report lists it as skipped.
    pub allocations: Option<CountAllocations>,
}
