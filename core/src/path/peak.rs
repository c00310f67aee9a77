//! Limit points, stability and branches of a path in the answer of a solver.

use serde::{Deserialize, Serialize};

/// A proven peak of the factor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ProvenPeak {
    /// Index of the load step.
    pub load_step: usize,
    /// λ at the peak.
    pub factor: f64,
    /// Work-conjugate displacement of the load \[m\].
    pub displacement: f64,
    /// The least λ after it, before the next peak or the end of the path.
    pub lowest: f64,
}

/// Stability of the state at the end of a stage. A field is `None` if it is not decided.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StageStability {
    /// Index of the stage.
    pub stage: usize,
    /// True if second-order work is positive with all loads and settlements fixed.
    pub under_load: Option<bool>,
    /// True if it is positive with the load point, or the settlement, held.
    pub under_control: Option<bool>,
    /// True if a point slides without associated flow: positive second-order work is then sufficient for stability, not
    /// necessary.
    pub sufficient_only: bool,
}

/// A state at which the path left an equilibrium that became unstable for another one, by damped descent under fixed
/// loads and settlements.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Branching {
    /// Index of the load step.
    pub load_step: usize,
    /// λ at this state.
    pub factor: f64,
    /// True if no equilibrium was near: the structure snapped at a limit point.
    pub snaps: bool,
    /// Released energy \[J\].
    pub released: f64,
    /// True if the branch in the opposite direction has the same energy.
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
    /// With finite displacements load control cannot pass a limit point.
    LoadControl,
    /// A corner leaves its face at the limit point.
    JointLost,
    /// No admissible rate continues the path, with rising or falling load.
    None,
}
