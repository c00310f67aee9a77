//! `auto` and scenes that deform: whether a static field answers already.
//!
//! With small displacements, associated flow and strengths that do not soften a structure stands under loads for which
//! an admissible field exists, whatever its stiffness (safe theorem): then no path is followed. Between two stages loads
//! change in proportion and fields may be mixed, because strengths are convex. Where flow is not associated a field
//! proves nothing by itself.

use super::case_input::CaseInput;
use super::limit::solve_by_limit_analysis;
use super::safe_theorem::safe_theorem_holds;
use crate::results::{CaseResult, Proof};
use crate::study::SelectedSolver;
use voussoir_core::model::Target;

/// The answer of limit analysis, where it proves that the case stands and `auto` may take it.
pub(super) fn stands_by_statics(input: &CaseInput) -> Option<CaseResult> {
    let to_factors = input.stages.iter().all(|stage| matches!(stage.target, Target::Factor(_)));
    let settles = input.stages.iter().any(|stage| !stage.settlements.is_empty());
    let auto = matches!(input.solver, SelectedSolver::Auto);
    if !auto || input.curve || input.settings.finite || settles || !to_factors || !safe_theorem_holds(input.assembly) {
        return None;
    }
    let result = solve_by_limit_analysis(input);
    (result.proved_by == Some(Proof::Static)).then_some(result)
}
