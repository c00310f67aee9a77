//! `solver = "auto"`: the cheapest solver that answers the question.

use super::case_input::CaseInput;
use crate::study::SelectedSolver;
use std::sync::Arc;
use voussoir_core::limit::{LimitProblem, LimitSolver};
use voussoir_core::path::PathSolver;
use voussoir_solvers::limit::{chain::LimitChain, conic::LimitConic, nonassociated::LimitNonassociated};
use voussoir_solvers::path::{event::EventPath, newton::NewtonPath};

/// The path solver that answers, if it is not for limit analysis: the one named, or for `auto` on
/// deformable scenes the exact one where it can.
pub fn select_path_solver(input: &CaseInput) -> Option<(String, Arc<dyn PathSolver>)> {
    match input.solver {
        SelectedSolver::Limit(..) => None,
        SelectedSolver::Path(tag, solver) => Some((tag.clone(), solver.clone())),
        SelectedSolver::Auto => {
            let assembly = input.assembly;
            let settles = input.stages.iter().any(|stage| !stage.settlements.is_empty());
            if !assembly.deforms() && !input.settings.finite && !settles {
                return None;
            }
            let facets =
                assembly.joints.iter().all(|j| assembly.law(j).is_none_or(|l| l.formulation().facets().is_some()));
            let exact = input.settings.continuation.as_ref().is_none_or(|c| c.exact_events());
            let linear = (0..assembly.bodies.len()).all(|b| assembly.bodies[b].fixed || !assembly.yields(b));
            if !input.settings.finite && facets && exact && linear {
                Some(("event_path".into(), Arc::new(EventPath {})))
            } else {
                Some(("newton_path".into(), Arc::new(NewtonPath {})))
            }
        }
    }
}

/// The limit solvers to try, in order.
pub fn limit_solvers(selected: &SelectedSolver, problem: &LimitProblem) -> Vec<(String, Arc<dyn LimitSolver>)> {
    match selected {
        SelectedSolver::Limit(tag, solver) => vec![(tag.clone(), solver.clone())],
        SelectedSolver::Auto | SelectedSolver::Path(..) => {
            let chain: Arc<dyn LimitSolver> = Arc::new(LimitChain {});
            let conic: Arc<dyn LimitSolver> = Arc::new(LimitConic {});
            let general = ("limit_conic".to_string(), conic);
            let mut all = vec![general];
            if chain.refuses(problem).is_none() {
                all.insert(0, ("limit_chain".to_string(), chain));
            }
            if problem.non_associated {
                all.insert(0, ("limit_least".to_string(), Arc::new(LimitNonassociated::default())));
            }
            all
        }
    }
}
