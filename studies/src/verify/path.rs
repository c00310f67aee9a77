//! Checks the result of a path. The history (slip before the end) is not stored; equilibrium, strength, contact and
//! mechanism of the state are recomputed.

use super::fields::{close, path_forces, path_motion, velocities};
use super::findings::Findings;
use crate::results::CaseResult;
use crate::results::inelastic_state;
use crate::results::path_state::{mechanism_of, small};
use crate::solve::CaseInput;
use crate::solve::associated_load::associated_load;
use crate::solve::limit_points::asked_end;
use crate::solve::ours::path_is_ours;
use crate::solve::path_status::{ELSEWHERE, meeting_bounds, ordered};
use crate::solve::safe_theorem::safe_theorem_holds;
use crate::study::Case;
use voussoir_core::certificate::{
    CentroidVelocity, Displaced, Mechanism, MechanismPlace, PathChecker, flow_residual, forces_rest, path_structure,
    power_residual, ray_residual,
};
use voussoir_core::limit::{Greatest, Status};
use voussoir_core::model::Assembly;
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::path::{LimitPointEnd, LoadStepEnd, PathObserver, PathProblem, PathState};

/// Checks the result of a case that was solved by a path solver.
pub(super) fn verify(case: &Case, result: &CaseResult, findings: &mut Findings) -> Result<(), String> {
    let assembly = &case.assembly;
    let problem = path_structure(assembly, &case.stages)?;
    let finite = case.solver.settings.finite;
    let state = stored_state(assembly, &problem, result, finite)?;
    let mut checker = PathChecker::new(finite);
    checker.state(&problem, &state);
    // The energies of a path do not follow from one state.
    for (name, value) in checker.worst.iter().filter(|(name, _)| **name != "path_energy") {
        findings.expect(small(name, *value), &format!("{name} is {value:.2e}"));
    }
    if matches!(result.status, Status::Collapse | Status::LimitPoint) && result.load_factor.is_some() {
        let same = result.load_factor == result.proof.field_factor;
        findings.expect(same, "the load factor is not that of the field");
    }
    verify_status(case, &problem, &state, result, findings);
    verify_range(case, &problem, &state, result, findings);
    let place = result.path.followed_to.as_ref().map(|end| MechanismPlace::of(state.factor, end.factor));
    if let (Some(mechanism), Some(place)) = (&result.mechanism, place) {
        findings.expect(mechanism.at == Some(place), "the place of the mechanism does not fit the end of the path");
    }
    let rest = forces_rest(&problem, finite, place);
    if result.status == Status::Collapse && rest {
        findings.expect(result.proof.motion.is_some(), "a collapse without a mechanism");
    }
    if let (Some(motion), true) = (&result.proof.motion, rest) {
        let velocities = velocities(assembly, motion)?;
        verify_motion((assembly, &problem), &state, &velocities, result, findings);
    }
    if result.status == Status::Unbounded {
        let ray = path_forces(assembly, &problem, result.proof.ray.as_deref().ok_or("unbounded without a ray")?, &[])?;
        let residual = ray_residual(&problem, &problem.load_steps[state.load_step].loading, &ray);
        findings.expect(small("path_ray", residual), "the ray does not carry the load");
    }
    Ok(())
}

/// Checks the parts of the status beyond the state: the target of the stage, bounds, and a solver that is believed.
fn verify_status(case: &Case, problem: &PathProblem, state: &PathState, result: &CaseResult, findings: &mut Findings) {
    let input = CaseInput::of(case);
    let field_is_proof = !input.settings.finite && safe_theorem_holds(&case.assembly);
    let stands_by_field = result.status == Status::Stands && field_is_proof;
    if result.status.is_answer() {
        // If states prove the end, the same states are found by solving again.
        let checked = result.path.end_is_checked == Some(true);
        let believed = path_is_ours(&result.solver, input.settings) || stands_by_field || checked;
        findings.expect(believed, ELSEWHERE);
    }
    let is_last = state.load_step + 1 == problem.load_steps.len();
    let met = match result.status {
        Status::Collapse if is_last => associated_load(&input).and_then(|load| meeting_bounds(state.factor, &load)),
        _ => None,
    };
    if result.status.is_answer() {
        let stored = result.bounds.map(|bounds| bounds.map(|end| end.unwrap_or(f64::NAN)));
        let same = match (stored, met) {
            (Some(stored), Some(met)) => close(stored[0], met[0]) && close(stored[1], met[1]),
            (stored, met) => stored.is_none() && met.is_none(),
        };
        findings.expect(same, "the state and limit analysis do not prove the bounds");
    }
    match result.status {
        Status::Stands => {
            let at_target = problem.load_steps.last().is_some_and(|step| match step.end {
                LoadStepEnd::Factor(end) => close(state.factor, end),
                LoadStepEnd::Collapse(end) => end.is_finite() && (state.factor >= end || close(state.factor, end)),
            });
            findings.expect(at_target, "the state is not at the target of the last stage");
        }
        Status::Open => {
            let upper = associated_load(&input).filter(|_| is_last).map(|load| load.factor);
            let lower = Some(state.factor).filter(|_| result.load_factor.is_some());
            let stored = result.bounds.unwrap_or_default();
            let same = |a: Option<f64>, b: Option<f64>| match (a, b) {
                (Some(a), Some(b)) => close(a, b),
                (a, b) => a == b,
            };
            let [lower, upper] = ordered(lower, upper);
            findings.expect(
                same(stored[0], lower) && same(result.load_factor, lower),
                "the state does not prove the lower end",
            );
            findings.expect(same(stored[1], upper), "limit analysis does not prove the upper end");
        }
        _ => {}
    }
    let greatest = match (result.status, met) {
        (Status::Open, _) => Greatest::Open,
        (_, Some(_)) => Greatest::ProvedOptimal,
        _ => Greatest::ProvedOnThePath,
    };
    findings.expect(result.greatest == greatest, "greatest does not fit the status");
}

/// Checks limit points, the reason why the path ends at one, and the end of its range.
fn verify_range(case: &Case, problem: &PathProblem, state: &PathState, result: &CaseResult, findings: &mut Findings) {
    let (path, step) = (&result.path, &problem.load_steps[state.load_step]);
    let stage = &case.stages[step.stage].name;
    let own: Vec<f64> = path
        .limit_points
        .iter()
        .filter(|peak| peak.stage == *stage && peak.gravity == step.gravity)
        .map(|peak| peak.factor)
        .collect();
    let ends = matches!(result.status, Status::Collapse | Status::LimitPoint);
    let first = own.first().copied().or(result.load_factor.filter(|_| ends));
    let has_factor = result.status != Status::Stands && result.load_factor.is_some();
    findings.expect(!has_factor || path.first_limit_point == first, "first_limit_point is not the first limit point");
    if let Some(greatest) = result.load_factor.filter(|_| ends) {
        let rises = |factor: &f64| (factor - greatest) * (greatest - step.start) > 0.0 && !close(*factor, greatest);
        findings.expect(!own.iter().any(rises), "a limit point lies above the load factor");
    }
    let asked = asked_end(&case.solver.settings, step);
    let fits = match path.continuation {
        Some(LimitPointEnd::JointLost | LimitPointEnd::None) => result.status == Status::LimitPoint,
        asked_for => asked_for == asked.filter(|_| result.status == Status::LimitPoint),
    };
    findings.expect(fits, "continuation does not fit the status and the question");
    findings.expect(path.followed_to.is_some(), "a path without followed_to");
}

/// Builds the end state of a result from its entries.
fn stored_state(
    assembly: &Assembly,
    problem: &PathProblem,
    result: &CaseResult,
    finite: bool,
) -> Result<PathState, String> {
    let stage = result.stages.len() - 1;
    let load_step = problem.load_steps.iter().rposition(|d| d.stage <= stage).ok_or("no load")?;
    let load_step = match result.status {
        Status::NoEquilibrium => problem.load_steps.iter().position(|d| d.stage == stage).unwrap_or(load_step),
        _ => load_step,
    };
    let force = path_forces(assembly, problem, result.proof.field.as_deref().ok_or("no field")?, &result.proof.fill)?;
    let motion = path_motion(assembly, problem, result, finite)?;
    let factor = result.proof.field_factor.ok_or("no factor of the field")?;
    let mut state = PathState { load_step, factor, force, motion, ..PathState::default() };
    state.gap = vec![[0.0; 2]; problem.contacts.len()];
    state.memory = result.path.joint_states.clone().unwrap_or_default();
    state.yielded = inelastic_state::read(assembly, problem, &result.path.yielded)?;
    state.gap = Displaced::new(problem, &state, finite).gaps();
    Ok(state)
}

/// The motion of a path with small displacements: its flow, its scale and its mechanism.
fn verify_motion(
    (assembly, problem): (&Assembly, &PathProblem),
    state: &PathState,
    velocities: &[CentroidVelocity],
    result: &CaseResult,
    findings: &mut Findings,
) {
    let mut rates = vec![[0.0; 3]; problem.bodies.len()];
    for (block, [x, y, omega]) in velocities.iter().enumerate() {
        let body = problem.body_of[block];
        let v = Vec2::new(*x, *y) + turned(problem.bodies[body].pole - assembly.inertia(block).centroid) * *omega;
        rates[body] = [v.x, v.y, *omega];
    }
    let flow = flow_residual(problem, &state.force, &rates);
    findings.expect(small("path_flow", flow), &format!("the mechanism leaves the flow of the laws by {flow:.2e}"));
    if result.status == Status::Collapse {
        let power = power_residual(problem, &problem.load_steps[state.load_step].loading, &rates);
        findings.expect(small("path_power", power), "the mechanism is not scaled to p·q̇ = 1");
    }
    let unique = result.mechanism.as_ref().and_then(|m| m.unique);
    let found = mechanism_of((assembly, problem), state, velocities, unique, false);
    let kind = |m: &Option<Mechanism>| m.as_ref().map(|m| (m.kind, m.hinge_count));
    findings.expect(kind(&found) == kind(&result.mechanism), "the mechanism is not that of the motion");
}
