//! Progress of a study while it is solved; libraries never print.

use crate::results::CaseResult;
use std::sync::atomic::{AtomicBool, Ordering};
use voussoir_core::path::{PathProblem, PathState};

/// Progress of the path of a case.
#[derive(Debug, Clone, Copy)]
pub struct PathProgress<'a> {
    /// Id of the case.
    pub case: usize,
    /// Name of the stage.
    pub stage: &'a str,
    /// True if the stage's change of gravity grows, false if its loads grow.
    pub gravity: bool,
    /// Factor of the growing loads.
    pub factor: f64,
    /// Number of equilibrium states so far: events of an exact path, steps of other paths.
    pub states: u64,
    /// Problem of the path solver.
    pub problem: &'a PathProblem,
    /// Current state: displacements, contact forces, states of laws.
    pub state: &'a PathState,
}

/// Follows the solution of a study.
pub trait Observer: Sync {
    /// Receives the number of cases that are going to be solved.
    fn begins(&self, cases: usize) {
        let _ = cases;
    }

    /// Receives the name of the next phase, one or two words, after the cases are solved.
    fn phase(&self, what: &str) {
        let _ = what;
    }

    /// Receives the result of a case.
    fn answered(&self, case: &CaseResult) {
        let _ = case;
    }

    /// Receives each state of a path; called often. Must not change anything.
    fn on_path(&self, at: &PathProgress) {
        let _ = at;
    }

    /// Returns true to stop. It is called before each case and after each state of a path. A cancelled case has no result;
    /// earlier results are kept.
    fn cancelled(&self) -> bool {
        false
    }
}

/// An observer that does nothing.
#[derive(Debug, Clone, Copy)]
pub struct Unobserved;

impl Observer for Unobserved {}

/// An event for a [`Watch`].
#[derive(Debug, Clone, Copy)]
pub enum RunEvent<'a> {
    /// The number of cases that are going to be solved.
    Begins(usize),
    /// The next state of a path.
    State(&'a PathProgress<'a>),
    /// The result of a case.
    Answered(&'a CaseResult),
}

/// An observer made of a function that returns false to stop; it is not called again after that.
pub struct Watch<F> {
    watch: F,
    cancelled: AtomicBool,
}

impl<F: Fn(RunEvent) -> bool + Sync> Watch<F> {
    /// Creates an observer that calls a function.
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
