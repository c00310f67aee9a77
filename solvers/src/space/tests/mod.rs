//! Tests of limit analysis in space: closed forms, invariance, the second route.

mod branching;
mod closed_forms;
pub mod invariance;
pub mod own_flow;
pub mod random;
mod scenes;
mod statuses;
mod strengths;
mod wedging;
