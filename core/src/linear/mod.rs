//! Sparse factorisations: wrappers of faer (only these files use it), and two of our own, for chains of bodies and for
//! 3 × 3 blocks.

mod cholesky;
mod entries;
mod frontal;
mod ldlt;
mod least_norm;
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
pub use self::least_norm::least_norm;
pub use self::lu::{Analysis, SparseLu};
pub use self::ordering::elimination_order;
