//! States of a path and its events.

use crate::elastic::InelasticState;
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
    /// Index of the load step.
    pub load_step: usize,
    /// λ of that load step.
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
    /// True if second-order work is positive with all loads and settlements fixed, false if it is not. `None` if the solver
    /// has not examined or not decided it.
    pub stable_under_load: Option<bool>,
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
pub enum ContactEvent {
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
    /// Index of the load step.
    pub load_step: usize,
    /// λ.
    pub factor: f64,
    /// Index of the contact point.
    pub contact: usize,
    /// What happened.
    pub what: ContactEvent,
}
