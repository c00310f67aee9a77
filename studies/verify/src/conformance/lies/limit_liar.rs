//! Dishonest limit solvers: the list, and the solver that tells one of the lies.

use super::last_answer::LastAnswer;
use super::limit_lie::{LimitAsked, LimitLie};
use super::{limit_fields, limit_status, limit_substitutes};
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use voussoir_core::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, SettlementAnswer};
use voussoir_core::model::Wrenches;

/// Returns all dishonest limit solvers.
pub fn limit_lies() -> impl Iterator<Item = &'static LimitLie> {
    limit_status::LIES.iter().chain(limit_fields::LIES).chain(limit_substitutes::LIES)
}

/// A limit solver that tells one lie.
#[derive(Debug, Default, Serialize, Deserialize)]
pub struct DishonestLimit {
    /// The honest solver; without it every question is refused.
    #[serde(skip)]
    pub honest: Option<Arc<dyn LimitSolver>>,
    /// The lie.
    #[serde(skip)]
    pub lie: Option<&'static LimitLie>,
    /// The number of times that the solver has lied.
    #[serde(skip)]
    pub told: Arc<AtomicUsize>,
    /// Status and factor of the last answer to a search for collapse.
    #[serde(skip)]
    pub last_answer: LastAnswer,
}

#[typetag::serde(name = "dishonest_limit")]
impl LimitSolver for DishonestLimit {
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
        let honest = self.honest.as_deref().expect("refused without a solver");
        let asked = LimitAsked { honest, problem, question };
        let answer = match self.lie.and_then(|lie| (lie.tell)(&asked)) {
            Some(answer) => {
                self.told.fetch_add(1, Ordering::Relaxed);
                answer
            }
            None => asked.answer(),
        };
        if matches!(question, LimitQuestion::Collapse { .. }) {
            self.last_answer.store(answer.status, answer.factor);
        }
        answer
    }

    fn refuses(&self, problem: &LimitProblem) -> Option<String> {
        let Some(honest) = &self.honest else { return Some("has no honest solver".into()) };
        honest.refuses(problem)
    }

    fn settle(&self, problem: &LimitProblem, loads: &Wrenches, openings: &[[f64; 3]]) -> SettlementAnswer {
        self.honest.as_ref().expect("refused without a solver").settle(problem, loads, openings)
    }
}
