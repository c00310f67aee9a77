//! What the checks are given besides the law.

/// Counts the allocations of a call. Only the global allocator of the program knows them, so a program that has one that
/// counts hands it in.
pub type CountAllocations = fn(&mut dyn FnMut()) -> u64;

/// What the checks are given besides the law.
#[derive(Debug, Clone, Copy, Default)]
pub struct Options {
    /// Counts allocations; without it that check is not made, and the report says so.
    pub allocations: Option<CountAllocations>,
}
