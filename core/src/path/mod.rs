//! The path problem: bodies with their flexibility, contact points, loads in the order in which
//! they come; and what a path solver is asked and answers.
//!
//! One system for everything (small displacements; Gq exactly with finite ones):
//!
//! ```text
//! equilibrium   Gqᵀ r + w + λ p = 0
//! kinematics    g = g_0 + G q + C r + g_w + λ g_p
//! law           per contact point: facets, or a response
//! ```

pub mod certificate;
mod displaced;
mod problem;
mod response;
mod sliding;

pub use displaced::Displaced;
pub use problem::{Attachment, Contact, ContactLaw, Drive, DriveEnd, Loading, PathBody, PathProblem};
pub use response::{SoftensOver, coarse_joints};
pub use sliding::Sliding;

use crate::elastic::InelasticState;
use crate::limit::{Counters, Status};
use std::fmt::Debug;
use std::sync::Arc;

/// A body whose material has yielded, in a state.
#[derive(Debug, Clone)]
pub struct Yielded {
    /// Displacements (x, y) of the nodes in the shape's frame, in units of its size.
    pub displacement: Arc<Vec<f64>>,
    /// What its Gauss points remember.
    pub state: Arc<InelasticState>,
}

/// A state in equilibrium on the path.
#[derive(Debug, Clone, Default)]
pub struct PathState {
    /// Index of the drive.
    pub drive: usize,
    /// λ of that drive.
    pub factor: f64,
    /// (r_n, r_t) of every contact point \[N\].
    pub force: Vec<[f64; 2]>,
    /// (g_n, g_t) of every contact point, initial gap included \[m\].
    pub gap: Vec<[f64; 2]>,
    /// Displacement of every body as a rigid motion about its pole: \[u_x, u_y, θ\].
    pub motion: Vec<[f64; 3]>,
    /// Elastic energy of blocks and joints \[J\].
    pub stored: f64,
    /// Energy dissipated in joints and in blocks so far \[J\].
    pub dissipated: f64,
    /// Work of all loads and settlements so far \[J\].
    pub work: f64,
    /// Work-conjugate displacement of the present loads by the rigid motion of their blocks \[m\].
    pub displacement: f64,
    /// State of the laws of tractions from gaps at the start of the step that ends here, contact point
    /// after contact point: the update from it at the gap gives the force.
    pub memory: Vec<f64>,
    /// For each body: what it remembers, where its material has yielded. A list that is too short
    /// stands for bodies that have not.
    pub yielded: Vec<Option<Yielded>>,
}

impl PathState {
    /// What a body remembers, where its material has yielded.
    pub fn inelastic(&self, body: usize) -> Option<&Yielded> {
        self.yielded.get(body).and_then(Option::as_ref)
    }
}

/// What happened at a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Happening {
    /// It opened.
    Opens,
    /// It closed.
    Closes,
    /// It stopped sliding.
    Sticks,
    /// It started to slide, with t on the plus body.
    SlipsForward,
    /// It started to slide against t.
    SlipsBackward,
    /// It started to crush.
    Crushes,
    /// It stopped crushing, softening or yielding in tension.
    Unloads,
    /// Its bond began to soften.
    Softens,
}

/// An event of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathEvent {
    /// Index of the drive.
    pub drive: usize,
    /// λ.
    pub factor: f64,
    /// Index of the contact point.
    pub contact: usize,
    /// What happened.
    pub what: Happening,
}

/// How a path ended.
#[derive(Debug, Clone)]
pub struct PathAnswer {
    /// Its status.
    pub status: Status,
    /// Index of the drive at which it ended.
    pub drive: usize,
    /// The factor of the last drive that the status speaks of: at collapse or at the first limit
    /// point or peak.
    pub factor: Option<f64>,
    /// The state at that factor.
    pub state: PathState,
    /// The last state, where the path went on behind a limit point.
    pub last: Option<PathState>,
    /// Velocity of every body about its pole at the end, p·q̇ = 1 for a mechanism.
    pub motion: Option<Vec<[f64; 3]>>,
    /// Whether the rate at the end is the only one: `None` where it was not examined.
    pub unique: Option<bool>,
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
    /// How far to go behind a peak: displacement of the load \[m\].
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
    /// Follows all drives. Never panics; what is not proven is `Stalled` with its reason.
    fn trace(&self, problem: &PathProblem, settings: &PathSettings, observer: &mut dyn PathObserver) -> PathAnswer;

    /// Why this solver cannot take this problem, if so.
    fn refuses(&self, problem: &PathProblem, settings: &PathSettings) -> Option<String>;
}

/// The increment of a step as a continuation strategy sees it: all zero at the last converged state.
/// Units: force F, the size of the loads; displacement U = F × mean compliance; factor Λ, with which
/// the load that grows has the size F; energy F U. So nothing here depends on the unit system.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Increment {
    /// Δλ in its unit Λ.
    pub factor: f64,
    /// Increment of the work-conjugate displacement of the load, in the unit of displacement.
    pub displacement: f64,
    /// Root mean square of the increments of all rigid motions and gaps, in the unit of displacement
    /// (gaps, so that a body that the ground holds but that deforms counts too).
    pub motion: f64,
    /// Increment of dissipated energy, in the unit of energy.
    pub dissipation: f64,
}

/// Value and derivatives of a constraint c(increment) = length.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Constraint {
    /// c.
    pub value: f64,
    /// ∂c by each entry of the increment.
    pub derivative: Increment,
}

/// How the next point of a path is chosen, by `[solver] continuation = { strategy = … }`. Pure: the
/// solver keeps the length of the step and lets it grow and shrink.
#[typetag::serde(tag = "strategy")]
pub trait Continuation: Debug + Send + Sync {
    /// The constraint of a step. `previous` is the increment of the last converged step of this
    /// drive, `None` before the first: a strategy may change what it measures between two steps,
    /// never within one.
    fn constraint(&self, increment: &Increment, previous: Option<&Increment>) -> Constraint;

    /// Whether λ may fall during a step.
    fn passes_limit_points(&self) -> bool;

    /// Whether it steps at all, or goes exactly from event to event.
    fn exact_events(&self) -> bool {
        false
    }

    /// Length of a drive's first step: the share of the unit load (of size F) that an elastic
    /// structure would take up during it.
    fn first_step(&self) -> f64 {
        0.1
    }

    /// Greatest increment of a step in its `motion`, as a share of the scene's length; infinite
    /// where only the solver bounds it.
    fn largest_step(&self) -> f64 {
        f64::INFINITY
    }
}
