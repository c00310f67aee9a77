//! Voussoir: how masonry made of blocks stands and collapses.
//!
//! The facade: it names every crate that holds plug-ins (a crate that no source names registers
//! nothing) and reads study files, expands them into cases, answers them and writes results.
#![forbid(unsafe_code)]

pub mod answer;
pub mod config;
pub mod deformed;
pub mod figures;
pub mod history;
pub mod kinds;
pub mod loads;
pub mod path;
pub mod plan;
pub mod results;
pub mod scenes;
pub mod study;
pub mod verify;
pub mod writers;
pub mod yielded;

pub use voussoir_core as core;
pub use voussoir_laws as laws;
pub use voussoir_solvers as solvers;
