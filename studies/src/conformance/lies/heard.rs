//! The status and the factor in a solver's own answer, before a certificate decides.

use super::limit_liar::DishonestLimit;
use super::path_liar::DishonestPath;
use super::suite::answered_within;
use super::truth::Truth;
use crate::study::{Case, SelectedSolver};
use std::sync::{Arc, Mutex};
use std::time::Duration;
use voussoir_core::limit::Status;

/// Status and factor of an answer.
type Answered = (Status, Option<f64>);

/// The last status and factor in the answers of a solver.
#[derive(Debug, Clone, Default)]
pub struct Heard(Arc<Mutex<Option<Answered>>>);

impl Heard {
    /// Stores an answer.
    pub(super) fn note(&self, status: Status, factor: Option<f64>) {
        if let Ok(mut last) = self.0.lock() {
            *last = Some((status, factor));
        }
    }

    /// The last answer.
    fn last(&self) -> Option<Answered> {
        self.0.lock().ok().and_then(|last| *last)
    }
}

/// The false statement in the solver's own answer to a case, if it makes one. Certificates do not believe it, but a solver
/// with a false statement does not conform.
pub(super) fn false_statement(mut case: Case, truth: &Truth, time: Duration) -> Option<String> {
    let heard = Heard::default();
    case.solver.solver = match &case.solver.solver {
        SelectedSolver::Limit(tag, honest) => {
            let listener = DishonestLimit { honest: Some(honest.clone()), heard: heard.clone(), ..Default::default() };
            SelectedSolver::Limit(tag.clone(), Arc::new(listener))
        }
        SelectedSolver::Path(tag, honest) => {
            let listener = DishonestPath { honest: Some(honest.clone()), heard: heard.clone(), ..Default::default() };
            SelectedSolver::Path(tag.clone(), Arc::new(listener))
        }
        SelectedSolver::Auto => return None,
    };
    answered_within(time, case)?;
    let (status, factor) = heard.last()?;
    truth.contradicts(status, factor)
}
