//! `limit_sequential`: a non-associated load by sequential linear programming.
#![doc = include_str!("limit_sequential.md")]

mod sequence;
mod solver;
mod vertices;

pub use self::sequence::{FlowState, Sequence, sequence};
pub use self::solver::LimitSequential;
