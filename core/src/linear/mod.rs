//! Sparse factorisations: the only files that know faer.

mod entries;
mod ldlt;
mod lu;

pub use self::entries::Entries;
pub use self::ldlt::SparseLdlt;
pub use self::lu::{Analysis, SparseLu};
