//! What a path solver is told and answers, and who looks on.

use super::continuation::Continuation;
use super::peak::{Branching, ProvenPeak, StageStability};
use super::problem::PathProblem;
use super::state::{PathEvent, PathState};
use crate::limit::{Counters, Status};
use std::fmt::Debug;

/// How a path ended.
#[derive(Debug, Clone)]
pub struct PathAnswer {
    /// Its status.
    pub status: Status,
    /// Index of the load step at which it ended.
    pub load_step: usize,
    /// The factor of the last load step that the status speaks of: at collapse or at the first limit
    /// point or peak.
    pub factor: Option<f64>,
    /// The state at that factor.
    pub state: PathState,
    /// The last state, where the path went on beyond a limit point.
    pub last: Option<PathState>,
    /// Velocity of every body about its pole at the end, p·q̇ = 1 for a mechanism.
    pub motion: Option<Vec<[f64; 3]>>,
    /// Whether the rate at the end is the only one: `None` where it was not examined.
    pub unique: Option<bool>,
    /// Proven peaks of the factor in order.
    pub limit_points: Vec<ProvenPeak>,
    /// Stability of the state at the end of each stage that was reached.
    pub stability: Vec<StageStability>,
    /// Places where a branch was chosen, or the structure snapped.
    pub branchings: Vec<Branching>,
    /// Rates of contact forces of a ray that carries any load \[N\].
    pub ray: Option<Vec<[f64; 2]>>,
    /// Events in order.
    pub events: Vec<PathEvent>,
    /// Work done.
    pub counters: Counters,
    /// What a user should know.
    pub notes: Vec<String>,
}

/// What a solver is told besides the problem.
#[derive(Debug, Clone)]
pub struct PathSettings {
    /// Equilibrium in displaced positions.
    pub finite: bool,
    /// Relative tolerance.
    pub tolerance: f64,
    /// How far to go beyond a peak: displacement of the load \[m\].
    pub stop_displacement: Option<f64>,
    /// Where to stop a falling branch: a factor.
    pub stop_factor: Option<f64>,
    /// The continuation strategy, where the study names one.
    pub continuation: Option<std::sync::Arc<dyn Continuation>>,
}

/// Looks on: sees every state in equilibrium that a solver reaches. Returns whether to go on.
pub trait PathObserver {
    /// A new state.
    fn state(&mut self, problem: &PathProblem, state: &PathState) -> bool;
}

/// An observer that only lets the path go on.
pub struct Unobserved;

impl PathObserver for Unobserved {
    fn state(&mut self, _problem: &PathProblem, _state: &PathState) -> bool {
        true
    }
}

/// A way to follow the path of loads, chosen by `[solver] solver = …`.
#[typetag::serde(tag = "solver")]
pub trait PathSolver: Debug + Send + Sync {
    /// Follows all load steps. Never panics; what is not proven is `Stalled` with its reason.
    fn trace(&self, problem: &PathProblem, settings: &PathSettings, observer: &mut dyn PathObserver) -> PathAnswer;

    /// Why this solver cannot take this problem, if so.
    fn refuses(&self, problem: &PathProblem, settings: &PathSettings) -> Option<String>;
}
