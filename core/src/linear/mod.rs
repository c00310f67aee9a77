//! Sparse factorisations: the only files that know faer.

mod cholesky;
mod entries;
mod ldlt;
mod lu;

pub use self::cholesky::{SparseCholesky, elimination_order};
pub use self::entries::Entries;
pub use self::ldlt::SparseLdlt;
pub use self::lu::{Analysis, SparseLu};
