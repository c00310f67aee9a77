//! Observers that store the states of a path, with or without a certificate of all states.

use voussoir::core::certificate::PathChecker;
use voussoir::core::path::{PathObserver, PathProblem, PathState};

/// Stores every state.
#[derive(Default)]
pub struct Record(pub Vec<PathState>);

impl PathObserver for Record {
    fn state(&mut self, _problem: &PathProblem, state: &PathState) -> bool {
        self.0.push(state.clone());
        true
    }
}

/// Stores every state, with the certificate of all states.
#[derive(Default)]
pub struct Seen {
    /// States in order.
    pub states: Vec<PathState>,
    /// The checker, for small displacements by default.
    pub checker: PathChecker,
}

impl PathObserver for Seen {
    fn state(&mut self, problem: &PathProblem, state: &PathState) -> bool {
        self.states.push(state.clone());
        self.checker.state(problem, state)
    }
}

impl Seen {
    /// Asserts that the residuals that the path solver itself must satisfy (forces and yielding) are at most 1e-8 at
    /// every state.
    pub fn is_certified(&self) {
        for name in ["path_equilibrium", "path_kinematics", "path_inner_equilibrium", "path_yield", "path_strength"] {
            let value = self.checker.worst[name];
            assert!(value <= 1e-8, "{name} is {value:.2e}");
        }
    }
}
