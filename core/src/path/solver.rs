//! The settings and the answer of a path solver, and the observer of its states.

use super::continuation::Continuation;
use super::peak::{Branching, LimitPointEnd, ProvenPeak, StageStability};
use super::problem::PathProblem;
use super::state::{PathEvent, PathState};
use super::witness::Witness;
use crate::limit::{Counters, Status};
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::sync::Arc;

/// The answer of a path solver. Create it with a constructor, such as [`PathAnswer::stands`], and set the other fields
/// afterwards: later versions may add fields.
#[derive(Debug, Clone, Default)]
pub struct PathAnswer {
    /// Status of the path.
    pub status: Status,
    /// Index of the load step at which the path ended.
    pub load_step: usize,
    /// The factor of the last load step to which the status refers: at collapse or at the first limit point or peak.
    pub factor: Option<f64>,
    /// The state at that factor.
    pub state: PathState,
    /// The last state, if the path continues beyond a limit point.
    pub last: Option<PathState>,
    /// Velocity of every body about its pole at the end; p·q̇ = 1 for a mechanism.
    pub motion: Option<Vec<[f64; 3]>>,
    /// True if the rate at the end is the only one; `None` if this was not examined.
    pub unique: Option<bool>,
    /// Proven peaks of the factor in order.
    pub limit_points: Vec<ProvenPeak>,
    /// The reason why the path ends at a limit point, if the question does not give it: [`LimitPointEnd::JointLost`] or
    /// [`LimitPointEnd::None`].
    pub limit_point_end: Option<LimitPointEnd>,
    /// Stability of the state at the end of each stage that was reached.
    pub stability: Vec<StageStability>,
    /// Places at which a branch was chosen or the structure snapped.
    pub branchings: Vec<Branching>,
    /// Rates of contact forces of a ray that carries any load \[N\].
    pub ray: Option<Vec<[f64; 2]>>,
    /// Events in order.
    pub events: Vec<PathEvent>,
    /// Statements about the rates at states of the path, which the certificate checks; the proof of an end of the path.
    pub witnesses: Vec<Witness>,
    /// Counts of work done.
    pub counters: Counters,
    /// Outputs that the card of the solver declares, by name.
    pub outputs: BTreeMap<String, f64>,
    /// Notes for the user.
    pub notes: Vec<String>,
}

impl PathAnswer {
    /// Creates an answer that decides nothing, with the reason.
    pub fn stalled(why: impl Into<String>) -> Self {
        PathAnswer::default().noting(why)
    }

    /// Creates an answer with a status and the state to which it refers.
    fn at(status: Status, state: PathState) -> Self {
        PathAnswer { status, load_step: state.load_step, factor: Some(state.factor), state, ..PathAnswer::default() }
    }

    /// Creates the answer that all load steps are carried; the state is that at the end of the last one.
    pub fn stands(state: PathState) -> Self {
        PathAnswer::at(Status::Stands, state)
    }

    /// Creates the answer that the structure collapses: the state, and the velocities of a mechanism with p·q̇ = 1.
    pub fn collapse(state: PathState, motion: Vec<[f64; 3]>) -> Self {
        PathAnswer { motion: Some(motion), ..PathAnswer::at(Status::Collapse, state) }
    }

    /// Creates the answer that the path ends at a limit point, with the proof that no rate has a factor that grows.
    pub fn limit_point(state: PathState, proof: Witness) -> Self {
        PathAnswer { witnesses: vec![proof], ..PathAnswer::at(Status::LimitPoint, state) }
    }

    /// Creates the answer that the structure carries any factor: the state, the rates of contact forces of a ray, and the
    /// same rates as a proof.
    pub fn unbounded(state: PathState, ray: Vec<[f64; 2]>, proof: Witness) -> Self {
        PathAnswer { ray: Some(ray), witnesses: vec![proof], ..PathAnswer::at(Status::Unbounded, state) }
    }

    /// Creates the answer that the change of gravity at the start of a stage is not carried; the state is the last one that
    /// is carried.
    pub fn no_equilibrium(state: PathState) -> Self {
        PathAnswer::at(Status::NoEquilibrium, state)
    }

    /// Adds a note for the user.
    pub fn noting(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }
}

/// The settings of a path solver.
#[derive(Debug, Clone)]
pub struct PathSettings {
    /// True for equilibrium in displaced positions.
    pub finite: bool,
    /// Relative tolerance.
    pub tolerance: f64,
    /// Displacement of the load beyond a peak at which the path stops \[m\].
    pub stop_displacement: Option<f64>,
    /// Factor at which a falling branch stops.
    pub stop_factor: Option<f64>,
    /// The continuation strategy, if the study names one.
    pub continuation: Option<Arc<dyn Continuation>>,
    /// Settings of stages, by index. Stages beyond the end of the list have no settings.
    pub stages: Vec<StageSettings>,
}

/// Settings of a stage that differ from the others.
#[derive(Debug, Clone, Default)]
pub struct StageSettings {
    /// The continuation strategy of the stage.
    pub continuation: Option<Arc<dyn Continuation>>,
    /// Displacement of its load beyond a peak \[m\] and factor at which the stage stops. If given, both replace the
    /// settings for all stages.
    pub stop: Option<[Option<f64>; 2]>,
    /// True if the stage ends at its first limit point.
    pub first_limit_point: bool,
}

impl PathSettings {
    /// Returns the continuation strategy of a stage, if one is named.
    pub fn strategy(&self, stage: usize) -> Option<&Arc<dyn Continuation>> {
        let own = self.stages.get(stage).and_then(|own| own.continuation.as_ref());
        own.or(self.continuation.as_ref())
    }

    /// Returns the displacement of the load beyond a peak \[m\] and the factor at which a stage stops.
    pub fn stop(&self, stage: usize) -> [Option<f64>; 2] {
        let own = self.stages.get(stage).and_then(|own| own.stop);
        own.unwrap_or([self.stop_displacement, self.stop_factor])
    }

    /// Returns true if a stage ends at its first limit point.
    pub fn ends_at_first_limit_point(&self, stage: usize) -> bool {
        self.stages.get(stage).is_some_and(|own| own.first_limit_point)
    }

    /// Iterates over all continuation strategies that are named.
    pub fn strategies(&self) -> impl Iterator<Item = &Arc<dyn Continuation>> {
        self.stages.iter().filter_map(|own| own.continuation.as_ref()).chain(&self.continuation)
    }
}

/// An observer of all states in equilibrium that a solver reaches.
pub trait PathObserver {
    /// Receives a new state. Returns false to stop the path.
    fn state(&mut self, problem: &PathProblem, state: &PathState) -> bool;
}

/// An observer that does nothing and lets the path continue.
pub struct Unobserved;

impl PathObserver for Unobserved {
    fn state(&mut self, _problem: &PathProblem, _state: &PathState) -> bool {
        true
    }
}

/// A method to follow the path of loads, chosen by `[solver] solver = …`.
#[typetag::serde(tag = "solver")]
pub trait PathSolver: Debug + Send + Sync {
    /// Follows all load steps without panic. If a claim is not proved, the status is `Stalled` and the notes give the
    /// reason.
    fn trace(&self, problem: &PathProblem, settings: &PathSettings, observer: &mut dyn PathObserver) -> PathAnswer;

    /// Returns the reason why this solver does not support this problem, or `None`.
    fn refuses(&self, problem: &PathProblem, settings: &PathSettings) -> Option<String>;

    /// Returns the share of the energy of a stage that its steps may lose.
    fn energy_tolerance(&self) -> f64 {
        1e-3
    }
}
