//! `accuracy = "estimate"`: the estimated error of the load factor. The case is solved again on a mesh twice as fine, and
//! again with half the step.
//!
//! Two results λ_h and λ_{h/2} of a method of order p give the error of the first, λ_h − λ = (λ_h − λ_{h/2}) 2^p/(2^p − 1):
//! 2 differences for p = 1, 3.4 for p = 1/2, the order for hinges at corners that a mesh does not resolve yet. Two results do
//! not show the order; for this case Roache (J. Fluids Eng. 116, 1994) uses three times Richardson's extrapolation: 10
//! differences of meshes, 6 of steps, which are at least of first order.
//!
//! Two meshes that both miss the toe of a hinge differ little, and both are wrong. With small displacements and associated
//! flow the path ends at the load of limit analysis, which has no mesh: the difference from this load is included.

use super::case_input::CaseInput;
use super::knobs::{Sets, finer_mesh, smaller_steps};
use super::limit::solve_by_limit_analysis;
use super::restated::restated;
use crate::results::{CaseResult, LoadFactorError};
use crate::study::{Case, SelectedSolver};
use serde_json::{Value as Json, json};
use voussoir_core::limit::LimitProblem;
use voussoir_core::model::{Assembly, stage_loads};
use voussoir_core::plugin::{PluginKind, card};

/// Error divided by the difference of meshes: three times the 3.4 of order 1/2.
const SAFETY_OF_MESHES: f64 = 10.0;
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
    let error = |sets: Sets, safety: f64, what: &str| -> Result<Option<f64>, String> {
        if sets.is_empty() {
            return Ok(None);
        }
        let again =
            again(case, solve, sets.into_iter().chain([own.clone()])).map_err(|why| format!("{what}: {why}"))?;
        Ok(Some(safety * (again - factor).abs()))
    };
    let meshes = error(finer_mesh(case, 2.0), SAFETY_OF_MESHES, "with a mesh twice as fine")?;
    let apart = limit_load(case).map(|limit| (limit - factor).abs());
    let discretisation = meshes.map(|error| error.max(apart.unwrap_or(0.0)));
    let path = error(smaller_steps(case, solver, 0.5), SAFETY_OF_STEPS, "with half the step")?;
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
