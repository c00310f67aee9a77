//! `accuracy = "estimate"`: the estimated error of the load factor.
//!
//! Mesh: the case is solved again on a mesh that is much finer at the joints' ends, where hinges form. If λ_f is its result and
//! ρ < 1 the size of its elements there divided by the size in the case, an error of first order in this size is
//! |λ − λ_f|/(1 − ρ). Observed orders are 1.5 to 2, so this is on the safe side; it is multiplied by the factor 1.25 of Roache
//! (J. Fluids Eng. 116, 1994). With small displacements and associated flow the path ends at the load of limit analysis, which
//! has no mesh: the error is then the difference from this load, and no finer mesh is solved.
//!
//! Steps: the case is solved again with half the step. The error of first order is twice the difference; without a third result
//! Roache multiplies by three.

use super::case_input::CaseInput;
use super::knobs::{Sets, mesh_at_hinges, smaller_steps};
use super::limit::solve_by_limit_analysis;
use super::restated::restated;
use crate::results::{CaseResult, LoadFactorError};
use crate::study::{Case, SelectedSolver};
use serde_json::{Value as Json, json};
use voussoir_core::limit::LimitProblem;
use voussoir_core::model::{Assembly, stage_loads};
use voussoir_core::plugin::{PluginKind, card};

/// Factor on the error of first order of the mesh.
const SAFETY_OF_MESHES: f64 = 1.25;
/// Error divided by the difference of steps: three times the 2 of first order.
const SAFETY_OF_STEPS: f64 = 6.0;

/// Solves a case again.
pub type Solve<'a> = &'a dyn Fn(&CaseInput) -> CaseResult;

/// Estimates the error of the load factor by solving again. The error gives the reason if this is not possible.
pub fn estimate(case: &Case, result: &CaseResult, solve: Solve) -> Result<LoadFactorError, String> {
    let factor = result.collapse_load().ok_or("there is no proved collapse load")?;
    let path = card(PluginKind::PathSolver, &result.solver);
    let solution = match (path, result.both_bounds()) {
        (Some(_), _) => case.solver.settings.tolerance * factor.abs(),
        (None, Some([lower, upper])) => (factor - lower).abs().max((upper - factor).abs()),
        (None, None) => return Err("the answer has no bounds".into()),
    };
    let Some(solver) = path else {
        return Ok(LoadFactorError { discretisation: None, path: None, solution });
    };
    // Use the same solver, so that nothing else differs.
    let own = ("solver.solver".to_string(), json!(solver.tag));
    let apart = |sets: Sets, what: &str| -> Result<f64, String> {
        let again =
            again(case, solve, sets.into_iter().chain([own.clone()])).map_err(|why| format!("{what}: {why}"))?;
        Ok((again - factor).abs())
    };
    let discretisation = match (mesh_at_hinges(case, 1.0), limit_load(case)) {
        (None, _) => None,
        (Some(_), Some(limit)) => Some((limit - factor).abs()),
        (Some((sets, share)), None) => {
            Some(SAFETY_OF_MESHES / (1.0 - share) * apart(sets, "with a mesh that is finer at the joints' ends")?)
        }
    };
    let steps = smaller_steps(case, solver, 0.5);
    let path = if steps.is_empty() { None } else { Some(SAFETY_OF_STEPS * apart(steps, "with half the step")?) };
    Ok(LoadFactorError { discretisation, path, solution })
}

/// Returns true if limit analysis has the same collapse load as a path of the case: displacements are small, joints have
/// facets with associated flow, and blocks do not yield.
pub fn ends_at_limit_load(case: &Case) -> bool {
    let yields = |assembly: &Assembly| assembly.catalogue.materials.iter().any(|(_, own)| own.inelastic().is_some());
    let loads = stage_loads(&case.assembly, &case.stages);
    let associated = || {
        loads.last().is_some_and(|last| LimitProblem::new(&case.assembly, last).is_ok_and(|own| !own.non_associated))
    };
    !case.solver.settings.finite && !yields(&case.assembly) && associated()
}

/// Returns the collapse load by limit analysis, if it is the collapse load of the path.
fn limit_load(case: &Case) -> Option<f64> {
    if !ends_at_limit_load(case) {
        return None;
    }
    solve_by_limit_analysis(&CaseInput { solver: &SelectedSolver::Auto, ..CaseInput::of(case) }).collapse_load()
}

/// Returns the load factor of the case with some keys changed.
fn again(case: &Case, solve: Solve, sets: impl IntoIterator<Item = (String, Json)>) -> Result<f64, String> {
    let other = restated(case, sets)?;
    let result = solve(&CaseInput::of(&other));
    result.collapse_load().ok_or_else(|| result.notes.first().cloned().unwrap_or_else(|| "it does not collapse".into()))
}

/// Describes the estimate in words.
pub(crate) fn words(error: &LoadFactorError) -> String {
    let part = |name: &str, part: Option<f64>| part.map(|x| format!("{name} {x:.1e}"));
    let parts = [part("mesh", error.discretisation), part("steps", error.path), part("solution", Some(error.solution))];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    format!("error of the load factor: {:.1e} ({})", error.total(), parts.join(", "))
}
