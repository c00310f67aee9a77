//! Checks results against their study, and plug-ins against their promises.
//!
//! The check of results reads `results.json`, `resolved.toml` and `path_proofs.jsonl`. It first checks the proofs that need no
//! solver: certificate, bounds, mechanism, thrust line, stages, equilibrium of the last state of a path. If the states
//! of a path are stored, they must prove its end and every number that follows from them.
//!
//! Otherwise the case is solved again, and every number and word is compared. The comparison is bit by bit if the same
//! program on the same kind of processor wrote the results; otherwise only the claims are compared. Counters, seconds
//! and the version are not compared.
#![forbid(unsafe_code)]

// Tests use the laws of the project.
#[cfg(test)]
use voussoir_laws as _;

mod backing;
pub mod conformance;
pub mod path_proofs;
mod same_study;
mod study;

pub use backing::{Backing, BackingCount, backing, resumed};
pub use same_study::{KeyDifference, first_difference, key_differences};
pub use study::{COMPARISON, CheckedCase, added, against, by_itself, solve_again, verify, verify_against};
