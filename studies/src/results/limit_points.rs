//! Entries of limit points, branches and stability.

use serde::{Deserialize, Serialize};

/// A proven peak of a path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LimitPointEntry {
    /// Name of the stage.
    pub stage: String,
    /// Its factor there.
    pub factor: f64,
    /// Whether gravity of that stage grew.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub gravity: bool,
    /// Work-conjugate displacement of the stage's loads \[m\].
    pub displacement: f64,
    /// By how much the factor falls after it, before the next peak or the end of the path.
    pub fall: f64,
}

/// A place where a path left an equilibrium that became unstable.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BranchEntry {
    /// Name of the stage.
    pub stage: String,
    /// Its factor there.
    pub factor: f64,
    /// `bifurcation`, or `snap` where no equilibrium is near.
    pub what: String,
    /// Energy set free \[J\].
    pub released_energy: f64,
    /// Whether the branch in the other sense has the same energy.
    pub twins: bool,
}

/// Stability of the state at the end of a stage.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct StabilityEntry {
    /// Positive second-order work with all loads and settlements fixed; absent where it was not examined or decided.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stable_under_load: Option<bool>,
    /// The same with the load point, or the settlement, held.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stable_under_control: Option<bool>,
    /// `proven`; `sufficient` where some point slides without associated flow and second-order work is sufficient for
    /// stability only; `not_proven` where it was not decided; absent where it was not examined.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<String>,
}
