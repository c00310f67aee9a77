//! Scenes that deform, and the cases in which a static field already decides.
//!
//! With small displacements, associated flow and strengths that do not soften, a structure stands under loads that have an
//! admissible field, for any stiffness (safe theorem): then no path is followed. Between two stages loads change in
//! proportion and fields may be mixed, because strengths are convex. If flow is not associated, a field alone proves nothing:
//! a path is tried first. If no path is found, the result states how flow was read.
//!
//! With finite displacements, consider a structure without any strength except friction that cannot carry its first gravity
//! in the undeformed geometry. It cannot carry any share of this gravity there, because its admissible forces are a cone.
//! Equilibrium of whole blocks needs nothing else, for any flow and stiffness. So its path cannot leave its start: without
//! load the structure is a mechanism, and the rates of a path are undetermined.

use super::case_input::CaseInput;
use super::limit::solve_by_limit_analysis;
use super::safe_theorem::{is_without_softening, safe_theorem_holds};
use crate::results::stage_start::search_start;
use crate::results::{CaseResult, Proof};
use crate::study::SelectedSolver;
use voussoir_core::limit::Status;
use voussoir_core::model::{Assembly, Bond, Target, stage_loads};

/// Returns true if `auto` may solve a case by a static field: small displacements, loads to a factor.
fn asks_whether_it_stands(input: &CaseInput) -> bool {
    let to_factors = input.stages.iter().all(|stage| matches!(stage.target, Target::Factor(_)));
    let auto = matches!(input.solver, SelectedSolver::Auto);
    auto && !input.curve && !input.settings.finite && to_factors
}

/// Returns the result of limit analysis, if it proves that the case stands and `auto` may use it.
pub(crate) fn stands_by_statics(input: &CaseInput) -> Option<CaseResult> {
    let settles = input.stages.iter().any(|stage| !stage.settlements.is_empty());
    if settles || !asks_whether_it_stands(input) || !safe_theorem_holds(input.assembly) {
        return None;
    }
    let result = solve_by_limit_analysis(input);
    (result.proved_by == Some(Proof::Static)).then_some(result)
}

/// Returns the result of limit analysis for a case whose path `auto` has not found and whose friction is not associated. The
/// case stands if limit analysis proves that nothing moves below the loads, or, with flow read as associated, if a field
/// carries them.
pub(crate) fn stands_without_a_path(input: &CaseInput, path: &CaseResult) -> Option<CaseResult> {
    if path.status.is_answer() || !asks_whether_it_stands(input) || !is_without_softening(input.assembly) {
        return None;
    }
    let mut result = solve_by_limit_analysis(input);
    if result.status != Status::Stands || !result.certificate.passed {
        return None;
    }
    let proved = result.non_associated.lower_proof.is_some();
    if !proved && result.non_associated.associated_load_factor.is_some() {
        return None;
    }
    if !proved {
        result.flow_read_as = Some("associated".into());
        result.notes.push(
            "an admissible field carries the loads, so the structure stands if flow is associated; no path from unloaded \
             joints was found; with the laws' own flow the result may depend on the initial compression of the joints"
                .into(),
        );
    }
    result.notes.extend(path.notes.iter().map(|note| format!("no path: {note}")));
    Some(result)
}

/// Returns the result of limit analysis, if it proves that no share of the first gravity is carried in the undeformed
/// geometry, and a path with finite displacements is requested.
pub(crate) fn falls_by_statics(input: &CaseInput) -> Option<CaseResult> {
    let first = input.stages.first()?;
    let from_rest = match first.target {
        Target::Factor(factor) => factor >= 0.0,
        Target::Collapse => search_start(first) == 0.0,
    };
    let alone = from_rest && first.settlements.is_empty() && first.gravity.is_some();
    if !input.settings.finite || !alone || !resists_by_friction_alone(input.assembly) {
        return None;
    }
    let stages = &input.stages[..1];
    if !stage_loads(input.assembly, stages)[0].fill_bounds.is_empty() {
        return None;
    }
    let mut result =
        solve_by_limit_analysis(&CaseInput { stages, solver: &SelectedSolver::Auto, of_stages: &[], ..*input });
    if result.status != Status::NoEquilibrium || !result.certificate.passed {
        return None;
    }
    // This result does not depend on the reading of flow and of blocks: it holds for all of them.
    result.flow_read_as = None;
    result.notes = vec![
        "the blocks fall under their own weight: in the undeformed geometry no contact forces within the strengths of the \
         joints balance any share of gravity. No load path was computed; the motion after the fall is not computed either"
            .into(),
    ];
    Some(result)
}

/// Returns true if the admissible forces of the joints are a cone: joints resist by friction alone.
pub(crate) fn resists_by_friction_alone(assembly: &Assembly) -> bool {
    assembly.joints.iter().all(|joint| match joint.bond {
        Bond::Bonded => true,
        Bond::Law(law) => {
            assembly.catalogue.laws[law].1.facets().is_some_and(|facets| facets.iter().all(|facet| facet.bound == 0.0))
        }
    })
}
