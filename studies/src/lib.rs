//! Voussoir: how masonry made of blocks stands and collapses.
//!
//! The facade: it names every crate that holds plug-ins (a crate that no source names registers
//! nothing) and reads study files, expands them into cases, solves them and writes results.
//!
//! ```
//! let study = voussoir::Study::from_toml(r#"
//!     name = "two blocks"
//!     [scene]
//!     scene = "wall"
//!     width = 1.0
//!     brick = [0.4, 0.2]
//!     courses = 2
//!     bricks = 1
//!     material = "stone"
//!     joint = "dry"
//!     [materials.stone]
//!     law = "rigid"
//!     density = 2000.0
//!     [joints.dry]
//!     law = "coulomb"
//!     friction = 0.6
//!     [[stages]]
//!     name = "dead"
//!     gravity = 9.81
//!     [[stages]]
//!     name = "tilt"
//!     until = "collapse"
//!     loads = [{ kind = "body", acceleration = [9.81, 0.0] }]
//! "#).map_err(|wrong| wrong[0].to_string())?;
//! let result = voussoir::solve_case(&study.cases[0]);
//! assert_eq!(result.status, voussoir::core::limit::Status::Collapse);
//! assert!(result.certificate.passed);
//! let results = study.results("by hand", vec![result]);
//! assert!(voussoir::verify(&study, &results).is_empty());
//! # Ok::<(), String>(())
//! ```
#![forbid(unsafe_code)]

pub mod cli;
mod commands;
pub mod config;
pub mod figures;
pub mod kinds;
pub mod loads;
pub mod postprocess;
pub mod results;
pub mod scenes;
pub mod solve;
pub mod study;
pub mod verify;
pub mod writers;

pub use results::{CaseResult, StudyResults};
pub use solve::solve_case;
pub use study::{Case, Study};
pub use verify::verify;

pub use voussoir_core as core;
pub use voussoir_laws as laws;
pub use voussoir_solvers as solvers;
