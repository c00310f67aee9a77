//! From a study file to certified results: schema, scenes, loads, cases, solution and certificate. Nothing here draws a figure
//! or writes a file.
//!
//! Users name the crate `voussoir`, which has all public names.
#![forbid(unsafe_code)]

// Tests use the laws of the project.
#[cfg(test)]
use voussoir_laws as _;

pub mod cases;
pub mod caught;
pub mod checks;
pub mod config;
pub mod file;
mod fnv;
pub mod kind;
pub mod loads;
pub mod regular_file;
pub mod results;
pub mod scenes;
pub mod side_by_side;
pub mod solve;
pub mod space;
pub mod study;
