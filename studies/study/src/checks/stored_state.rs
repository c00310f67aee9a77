//! The state of a path that a result stores.

use crate::checks::fields::{path_forces, path_motion};
use crate::results::CaseResult;
use crate::results::inelastic_state;
use voussoir_core::certificate::Displaced;
use voussoir_core::limit::Status;
use voussoir_core::model::Assembly;
use voussoir_core::path::{PathProblem, PathState};

/// Builds the end state of a result from its entries.
pub(super) fn stored_state(
    assembly: &Assembly,
    problem: &PathProblem,
    result: &CaseResult,
    finite: bool,
) -> Result<PathState, String> {
    let stage = result.stages.len() - 1;
    let load_step = problem
        .load_steps
        .iter()
        .rposition(|d| d.stage <= stage)
        .ok_or("the study has no loads for the stages of this result")?;
    let load_step = match result.status {
        Status::NoEquilibrium => problem.load_steps.iter().position(|d| d.stage == stage).unwrap_or(load_step),
        _ => load_step,
    };
    let force =
        path_forces(assembly, problem, result.proof.field.as_deref().ok_or("field is missing")?, &result.proof.fill)?;
    let motion = path_motion(assembly, problem, result, finite)?;
    let factor = result.proof.field_factor.ok_or("field_factor is missing")?;
    let mut state = PathState { load_step, factor, force, motion, ..PathState::default() };
    state.gap = vec![[0.0; 2]; problem.contacts.len()];
    state.memory = result.path.joint_states.clone().unwrap_or_default();
    state.time_step = result.path.joint_time_step.unwrap_or(0.0);
    state.step_gap = result.path.joint_gaps.clone().unwrap_or_default();
    state.yielded = inelastic_state::read(assembly, problem, &result.path.yielded)?;
    state.gap = Displaced::new(problem, &state, finite).gaps().to_vec();
    Ok(state)
}
