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

voussoir_core::inventory::submit! {
    voussoir_study::results::Build {
        commit: env!("VOUSSOIR_COMMIT"),
        sources: env!("VOUSSOIR_SOURCES"),
        platform: env!("VOUSSOIR_TARGET"),
    }
}

pub mod bench;
pub mod cli;
mod commands;
pub mod prelude;
pub mod serve;

/// Study files: places of keys, mistakes, and the description of keys.
pub mod config {
    pub use voussoir_study::config::common_keys::common_parameters;
    pub use voussoir_study::config::diagnostic::LocatedDiagnostic;
    pub use voussoir_study::config::dotted_key::join;
    pub use voussoir_study::config::key_meaning::{KeyMeaning, key_meaning};
    pub use voussoir_study::config::origin::Origin;
    pub use voussoir_study::config::source_line::with_source;
}

/// Checks that plug-ins keep the promises of their cards and traits. A law of another crate calls
/// [`conform`](conformance::conform) in its own test:
///
/// ```
/// use voussoir::conformance::{Options, conform};
/// use voussoir::core::plugin::{PluginKind, card};
/// let report = conform(card(PluginKind::InterfaceLaw, "coulomb").unwrap(), &Options::default());
/// assert!(report.passed(), "{report}");
/// ```
pub mod conformance {
    pub use voussoir_verify::conformance::*;
}

/// Comparison of two runs.
pub mod difference {
    pub use voussoir_report::difference::*;
}

/// Drawings and charts as SVG, and how numbers and words are written in them.
pub mod figures {
    pub use voussoir_plot::chart::{chart, chart_svg};
    pub use voussoir_plot::panels::panels;
    pub use voussoir_plot::series::{ChartStyle, Marker, Series, Spot};
    pub use voussoir_report::figures::hinges::hinge_list;
    pub use voussoir_report::figures::map::map_svg;
    pub use voussoir_report::figures::{curve_charts, curve_svg, mechanism_svg, scene_svg, sweep_axis, sweep_chart};
    pub use voussoir_study::results::format;
}

/// Study kinds, and studies of any kind.
pub mod kinds {
    pub use voussoir_report::kinds::json_schema::json_schema;
    pub use voussoir_report::kinds::{
        Made, SceneStudy, altered, one_case, read_head, read_source, read_source_beside, read_stored_cases, read_study,
        write_files,
    };
    pub use voussoir_study::kind::*;
    pub use voussoir_verify::{Backing, BackingCount, backing, resumed};
}

/// Loads of a stage, and the dispersion of live loads in the fill.
pub mod loads {
    pub use voussoir_study::loads::{
        Axle, BlockName, LoadKind, LoadSite, LoadTables, Placed, Track, VehicleAxles, fill_layers, footprints,
        load_shape,
    };
    pub use voussoir_study::scenes::dispersion;
}

/// Data derived from results: the order in which joints changed, and displaced meshes with stresses.
pub mod postprocess {
    pub use voussoir_report::postprocess::displaced_mesh::{DisplacedBlock, displaced_blocks};
    pub use voussoir_report::postprocess::joint_events::{JointEvent, JointState, joint_events};
}

/// Results of cases and studies, as they are written to files.
pub mod results {
    pub use voussoir_study::results::{
        BranchEntry, Build, CaseLabel, CaseResult, Comparison, ComparisonCell, ComparisonRow, DisplacementEntry,
        EndProof, EventEntry, FORMAT, FieldEntry, FillEntry, FinishedCases, FiniteEntry, FollowedTo, HEAD,
        IntervalEntry, KindEntries, LimitPointEntry, LoadEntry, LoadFactorError, LoadOrigin, MAX_SHOWN, MapAxes,
        MotionEntry, NextState, NonAssociatedAnswer, OptimumEntry, Origin, OutputColumn, OutputEntry, PathRecord,
        PlaceEntry, PluginCrate, Proof, ProofFields, RESULTS_SCHEMA, SensitivityEntry, StabilityEntry, StageResult,
        StateEntry, StoredEntry, StoredOutline, StudyResults, TakeCases, Totals, WorstEntry, YieldedEntry, carried,
        head, inelastic_state, least_of, load_rank, other_limit_point, sealed_line, stored_path, this_program,
        without_origin, words,
    };
}

/// From a case to its certified result.
pub mod solve {
    pub use voussoir_study::cases::*;
    pub use voussoir_study::solve::CaseInput;
    pub use voussoir_study::solve::auto::{limit_solvers, path_solvers};
    pub use voussoir_study::solve::explain::explain;
}

/// Studies, their files and their cases.
pub mod study {
    pub use voussoir_study::file::*;
    pub use voussoir_study::study::*;
}

/// Checks of results.
pub mod verify {
    pub use voussoir_study::checks::{Agreement, case, misfits, tolerances};
    pub use voussoir_verify::{
        COMPARISON, CheckedCase, KeyDifference, added, against, by_itself, first_difference, key_differences,
        solve_again, verify, verify_against,
    };
}

/// Result files.
pub mod writers {
    pub use voussoir_report::output::{SceneOutput, StudyOutput, columns};
    pub use voussoir_report::writers::vtu;
    pub use voussoir_report::writers::{CaseTable, Writer, WriterEntry, tables, writers, written};
}

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
