//! Limit points, stability and branches of a path in the answer of a solver.

use serde::{Deserialize, Serialize};

/// A proven peak of the factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProvenPeak {
    /// Index of the load step.
    pub load_step: usize,
    /// λ there.
    pub factor: f64,
    /// Work-conjugate displacement of the load \[m\].
    pub displacement: f64,
    /// The least λ after it, before the next peak or the end of the path.
    pub lowest: f64,
}

/// Stability of the state at the end of a stage; `None` where it is not decided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageStability {
    /// Index of the stage.
    pub stage: usize,
    /// Positive second-order work with all loads and settlements fixed.
    pub under_load: Option<bool>,
    /// The same with the load point, or the settlement, held.
    pub under_control: Option<bool>,
    /// Whether some point slides without associated flow: second-order work is then sufficient, not necessary.
    pub sufficient_only: bool,
}

/// A place where the path left an equilibrium that became unstable for another one, by damped descent under fixed
/// loads and settlements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Branching {
    /// Index of the load step.
    pub load_step: usize,
    /// λ there.
    pub factor: f64,
    /// Whether no equilibrium was near: the structure snapped at a limit point.
    pub snaps: bool,
    /// Energy set free \[J\].
    pub released: f64,
    /// Whether the branch in the other sense has the same energy: twins.
    pub twins: bool,
}

/// The reason why a path ends at a limit point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LimitPointEnd {
    /// The limit point lies before the target of its stage.
    Target,
    /// The stage ends at its first limit point: `until = "first_limit_point"`.
    Requested,
    /// With finite displacements load control passes no limit point.
    LoadControl,
    /// A corner leaves its face there.
    JointLost,
    /// No admissible rate leaves it, rising or falling.
    None,
}
