//! Looking on while a study is solved; libraries never print.

use crate::results::CaseResult;
use std::sync::atomic::{AtomicBool, Ordering};
use voussoir_core::path::{PathProblem, PathState};

/// Where the path of a case has come to.
#[derive(Debug, Clone, Copy)]
pub struct PathProgress<'a> {
    /// Id of the case.
    pub case: usize,
    /// Name of the stage.
    pub stage: &'a str,
    /// Whether the stage's change of gravity grows, not its loads.
    pub gravity: bool,
    /// Factor of what grows.
    pub factor: f64,
    /// States in equilibrium so far: events of an exact path, steps of others.
    pub states: u64,
    /// What the path solver was given.
    pub problem: &'a PathProblem,
    /// The state it has reached: displacements, contact forces, states of laws.
    pub state: &'a PathState,
}

/// Follows a study while it is worked on.
pub trait Observer: Sync {
    /// So many cases are going to be solved.
    fn begins(&self, cases: usize) {
        let _ = cases;
    }

    /// What is done from now on, in a word or two, after the cases are solved.
    fn phase(&self, what: &str) {
        let _ = what;
    }

    /// A case is answered.
    fn answered(&self, case: &CaseResult) {
        let _ = case;
    }

    /// A path has reached its next state; called often. Changes nothing.
    fn on_path(&self, at: &PathProgress) {
        let _ = at;
    }

    /// Whether to stop: asked before each case and after each state of a path. A case that was cut short has no
    /// result; those answered before keep theirs.
    fn cancelled(&self) -> bool {
        false
    }
}

/// Nobody looks on.
#[derive(Debug, Clone, Copy)]
pub struct Unobserved;

impl Observer for Unobserved {}

/// What a [`Watch`] is told.
#[derive(Debug, Clone, Copy)]
pub enum RunEvent<'a> {
    /// So many cases are going to be solved.
    Begins(usize),
    /// A path has reached its next state.
    State(&'a PathProgress<'a>),
    /// A case is answered.
    Answered(&'a CaseResult),
}

/// An observer made of a function that says whether to go on; once it said `false` it is not called again.
pub struct Watch<F> {
    watch: F,
    cancelled: AtomicBool,
}

impl<F: Fn(RunEvent) -> bool + Sync> Watch<F> {
    /// An observer that calls a function.
    pub fn new(watch: F) -> Self {
        Watch { watch, cancelled: AtomicBool::new(false) }
    }

    fn tell(&self, event: RunEvent) {
        if !self.cancelled() && !(self.watch)(event) {
            self.cancelled.store(true, Ordering::Relaxed);
        }
    }
}

impl<F: Fn(RunEvent) -> bool + Sync> Observer for Watch<F> {
    fn begins(&self, cases: usize) {
        self.tell(RunEvent::Begins(cases));
    }

    fn answered(&self, case: &CaseResult) {
        self.tell(RunEvent::Answered(case));
    }

    fn on_path(&self, at: &PathProgress) {
        self.tell(RunEvent::State(at));
    }

    fn cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }
}
