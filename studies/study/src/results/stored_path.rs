//! The stored states and witnesses of a path: a line of `path_proofs.jsonl`, and an entry of journals and parts.
//!
//! Values that follow from these numbers and the study are not stored: gaps, openings, modes, residuals.

use serde::ser::Error;
use serde::{Deserialize, Serialize, Serializer};
use serde_json::value::RawValue;
use std::sync::Arc;
use voussoir_core::limit::Status;
use voussoir_core::path::{FarkasVector, PathRate, PointMode};

/// The file of a result folder with a line for each path whose end is proved.
pub const PATH_PROOFS: &str = "path_proofs.jsonl";

/// A line of the file.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PathLine<P> {
    /// Id of the case.
    pub id: usize,
    /// The hash of the case, as in results.json.
    pub case_hash: String,
    /// Its path: a [`StoredPath`].
    pub path: P,
}

/// The stored path of a case: its numbers, or the text of a journal or a part. The text is longer than all other results of the
/// case, and most readers only copy it.
#[derive(Debug, Clone)]
pub enum PathEntry {
    /// The numbers.
    Numbers(Arc<StoredPath>),
    /// Their JSON, which is checked when it is used.
    Text(Arc<str>),
}

impl PathEntry {
    /// Returns the numbers.
    ///
    /// # Errors
    /// If the text is not a stored path.
    pub fn numbers(&self) -> serde_json::Result<Arc<StoredPath>> {
        match self {
            PathEntry::Numbers(path) => Ok(path.clone()),
            PathEntry::Text(text) => serde_json::from_str(text).map(Arc::new),
        }
    }
}

impl Serialize for PathEntry {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            PathEntry::Numbers(path) => path.serialize(serializer),
            PathEntry::Text(text) => {
                serde_json::from_str::<&RawValue>(text).map_err(S::Error::custom)?.serialize(serializer)
            }
        }
    }
}

/// The states of a path and the proof of its end.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredPath {
    /// The proved status.
    pub status: Status,
    /// Index of the state that the status belongs to.
    pub end: usize,
    /// For a mechanism: the velocity of every body about its pole.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub motion: Option<Vec<[f64; 3]>>,
    /// Contact forces of a ray \[N\].
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ray: Option<Vec<[f64; 2]>>,
    /// All states in order, without the initial unloaded state.
    pub states: Vec<StoredState>,
    /// Statements about rates.
    pub witnesses: Vec<StoredWitness>,
}

/// A state in equilibrium.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredState {
    /// Index of the load step. Stages are in order; in each stage gravity is first, then settlements and loads.
    pub load_step: usize,
    /// λ of that load step.
    pub factor: f64,
    /// Work-conjugate displacement of the load \[m\].
    pub displacement: f64,
    /// Elastic energy, energy dissipated so far, and work of loads so far \[J\].
    pub energies: [f64; 3],
    /// \[r_n, r_t\] of every contact point \[N\].
    pub force: Vec<[f64; 2]>,
    /// \[u_x, u_y, θ\] of every body about its pole.
    pub motion: Vec<[f64; 3]>,
}

/// A statement about the rates at a state.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StoredWitness {
    /// Index of the state.
    pub state: usize,
    /// The statement.
    pub claim: StoredClaim,
}

/// The statement of a witness.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StoredClaim {
    /// These rates solve the rate problem.
    Rate(PathRate),
    /// No rate raises the load. The nodes of a decision tree, each before its branches.
    NoneRises(Vec<StoredNode>),
    /// No rate continues the path. The nodes of the trees for an increasing, a constant and a decreasing factor.
    NoneContinues([Vec<StoredNode>; 3]),
}

/// A node of a decision tree. The tree is stored as a list, so that its depth cannot exhaust the stack of a reader.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum StoredNode {
    /// A leaf with its multipliers.
    Leaf(FarkasVector),
    /// A contact point, and the mode of each of the branches that follow.
    Split(usize, Vec<PointMode>),
    /// The previous modes of the path.
    Before,
}
