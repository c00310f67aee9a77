//! Loads of a stage: from what a study says to forces on blocks.

mod place;

pub use place::{BlockName, LOAD, Load, Placed, place};
