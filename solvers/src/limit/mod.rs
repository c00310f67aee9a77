//! Limit analysis: the greatest factor at which rigid blocks can be in admissible equilibrium.
//!
//! `question` is the sequence of questions behind every status; an engine answers the three kinds of single optimisation
//! in it. Two engines: [`chain`] and [`conic`]. [`sequential`] and [`nonassociated`] read joints with their laws' own flow
//! instead of the associated one.

mod associated;
mod block_program;
pub mod chain;
pub mod conic;
mod engine;
mod equilibrium;
mod floating;
pub mod nonassociated;
mod question;
mod recovery;
mod scale;
#[cfg(test)]
mod scenes;
pub mod sensitivity;
pub mod sequential;
mod settings;
mod settlement;
mod systems;
#[cfg(test)]
mod tests;
mod thrust_zone;
#[cfg(test)]
mod zone_tests;

pub use self::engine::{Engine, Equilibrium, Greatest};
pub use self::thrust_zone::{thrust_zone, zone_costs_little};
