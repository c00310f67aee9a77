//! Tests of the limit solvers and of the zone of thrust, and their scenes.

pub mod scenes;
mod solvers;
mod zone;
