//! Voussoir: stability and collapse of masonry made of blocks.
//!
//! You can read a study from a text, a file or a value with the same keys, or build it step by step. Its results are typed
//! and contain their proofs:
//!
//! ```
//! use voussoir::prelude::*;
//!
//! let study = Study::builder("strathmashie")
//!     .scene("arch", json!({
//!         "profile": { "shape": "segmental", "span": 9.42, "rise": 2.99 },
//!         "thickness": 0.60, "width": 5.81, "voussoirs": 15, "ends": "bonded",
//!         "material": "stone", "joint": "dry",
//!     }))
//!     .material("stone", "rigid", json!({ "density": 2200.0 }))
//!     .joint("dry", "coulomb_associated", json!({ "friction": 0.6 }))
//!     .gravity(9.81)
//!     .until_collapse("live", json!([{ "kind": "point", "span_fraction": 0.25, "force": ["0 N", "-1 kN"] }]))
//!     .build()?;
//! let results = study.run();
//! let case = &results.cases[0];
//! assert_eq!(case.status, Status::Collapse);
//! assert!((case.load_factor.unwrap() - 698.0227).abs() < 1e-4); // [kN]
//! assert!(case.certificate.passed && verify(&study, &results).is_empty());
//! # Ok::<(), StudyError>(())
//! ```
//!
//! | | |
//! |---|---|
//! | [`Study::from_toml`], [`Study::from_file`], [`Study::from_value`], [`Study::builder`] | a study, or a [`StudyError`] with all mistakes in it |
//! | [`Study::run`], [`Study::run_with`] | solves all cases or some of them, in parallel; an [`Observer`](solve::Observer) such as [`Watch`](solve::Watch) follows the run and can cancel it |
//! | [`StudyResults`], [`CaseResult`] | the content of `results.json`, typed; [`verify()`] checks it |
//! | [`kinds::read_study`], [`kinds::read_source`] with [`study::StudySource`] | a study of any kind, also one without a scene: [`LoadedStudy::run`](kinds::LoadedStudy::run) returns the files that `voussoir run` writes, as bytes |
//! | [`conformance::conform`] | checks that your law keeps the promises of its card and its trait |
//! | [`cli::main`] | the command line, for a program that links its own plug-ins |
//!
//! This crate names every crate that contains plug-ins: the linker drops a crate that no source names, with its plug-ins.
#![forbid(unsafe_code)]

pub mod bench;
mod caught;
pub mod cli;
mod commands;
pub mod config;
pub mod conformance;
pub mod difference;
pub mod figures;
mod fnv;
pub mod kinds;
pub mod loads;
pub mod postprocess;
pub mod prelude;
mod regular_file;
pub mod results;
pub mod scenes;
pub mod serve;
mod side_by_side;
pub mod solve;
pub mod study;
pub mod verify;
pub mod writers;

pub use kinds::RunOptions;
pub use results::{CaseResult, StudyResults};
pub use solve::solve_case;
pub use study::{Case, Study, StudyBuilder, StudyError};
pub use verify::verify;

pub use voussoir_core as core;
#[cfg(feature = "external")]
pub use voussoir_external as external;
pub use voussoir_laws as laws;
pub use voussoir_solvers as solvers;

/// Compiles and runs the Rust examples of the page `library.md` and checks their numbers.
#[cfg(doctest)]
#[doc = include_str!("../../docs/reference/library.md")]
pub struct Page;
