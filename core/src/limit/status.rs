//! The end of a stage, the proof of its greatest factor, and counts of work.

use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;

/// The end of a stage. The certificate decides it; the status in a solver's answer is a hint.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The structure carries the target of the stage: an admissible state at the target proves it.
    Stands,
    /// The structure collapses at a factor that both bounds enclose.
    Collapse,
    /// The structure carries any factor: a ray proves it.
    Unbounded,
    /// The loads present before the stage begins cannot be carried: a motion proves it.
    NoEquilibrium,
    /// A proved maximum of the stage's parameter, at which the path ends.
    LimitPoint,
    /// A number is proved, but not the statement that was asked for: `bounds` holds the proved ends.
    Open,
    /// No claim is proved; the notes give the reason.
    #[default]
    Stalled,
}

impl Status {
    /// Returns true if the status is neither open nor stalled.
    pub fn is_answer(self) -> bool {
        !matches!(self, Status::Open | Status::Stalled)
    }
}

/// The proof of the greatest factor of the last stage (of the least one if joints have their own flow).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Greatest {
    /// A lower and an upper bound meet, or a proof shows that there is no such factor.
    ProvedOptimal,
    /// Both bounds of a least load are proved and differ.
    Bracketed,
    /// It is the greatest factor of a path within the range that was followed.
    ProvedOnThePath,
    /// At least one end is not proved.
    #[default]
    Open,
}

/// Counts of work done, by name.
pub type Counters = BTreeMap<String, u64>;
