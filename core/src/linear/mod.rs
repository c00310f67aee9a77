//! Sparse factorisations (those of faer: the only files that know it), and one along a chain of bodies.

mod cholesky;
mod entries;
mod frontal;
mod ldlt;
mod lu;
#[doc(hidden)]
pub mod vectors;

pub use self::cholesky::{SparseCholesky, elimination_order};
pub use self::entries::Entries;
pub use self::frontal::{FrontRows, FrontalLu};
pub use self::ldlt::SparseLdlt;
pub use self::lu::{Analysis, SparseLu};
