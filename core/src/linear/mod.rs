//! Sparse factorisations: faer's (the only files that know it), and two of our own, along a chain of bodies and by blocks of 3 × 3.

mod cholesky;
mod entries;
mod frontal;
mod ldlt;
mod lu;
mod ordering;
mod panel;
mod supernodes;
#[doc(hidden)]
pub mod vectors;

pub use self::cholesky::BlockCholesky;
pub use self::entries::Entries;
pub use self::frontal::{FrontRows, FrontalLu};
pub use self::ldlt::SparseLdlt;
pub use self::lu::{Analysis, SparseLu};
pub use self::ordering::elimination_order;
