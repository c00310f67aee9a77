//! Newton's method for a state, its rates with their modes, and proofs by rates.

pub mod active_set;
pub mod iteration;
pub mod linearised;
pub mod nearby;
pub mod rate_after_event;
pub mod responses;
pub mod second_order;
pub mod step;
pub mod tangent;
