//! False statements in a solver's own answers.

use super::last_answer::LastAnswer;
use super::limit_liar::DishonestLimit;
use super::path_liar::DishonestPath;
use super::suite::answered_within;
use super::truth::Truth;
use std::sync::Arc;
use std::time::Duration;
use voussoir_study::study::{Case, SelectedSolver};

/// Returns the false statement in the solver's own answer to a case, if it makes one. Certificates do not rely on this
/// answer, but a solver with a false statement does not conform.
pub(super) fn false_statement(mut case: Case, truth: &Truth, time: Duration) -> Option<String> {
    let last_answer = LastAnswer::default();
    case.solver.solver = match &case.solver.solver {
        SelectedSolver::Limit(tag, honest) => {
            let listener =
                DishonestLimit { honest: Some(honest.clone()), last_answer: last_answer.clone(), ..Default::default() };
            SelectedSolver::Limit(tag.clone(), Arc::new(listener))
        }
        SelectedSolver::Path(tag, honest) => {
            let listener =
                DishonestPath { honest: Some(honest.clone()), last_answer: last_answer.clone(), ..Default::default() };
            SelectedSolver::Path(tag.clone(), Arc::new(listener))
        }
        SelectedSolver::Auto => return None,
    };
    answered_within(time, case)?;
    let (status, factor) = last_answer.get()?;
    truth.contradicts(status, factor)
}
