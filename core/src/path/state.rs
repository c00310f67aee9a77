//! States of a path and its events.

use crate::elastic::InelasticState;
use std::sync::Arc;

/// The state of a body whose material has yielded.
#[derive(Debug, Clone)]
pub struct Yielded {
    /// Displacements (x, y) of the nodes in the frame of the shape, in units of its size.
    pub displacement: Arc<Vec<f64>>,
    /// State of its Gauss points.
    pub state: Arc<InelasticState>,
}

/// A state in equilibrium on the path.
#[derive(Debug, Clone, Default)]
pub struct PathState {
    /// Index of the load step.
    pub load_step: usize,
    /// Factor λ of that load step.
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
    /// State of the responses at the start of the step that ends in this state, contact point by contact point. The
    /// update from it at the gap gives the force.
    pub memory: Vec<f64>,
    /// Gap of every contact point at the start of that step \[m\]. It may be empty if the step has no duration.
    pub step_gap: Vec<[f64; 2]>,
    /// Duration of that step \[s\].
    pub time_step: f64,
    /// For each body its state, if its material has yielded. Bodies beyond the end of the list have not yielded.
    pub yielded: Vec<Option<Yielded>>,
    /// True if second-order work is positive with all loads and settlements fixed, false if it is not. `None` if the solver
    /// has not examined or not decided it.
    pub stable_under_load: Option<bool>,
}

impl PathState {
    /// Returns the state of a body whose material has yielded.
    pub fn inelastic(&self, body: usize) -> Option<&Yielded> {
        self.yielded.get(body).and_then(Option::as_ref)
    }

    /// Returns true if two records describe one state: load step, factor, forces and motions are equal.
    pub fn is_same(&self, other: &PathState) -> bool {
        let place = |own: &PathState| (own.load_step, own.factor);
        place(self) == place(other) && self.force == other.force && self.motion == other.motion
    }
}

/// An event at a contact point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum ContactEvent {
    /// The point opened.
    Opens,
    /// The point closed.
    Closes,
    /// The point stopped sliding.
    Sticks,
    /// The point started to slide, with t on the plus body.
    SlipsForward,
    /// The point started to slide against t.
    SlipsBackward,
    /// The point started to crush.
    Crushes,
    /// The point stopped crushing, softening or yielding in tension.
    Unloads,
    /// The bond of the point began to soften.
    Softens,
}

/// An event of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PathEvent {
    /// Index of the load step.
    pub load_step: usize,
    /// Factor λ.
    pub factor: f64,
    /// Index of the contact point.
    pub contact: usize,
    /// The event.
    pub what: ContactEvent,
}
