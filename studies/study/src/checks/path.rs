//! Checks the result of a path. The history (slip before the end) is not stored; equilibrium, strength, contact and
//! mechanism of the state are recomputed.

use crate::checks::fields::{close, path_forces, velocities};
use crate::checks::findings::Findings;
use crate::checks::outputs;
use crate::checks::stored_state::stored_state;
use crate::results::CaseResult;
use crate::results::path_state::{mechanism_of, small};
use crate::solve::CaseInput;
use crate::solve::associated_load::associated_load;
use crate::solve::limit_points::asked_end;
use crate::solve::ours::path_is_ours;
use crate::solve::path_status::{ELSEWHERE, meeting_bounds, ordered};
use crate::solve::safe_theorem::safe_theorem_holds;
use crate::study::Case;
use voussoir_core::certificate::{
    CentroidVelocity, Mechanism, MechanismPlace, PathChecker, flow_residual, forces_rest, path_structure,
    power_residual, ray_residual,
};
use voussoir_core::limit::{Greatest, Status};
use voussoir_core::model::Assembly;
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::path::{LimitPointEnd, LoadStepEnd, PathObserver, PathProblem, PathState};

/// Returns the condition that a residual measures.
fn residual_words(name: &str) -> String {
    match name {
        "path_equilibrium" => "equilibrium",
        "path_strength" => "the strength of the joints",
        "path_complementarity" => "contact, which presses only at closed points",
        "path_kinematics" => "compatibility of gaps and displacements",
        "path_penetration" => "contact without penetration",
        "path_law" => "the law of a joint",
        "path_yield" => "the yield surface of a material",
        other => return format!("the condition {other}"),
    }
    .to_string()
}

/// Checks the result of a case that was solved by a path solver.
pub(crate) fn verify(case: &Case, result: &CaseResult, findings: &mut Findings) -> Result<(), String> {
    let assembly = &case.assembly;
    let problem = path_structure(assembly, &case.stages)?;
    let finite = case.solver.settings.finite;
    let state = stored_state(assembly, &problem, result, finite)?;
    let mut checker = PathChecker::new(finite);
    checker.state(&problem, &state);
    // The energies of a path do not follow from one state.
    for (name, value) in checker.worst.iter().filter(|(name, _)| **name != "path_energy") {
        let words =
            format!("the stored forces and displacements violate {}: {value:.2e} instead of 0", residual_words(name));
        findings.expect(small(name, *value), &words);
    }
    if matches!(result.status, Status::Collapse | Status::LimitPoint) && result.load_factor.is_some() {
        let same = result.load_factor == result.proof.field_factor;
        let factors =
            (result.load_factor, "field_factor, the factor of the stored forces, is", result.proof.field_factor);
        findings.expect_entry(same, "load_factor", factors);
    }
    verify_status(case, &problem, &state, result, findings);
    verify_range(case, &problem, &state, result, findings);
    outputs::verify(case, (&problem, &state), result, findings);
    let place = result.path.followed_to.as_ref().map(|end| MechanismPlace::of(state.factor, end.factor));
    if let (Some(mechanism), Some(place)) = (&result.mechanism, place) {
        let places = (mechanism.at, "by field_factor and followed_to it must be", place);
        findings.expect_entry(mechanism.at == Some(place), "mechanism.at", places);
    }
    let rest = forces_rest(&problem, finite, place);
    if result.status == Status::Collapse && rest {
        findings.expect(result.proof.motion.is_some(), "motion is missing, but the status is collapse");
    }
    if let (Some(motion), true) = (&result.proof.motion, rest) {
        let velocities = velocities(assembly, motion)?;
        verify_motion((assembly, &problem), &state, &velocities, result, findings);
    }
    if result.status == Status::Unbounded {
        let ray = path_forces(
            assembly,
            &problem,
            result.proof.ray.as_deref().ok_or("ray is missing, but the status is unbounded")?,
            &[],
        )?;
        let residual = ray_residual(&problem, &problem.load_steps[state.load_step].loading, &ray);
        let words = format!("ray: its forces do not balance the live load; the relative residual is {residual:.2e}");
        findings.expect(small("path_ray", residual), &words);
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
        findings.expect_entry(same, "bounds", (result.bounds, "the stored state and limit analysis prove", met));
    }
    match result.status {
        Status::Stands => {
            let at_target = problem.load_steps.last().is_some_and(|step| match step.end {
                LoadStepEnd::Factor(end) => close(state.factor, end),
                LoadStepEnd::Collapse(end) => end.is_finite() && (state.factor >= end || close(state.factor, end)),
            });
            let words = format!(
                "the status is stands, but the stored state at the factor {} is not at the target of the last stage",
                state.factor
            );
            findings.expect(at_target, &words);
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
            let proves = "the stored state proves";
            findings.expect_entry(same(stored[0], lower), "the lower end of bounds", (stored[0], proves, lower));
            findings.expect_entry(same(result.load_factor, lower), "load_factor", (result.load_factor, proves, lower));
            let ends = (stored[1], "limit analysis proves", upper);
            findings.expect_entry(same(stored[1], upper), "the upper end of bounds", ends);
        }
        _ => {}
    }
    let greatest = match (result.status, met) {
        (Status::Open, _) => Greatest::Open,
        (_, Some(_)) => Greatest::ProvedOptimal,
        _ => Greatest::ProvedOnThePath,
    };
    let values = (result.greatest, "with this status and these bounds it must be", greatest);
    findings.expect_entry(result.greatest == greatest, "greatest", values);
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
    let first = own.first().copied().or(result.load_factor.filter(|_| ends)).filter(|_| !step.gravity);
    let has_factor = result.status != Status::Stands && result.load_factor.is_some();
    let fits = !(has_factor || step.gravity) || path.first_limit_point == first;
    let reason = match step.gravity {
        true => "while gravity is applied it must be",
        false => "the first entry of limit_points, or load_factor, is",
    };
    let values = (path.first_limit_point, reason, first);
    findings.expect_entry(fits, "first_limit_point", values);
    if let Some(greatest) = result.load_factor.filter(|_| ends) {
        let rises = |factor: &f64| (factor - greatest) * (greatest - step.start) > 0.0 && !close(*factor, greatest);
        if let Some(above) = own.iter().find(|factor| rises(factor)) {
            findings.expect_entry(false, "load_factor", (greatest, "limit_points has a greater factor,", above));
        }
    }
    let asked = asked_end(&case.solver.settings, step);
    let fits = match path.continuation {
        Some(LimitPointEnd::JointLost | LimitPointEnd::None) => result.status == Status::LimitPoint,
        asked_for => asked_for == asked.filter(|_| result.status == Status::LimitPoint),
    };
    let expected = asked.filter(|_| result.status == Status::LimitPoint);
    let values = (path.continuation, "with this status and these stages it must be", expected);
    findings.expect_entry(fits, "continuation", values);
    findings.expect(path.followed_to.is_some(), "followed_to is missing; every path has it");
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
    findings.expect(
        small("path_flow", flow),
        &format!(
            "motion: the joints move in directions that their laws do not allow; the relative residual is {flow:.2e}"
        ),
    );
    if result.status == Status::Collapse {
        let power = power_residual(problem, &problem.load_steps[state.load_step].loading, &rates);
        let words =
            format!("motion: the live load at factor 1 must do the work 1 on it; the difference is {power:.2e}");
        findings.expect(small("path_power", power), &words);
    }
    let unique = result.mechanism.as_ref().and_then(|m| m.unique);
    let found = mechanism_of((assembly, problem), state, velocities, unique, false);
    let kind = |m: &Option<Mechanism>| m.as_ref().map(|m| (m.kind, m.hinge_count));
    let kinds = (kind(&result.mechanism), "the stored motion gives", kind(&found));
    findings.expect_entry(kinds.0 == kinds.2, "mechanism (kind and hinge_count)", kinds);
}
