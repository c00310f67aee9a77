//! What tests keep of a path: its states, with or without the certificate of them all.

use voussoir::core::certificate::PathChecker;
use voussoir::core::path::{PathObserver, PathProblem, PathState};

/// Keeps every state.
#[derive(Default)]
pub struct Record(pub Vec<PathState>);

impl PathObserver for Record {
    fn state(&mut self, _problem: &PathProblem, state: &PathState) -> bool {
        self.0.push(state.clone());
        true
    }
}

/// Keeps every state, with the certificate of them all.
#[derive(Default)]
pub struct Seen {
    /// In order.
    pub states: Vec<PathState>,
    /// Small displacements, unless it is made otherwise.
    pub checker: PathChecker,
}

impl PathObserver for Seen {
    fn state(&mut self, problem: &PathProblem, state: &PathState) -> bool {
        self.states.push(state.clone());
        self.checker.state(problem, state)
    }
}

impl Seen {
    /// Asserts that what the path solver itself must keep, forces and yielding, is kept to 1e-8 at every state.
    pub fn is_certified(&self) {
        for name in ["path_equilibrium", "path_kinematics", "path_inner_equilibrium", "path_yield", "path_strength"] {
            let value = self.checker.worst[name];
            assert!(value <= 1e-8, "{name} is {value:.2e}");
        }
    }
}
