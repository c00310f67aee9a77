//! Sparse matrices as lists of entries.

/// Entries (row, column, value); repeated entries are added.
pub type Entries = Vec<(usize, usize, f64)>;
