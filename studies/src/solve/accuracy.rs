//! `accuracy = "estimate"`: how far the load factor may be off, by solving again on a mesh twice as fine, and again with half
//! the step.
//!
//! Two answers λ_h and λ_{h/2} of a method of order p tell the error of the first, λ_h − λ = (λ_h − λ_{h/2}) 2^p/(2^p − 1):
//! 2 differences for p = 1, 3.4 for p = 1/2, as hinges have at corners that a mesh does not resolve yet. Two answers do not show
//! the order, for which Roache (J. Fluids Eng. 116, 1994) takes three times Richardson's extrapolation: 10 differences of meshes,
//! 6 of steps, which are of first order at least.
//!
//! Two meshes that both miss the toe of a hinge differ by little and are wrong together. With small displacements and
//! associated flow a path ends where limit analysis does, which has no mesh: that difference counts too.

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

/// Error over difference of meshes: three times the 3.4 of order 1/2.
const SAFETY_OF_MESHES: f64 = 10.0;
/// Of steps: three times the 2 of first order.
const SAFETY_OF_STEPS: f64 = 6.0;

/// How a case is solved again.
pub type Solve<'a> = &'a dyn Fn(&CaseInput) -> CaseResult;

/// Errors of the load factor of an answer, found by solving again; an error says why there are none.
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
    // The same solver, so that nothing else differs.
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

/// Whether limit analysis asks for the same load as a path of the case: displacements are small, joints have facets with
/// associated flow, and blocks do not yield.
pub fn ends_at_limit_load(case: &Case) -> bool {
    let yields = |assembly: &Assembly| assembly.catalogue.materials.iter().any(|(_, own)| own.inelastic().is_some());
    let loads = stage_loads(&case.assembly, &case.stages);
    let associated = || {
        loads.last().is_some_and(|last| LimitProblem::new(&case.assembly, last).is_ok_and(|own| !own.non_associated))
    };
    !case.solver.settings.finite && !yields(&case.assembly) && associated()
}

/// The collapse load by limit analysis, where that is the one of the path.
fn limit_load(case: &Case) -> Option<f64> {
    if !ends_at_limit_load(case) {
        return None;
    }
    solve_by_limit_analysis(&CaseInput { solver: &SelectedSolver::Auto, ..CaseInput::of(case) }).collapse_load()
}

/// The load factor of the case with some keys changed.
fn again(case: &Case, solve: Solve, sets: impl IntoIterator<Item = (String, Json)>) -> Result<f64, String> {
    let other = restated(case, sets)?;
    let result = solve(&CaseInput::of(&other));
    result.collapse_load().ok_or_else(|| result.notes.first().cloned().unwrap_or_else(|| "it does not collapse".into()))
}

/// The estimate in words.
pub(super) fn words(error: &LoadFactorError) -> String {
    let part = |name: &str, part: Option<f64>| part.map(|x| format!("{name} {x:.1e}"));
    let parts = [part("mesh", error.discretisation), part("steps", error.path), part("solution", Some(error.solution))];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    format!("error of the load factor: {:.1e} ({})", error.total(), parts.join(", "))
}
