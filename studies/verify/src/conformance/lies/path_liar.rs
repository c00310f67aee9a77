//! Dishonest path solvers: the list, and the solver that tells one of the lies.

use super::last_answer::LastAnswer;
use super::path_lie::{PathAsked, PathLie};
use super::{path_answers, path_endings, path_states, path_witnesses};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use voussoir_core::path::{PathAnswer, PathObserver, PathProblem, PathSettings, PathSolver};

/// Returns all dishonest path solvers.
pub fn path_lies() -> impl Iterator<Item = &'static PathLie> {
    path_endings::LIES.iter().chain(path_states::LIES).chain(path_answers::LIES).chain(path_witnesses::LIES)
}

/// A path solver that tells one lie.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct DishonestPath {
    /// The honest solver; without it every question is refused.
    #[serde(skip)]
    pub honest: Option<Arc<dyn PathSolver>>,
    /// The lie.
    #[serde(skip)]
    pub lie: Option<&'static PathLie>,
    /// The number of times that the solver has lied.
    #[serde(skip)]
    pub told: Arc<AtomicUsize>,
    /// Status and factor of the last answer.
    #[serde(skip)]
    pub last_answer: LastAnswer,
}

#[typetag::serde(name = "dishonest_path")]
impl PathSolver for DishonestPath {
    fn trace(&self, problem: &PathProblem, settings: &PathSettings, observer: &mut dyn PathObserver) -> PathAnswer {
        let honest = self.honest.as_deref().expect("refused without a solver");
        let asked = PathAsked { honest, problem, settings };
        let truth = asked.story();
        let mut story = truth.clone();
        match self.lie.and_then(|lie| (lie.tell)(&asked, &mut story)) {
            Some(()) => _ = self.told.fetch_add(1, Ordering::Relaxed),
            None => story = truth,
        }
        for state in &story.states {
            if !observer.state(problem, state) {
                break;
            }
        }
        self.last_answer.store(story.answer.status, story.answer.factor);
        story.answer
    }

    fn refuses(&self, problem: &PathProblem, settings: &PathSettings) -> Option<String> {
        let Some(honest) = &self.honest else { return Some("has no honest solver".into()) };
        honest.refuses(problem, settings)
    }

    fn energy_tolerance(&self) -> f64 {
        self.honest.as_ref().map_or(1e-3, |honest| honest.energy_tolerance())
    }
}
