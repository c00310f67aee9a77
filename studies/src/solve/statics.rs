//! Scenes that deform, and whether a static field answers already.
//!
//! With small displacements, associated flow and strengths that do not soften a structure stands under loads for which
//! an admissible field exists, whatever its stiffness (safe theorem): then no path is followed. Between two stages loads
//! change in proportion and fields may be mixed, because strengths are convex. Where flow is not associated a field
//! proves nothing by itself: a path is asked first, and where it is not found the answer says how flow was read.
//!
//! With finite displacements a structure without any strength but friction that cannot carry its first gravity in the
//! undeformed geometry cannot carry any share of it there: what joints admit is a cone. Equilibrium of whole blocks
//! asks for nothing else, whatever the flow and the stiffness. So its path has no way out of its start: under no load at
//! all it is a mechanism, and the rates of a path are undetermined.

use super::case_input::CaseInput;
use super::limit::solve_by_limit_analysis;
use super::safe_theorem::{is_without_softening, safe_theorem_holds};
use crate::results::stage_start::search_start;
use crate::results::{CaseResult, Proof};
use crate::study::SelectedSolver;
use voussoir_core::limit::Status;
use voussoir_core::model::{Assembly, Bond, Target, stage_loads};

/// Whether `auto` may answer a case by a static field: small displacements, loads to a factor.
fn asks_whether_it_stands(input: &CaseInput) -> bool {
    let to_factors = input.stages.iter().all(|stage| matches!(stage.target, Target::Factor(_)));
    let auto = matches!(input.solver, SelectedSolver::Auto);
    auto && !input.curve && !input.settings.finite && to_factors
}

/// The answer of limit analysis, where it proves that the case stands and `auto` may take it.
pub(super) fn stands_by_statics(input: &CaseInput) -> Option<CaseResult> {
    let settles = input.stages.iter().any(|stage| !stage.settlements.is_empty());
    if settles || !asks_whether_it_stands(input) || !safe_theorem_holds(input.assembly) {
        return None;
    }
    let result = solve_by_limit_analysis(input);
    (result.proved_by == Some(Proof::Static)).then_some(result)
}

/// What limit analysis says of a case whose path `auto` has not found and whose friction is not associated: that it
/// stands, where it proves that nothing moves below the loads, or, read with associated flow, where a field carries them.
pub(super) fn stands_without_a_path(input: &CaseInput, path: &CaseResult) -> Option<CaseResult> {
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
            "an admissible field carries the loads, so that it stands where slip is associated; no path from unloaded \
             joints was found, and with the flow of the laws whether it stands may depend on how the joints were compressed"
                .into(),
        );
    }
    result.notes.extend(path.notes.iter().map(|note| format!("no path: {note}")));
    Some(result)
}

/// The answer of limit analysis, where it proves that no share of the first gravity is carried in the undeformed
/// geometry, and a path with finite displacements is asked for.
pub(super) fn falls_by_statics(input: &CaseInput) -> Option<CaseResult> {
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
    // The reading of flow and of blocks is not that of this answer: it holds for all of them.
    result.flow_read_as = None;
    result.notes = vec![
        "in the undeformed geometry no admissible field is in equilibrium with any share of gravity, whatever the flow of \
         joints and the stiffness of blocks: no path begins, and where the blocks come to rest is not said"
            .into(),
    ];
    Some(result)
}

/// Whether what the joints admit is a cone: friction and nothing else.
pub(super) fn resists_by_friction_alone(assembly: &Assembly) -> bool {
    assembly.joints.iter().all(|joint| match joint.bond {
        Bond::Bonded => true,
        Bond::Law(law) => {
            assembly.catalogue.laws[law].1.facets().is_some_and(|facets| facets.iter().all(|facet| facet.bound == 0.0))
        }
    })
}
