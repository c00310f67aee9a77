//! What a path solver is told and answers, and who looks on.

use super::continuation::Continuation;
use super::peak::{Branching, LimitPointEnd, ProvenPeak, StageStability};
use super::problem::PathProblem;
use super::state::{PathEvent, PathState};
use super::witness::Witness;
use crate::limit::{Counters, Status};
use std::fmt::Debug;
use std::sync::Arc;

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
    /// The reason why the path ends at a limit point, if the question does not give it: [`LimitPointEnd::JointLost`] or
    /// [`LimitPointEnd::None`].
    pub limit_point_end: Option<LimitPointEnd>,
    /// Stability of the state at the end of each stage that was reached.
    pub stability: Vec<StageStability>,
    /// Places where a branch was chosen, or the structure snapped.
    pub branchings: Vec<Branching>,
    /// Rates of contact forces of a ray that carries any load \[N\].
    pub ray: Option<Vec<[f64; 2]>>,
    /// Events in order.
    pub events: Vec<PathEvent>,
    /// Statements about the rates at states of the path, for the certificate; the proof of an end of the path.
    pub witnesses: Vec<Witness>,
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
    pub continuation: Option<Arc<dyn Continuation>>,
    /// What stages ask for besides, by index: a list that is too short stands for stages that ask for nothing.
    pub stages: Vec<StageSettings>,
}

/// What a stage asks for where it differs from the rest.
#[derive(Debug, Clone, Default)]
pub struct StageSettings {
    /// Its continuation strategy.
    pub continuation: Option<Arc<dyn Continuation>>,
    /// How far to go beyond a peak in it: displacement of its load \[m\], and a factor. Both together take the place
    /// of those of all stages, where one of them is given.
    pub stop: Option<[Option<f64>; 2]>,
    /// True if the stage ends at its first limit point.
    pub first_limit_point: bool,
}

impl PathSettings {
    /// The continuation strategy of a stage, where one is named.
    pub fn strategy(&self, stage: usize) -> Option<&Arc<dyn Continuation>> {
        let own = self.stages.get(stage).and_then(|own| own.continuation.as_ref());
        own.or(self.continuation.as_ref())
    }

    /// How far to go beyond a peak in a stage: displacement of its load \[m\], and a factor.
    pub fn stop(&self, stage: usize) -> [Option<f64>; 2] {
        let own = self.stages.get(stage).and_then(|own| own.stop);
        own.unwrap_or([self.stop_displacement, self.stop_factor])
    }

    /// True if a stage ends at its first limit point.
    pub fn ends_at_first_limit_point(&self, stage: usize) -> bool {
        self.stages.get(stage).is_some_and(|own| own.first_limit_point)
    }

    /// All continuation strategies that are named.
    pub fn strategies(&self) -> impl Iterator<Item = &Arc<dyn Continuation>> {
        self.stages.iter().filter_map(|own| own.continuation.as_ref()).chain(&self.continuation)
    }
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

    /// How much of the energy of a stage its steps may lose.
    fn energy_tolerance(&self) -> f64 {
        1e-3
    }
}
