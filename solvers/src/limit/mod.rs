//! Limit analysis: the greatest factor at which rigid blocks can be in admissible equilibrium.
//!
//! [`answer_by`](voussoir_core::limit::answer_by) asks the sequence of questions that leads to every status; an engine
//! solves the three kinds of single optimisation in it. The engines are [`chain`] and [`conic`]. [`sequential`] and [`nonassociated`] use the flow of
//! the laws instead of associated flow.

mod associated;
mod block_program;
pub mod chain;
pub mod conic;
mod equilibrium;
mod nearest;
pub mod nonassociated;
mod recovery;
pub mod sensitivity;
pub mod sequential;
mod settings;
mod settlement;
mod systems;
#[cfg(test)]
mod tests;
mod thrust_zone;

pub use self::thrust_zone::{thrust_zone, zone_costs_little};
