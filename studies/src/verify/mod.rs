//! Checks results against their study.
//!
//! The check reads `results.json`, `resolved.toml` and `path_proofs.jsonl`. It first checks the proofs that need no
//! solver: certificate, bounds, mechanism, thrust line, stages, equilibrium of the last state of a path. If the states
//! of a path are stored, they must prove its end and every number that follows from them.
//!
//! Otherwise the case is solved again, and every number and word is compared. The comparison is bit by bit if the same
//! program on the same kind of processor wrote the results; otherwise only the claims are compared. Counters, seconds
//! and the version are not compared.

mod agreement;
mod carried;
pub mod case;
mod curves;
mod events;
pub mod fields;
mod findings;
mod fit;
mod limit;
mod meaning;
mod mechanism;
mod path;
pub mod path_proofs;
pub mod repeat;
mod same_study;
mod study;
mod texts;
pub mod tolerances;

pub use agreement::Agreement;
pub use fit::misfits;
pub use same_study::{KeyDifference, first_difference, key_differences};
pub use study::{COMPARISON, CheckedCase, added, against, by_itself, solve_again, verify, verify_against};
