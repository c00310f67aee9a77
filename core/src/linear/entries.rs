//! Sparse matrices as they are assembled.

/// Entries (row, column, value); repeated ones add up.
pub type Entries = Vec<(usize, usize, f64)>;
