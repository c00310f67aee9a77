//! Entries of limit points, branches and stability.

use serde::{Deserialize, Serialize};

/// A proved peak of a path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LimitPointEntry {
    /// Name of the stage.
    pub stage: String,
    /// Load factor.
    pub factor: f64,
    /// True if gravity of that stage was increasing.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub gravity: bool,
    /// Work-conjugate displacement of the stage's loads \[m\].
    pub displacement: f64,
    /// The fall of the factor after it, before the next peak or the end of the path.
    pub fall: f64,
    /// Energy that a dead load of this factor would release along the path \[J\]: ∫ (λ_limit − λ) p·dq until the path
    /// carries the same load again, or to its end, by rigid motions and the trapezoidal rule over the states. It is
    /// negative if the load moves back. `null` if the path ends there or the stage moves supports.
    pub released_energy: Option<f64>,
    /// The next state on the path that carries the same load and is not proved unstable under it; `null` if the range has no
    /// such state.
    pub next_state: Option<NextState>,
}

/// A state at the load of a limit point, beyond it: a structure that snaps under dead load can end there.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct NextState {
    /// Work-conjugate displacement of the stage's loads \[m\].
    pub displacement: f64,
    /// `true` if second-order work is positive with all loads fixed; `null` if the check is undecided.
    pub stable_under_load: Option<bool>,
}

/// The last state of a path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FollowedTo {
    /// Name of the stage.
    pub stage: String,
    /// Load factor.
    pub factor: f64,
    /// True if gravity of that stage was increasing.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub gravity: bool,
    /// Work-conjugate displacement of the stage's loads \[m\].
    pub displacement: f64,
}

/// A state at which a path left an unstable equilibrium.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct BranchEntry {
    /// Name of the stage.
    pub stage: String,
    /// Load factor.
    pub factor: f64,
    /// `bifurcation`, or `snap` if no equilibrium is near.
    pub what: String,
    /// Released energy \[J\].
    pub released_energy: f64,
    /// True if the branch in the other direction has the same energy.
    pub twins: bool,
}

/// Stability of the state at the end of a stage.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct StabilityEntry {
    /// True if second-order work is positive with all loads and settlements fixed; absent if the check was not made or
    /// is undecided.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stable_under_load: Option<bool>,
    /// The same check with the load point, or the settlement, fixed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stable_under_control: Option<bool>,
    /// `proven`; `sufficient` if some point slides with non-associated flow, because positive second-order work is then
    /// sufficient for stability but not necessary; `not_proven` if the check is undecided; absent if it was not made.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub stability: Option<String>,
}
