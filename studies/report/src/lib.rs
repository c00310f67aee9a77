//! Drawings, charts, tables, files and pages of results, and the study kinds that write them.
//!
//! Users name the crate `voussoir`, which has all public names.
#![forbid(unsafe_code)]

// Tests use the laws of the project.
#[cfg(test)]
use voussoir_laws as _;

mod conformance;
pub mod difference;
pub mod figures;
pub mod kinds;
pub mod output;
pub mod postprocess;
pub mod writers;
