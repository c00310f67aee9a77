//! Newton's method for a state, its rates with their modes, and proofs by rates.

pub mod iteration;
pub mod limit_point_test;
pub mod linearised;
pub mod nearby;
pub mod second_order;
pub mod step;
pub mod tangent;
