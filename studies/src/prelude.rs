//! The names that a program needs to run a study and to read its results: `use voussoir::prelude::*;`.
//!
//! A study that is built step by step:
//!
//! ```
//! use voussoir::prelude::*;
//! let study = Study::builder("two blocks")
//!     .scene("wall", json!({ "width": 1.0, "brick": [0.4, 0.2], "courses": 2, "bricks": 1, "material": "stone", "joint": "dry" }))
//!     .material("stone", "rigid", json!({ "density": 2000.0 }))
//!     .joint("dry", "coulomb", json!({ "friction": 0.4 }))
//!     .gravity(9.81)
//!     .until_collapse("push", json!([{ "kind": "body", "acceleration": [9.81, 0.0] }]))
//!     .sweep("joints.dry.friction", &[0.4, 0.5])
//!     .build()?;
//! let factors: Vec<_> = study.run().cases.iter().filter_map(|case| case.load_factor).collect();
//! assert!((factors[0] - 0.4).abs() < 1e-9 && (factors[1] - 0.5).abs() < 1e-9);
//! # Ok::<(), StudyError>(())
//! ```
//!
//! A run that stops after the first answer:
//!
//! ```
//! use voussoir::prelude::*;
//! # let study = Study::builder("block")
//! #     .scene("wall", json!({ "width": 1.0, "brick": [0.4, 0.2], "courses": 1, "bricks": 1, "material": "stone", "joint": "dry" }))
//! #     .material("stone", "rigid", json!({ "density": 2000.0 }))
//! #     .joint("dry", "coulomb", json!({ "friction": 0.4 }))
//! #     .gravity(9.81)
//! #     .until_collapse("push", json!([{ "kind": "body", "acceleration": [9.81, 0.0] }]))
//! #     .sweep("joints.dry.friction", &[0.3, 0.4, 0.5])
//! #     .build()?;
//! let watch = Watch::new(|event| !matches!(event, RunEvent::Answered(_)));
//! let results = study.run_with(&RunOptions { observer: &watch, ..RunOptions::default() });
//! assert_eq!(results.cases.len(), 1);
//! # Ok::<(), StudyError>(())
//! ```

pub use serde_json::json;
pub use voussoir_core::limit::Status;
pub use voussoir_study::cases::{Observer, PathProgress, RunEvent, Watch, solve_case};
pub use voussoir_study::file::StudyBuilder;
pub use voussoir_study::kind::RunOptions;
pub use voussoir_study::results::{CaseResult, StudyResults};
pub use voussoir_study::study::{Case, Study, StudyError};
pub use voussoir_verify::verify;
