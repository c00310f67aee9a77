//! Compares the results of two runs: cases, statuses, loads, mechanisms, limit points, and the keys of the studies.
//!
//! [`StoredRun::read`] reads a results.json; [`compare`] returns a [`RunDifference`].

mod compare;
mod stored;
mod text;

pub use compare::{CaseDifference, CaseName, Change, RunDifference, compare};
pub use stored::{StoredCase, StoredRun};
