//! Checking results against the study that they claim to answer, without a solver.
//!
//! Reads only `results.json` and `resolved.toml`. Everything that can be recomputed is recomputed: certificate,
//! bounds, mechanism, thrust line, stages.

mod case;
pub mod fields;
mod findings;
mod limit;
mod mechanism;
mod path;
mod study;

pub use study::verify;
