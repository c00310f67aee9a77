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
    /// Energy that a dead load of this factor would release on the way of the path: ∫ (λ_limit − λ) p·dq until the load is back,
    /// or to the end of the path, by rigid motions and the trapezoidal rule over the states \[J\]. It is negative if the load moves
    /// back. `null` if the path ends there or the stage moves supports.
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
    /// `true` if second-order work is positive with all loads fixed; `null` if this is not decided.
    pub stable_under_load: Option<bool>,
}

/// The last state of a path.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct FollowedTo {
    /// Name of the stage.
    pub stage: String,
    /// Its factor there.
    pub factor: f64,
    /// True if gravity of that stage grew.
    #[serde(default, skip_serializing_if = "std::ops::Not::not")]
    pub gravity: bool,
    /// Work-conjugate displacement of the stage's loads \[m\].
    pub displacement: f64,
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
