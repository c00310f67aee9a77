//! Checking results against the study that they claim to answer.
//!
//! Reads only `results.json` and `resolved.toml`. First what the stored numbers prove by themselves, without a
//! solver: certificate, bounds, mechanism, thrust line, stages, equilibrium of the last state of a path. Then every
//! number and word against solving the case again, because a path's history is not stored: only counters, seconds
//! and the version are not looked at.

pub mod case;
pub mod fields;
mod findings;
mod fit;
mod limit;
mod mechanism;
mod path;
pub mod repeat;
mod same_study;
mod study;

pub use fit::misfits;
pub use same_study::first_difference;
pub use study::{StoredCheck, solve_again, verify, verify_against};
