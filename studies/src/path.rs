//! Answering one case by a path solver, with its certificate.

use crate::answer::{Question, field_entries, stalled, thrust_line};
use crate::results::{CaseResult, DisplacementEntry, EventEntry, MotionEntry, StageResult};
use crate::study::Case;
use std::collections::BTreeMap;
use voussoir_core::certificate::{
    CentroidVelocity, Certificate, ContactForce, Mechanism, PathChecker, flow_residual, jumps, largest_jump, mechanism,
    mechanism_above, power_residual, ray_residual, tolerance,
};
use voussoir_core::law::FlowRule;
use voussoir_core::limit::Status;
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::model::{Assembly, Target};
use voussoir_core::path::{Displaced, PathAnswer, PathObserver, PathProblem, PathSolver, PathState, coarse_joints};

/// Whether a residual is within its bound for results; NaN is not, where there is one.
fn small(name: &str, value: f64) -> bool {
    let bound = tolerance(name).result;
    value <= bound || bound.is_infinite()
}

/// Jumps below this share of the greatest are the blocks' deformation: where a path ends in rates on which
/// forces change (peaks of finite displacements, blocks that yield) every joint moves a little.
const DEFORMATION: f64 = 0.1;

/// The mechanism of a motion at a state.
fn mechanism_of(
    (assembly, problem): (&Assembly, &PathProblem),
    state: &PathState,
    motion: &[CentroidVelocity],
    unique: Option<bool>,
    finite: bool,
) -> Option<Mechanism> {
    let deforming = finite || !state.yielded.iter().all(Option::is_none);
    let found = if deforming {
        mechanism_above(DEFORMATION, assembly, motion, unique, FlowRule::NonAssociated)
    } else {
        mechanism(assembly, motion, unique, FlowRule::NonAssociated)
    };
    found.map(|found| crate::yielded::with_crushing(found, assembly, problem, &state.yielded))
}

/// A path's certificate, with somebody else who looks on.
struct Watched<'a> {
    checker: PathChecker,
    observer: &'a mut dyn PathObserver,
}

impl PathObserver for Watched<'_> {
    fn state(&mut self, problem: &PathProblem, state: &PathState) -> bool {
        self.checker.state(problem, state) && self.observer.state(problem, state)
    }
}

/// Answers a case along its path; `observer` sees every state.
pub fn answer(question: &Question, tag: &str, solver: &dyn PathSolver, observer: &mut dyn PathObserver) -> CaseResult {
    let assembly = question.assembly;
    let problem = match PathProblem::new(assembly, question.stages) {
        Ok(problem) => problem,
        Err(why) => return failed(tag, why),
    };
    if let Some(why) = solver.refuses(&problem, question.settings) {
        return failed(tag, format!("{tag}: {why}"));
    }
    let mut watched = Watched { checker: PathChecker::new(question.settings.finite), observer };
    let solved = solver.trace(&problem, question.settings, &mut watched);
    result(question, tag, &problem, solved, watched.checker)
}

fn failed(tag: &str, why: String) -> CaseResult {
    CaseResult { solver: tag.into(), ..stalled(why) }
}

/// Displacement of a point that moves rigidly with a body: \[u_x, u_y, θ\] at `from`, u + R(θ) a − a
/// with a = to − from; linear in θ where displacements are small.
fn carried([x, y, theta]: [f64; 3], from: Vec2, to: Vec2, finite: bool) -> Vec2 {
    let arm = to - from;
    let swing = if finite { arm * (theta.cos() - 1.0) + turned(arm) * theta.sin() } else { turned(arm) * theta };
    Vec2::new(x, y) + swing
}

/// Rigid motion of a block's body about its pole, from the displacement of the block's centroid.
pub(crate) fn of_body(
    assembly: &Assembly,
    problem: &PathProblem,
    block: usize,
    displacement: [f64; 3],
    finite: bool,
) -> [f64; 3] {
    let pole = problem.bodies[problem.body_of[block]].pole;
    let u = carried(displacement, assembly.inertia(block).centroid, pole, finite);
    [u.x, u.y, displacement[2]]
}

/// Displacement of every block at its centroid from the rigid motions of the path's bodies.
fn displacements(assembly: &Assembly, problem: &PathProblem, motion: &[[f64; 3]], finite: bool) -> Vec<[f64; 3]> {
    let of_block = |block: usize| {
        let body = problem.body_of[block];
        let u = carried(motion[body], problem.bodies[body].pole, assembly.inertia(block).centroid, finite);
        [u.x, u.y, motion[body][2]]
    };
    (0..assembly.bodies.len()).map(of_block).collect()
}

/// Velocity of every block at its centroid from those of the path's bodies about their poles, which
/// are in the places that `placed` moves them to. What moves by rounding beside the greatest stands
/// still where the ground holds it.
fn velocities(
    assembly: &Assembly,
    problem: &PathProblem,
    rates: &[[f64; 3]],
    placed: Option<&[[f64; 3]]>,
) -> Vec<CentroidVelocity> {
    let mut all: Vec<CentroidVelocity> = (0..assembly.bodies.len())
        .map(|block| {
            let body = problem.body_of[block];
            let [x, y, omega] = rates[body];
            let arm = assembly.inertia(block).centroid - problem.bodies[body].pole;
            let angle = placed.map_or(0.0, |motion| motion[body][2]);
            let arm = arm * angle.cos() + turned(arm) * angle.sin();
            let v = Vec2::new(x, y) + turned(arm) * omega;
            [v.x, v.y, omega]
        })
        .collect();
    let largest = all.iter().flatten().fold(0.0, |a: f64, v| a.max(v.abs()));
    for (velocity, group) in all.iter_mut().zip(assembly.rigid_groups().0) {
        if group.is_none() && velocity.iter().all(|v| v.abs() <= 1e-7 * largest) {
            *velocity = [0.0; 3];
        }
    }
    all
}

fn result(
    question: &Question,
    tag: &str,
    problem: &PathProblem,
    solved: PathAnswer,
    checker: PathChecker,
) -> CaseResult {
    let assembly = question.assembly;
    let mut certificate = Certificate { passed: true, residuals: BTreeMap::new(), failures: Vec::new() };
    for (name, value) in &checker.worst {
        certificate.residuals.insert((*name).into(), *value);
        if !small(name, *value) {
            certificate.passed = false;
            certificate.failures.push(format!("{name} is {value:.2e}"));
        }
    }
    let field: Vec<ContactForce> = problem
        .contacts
        .iter()
        .zip(&solved.state.force)
        .map(|(c, force)| ContactForce { joint: c.joint, point: c.position, force: *force })
        .collect();
    let ray = solved.ray.as_ref().map(|ray| {
        let forces = problem.contacts.iter().zip(ray);
        forces.map(|(c, force)| ContactForce { joint: c.joint, point: c.position, force: *force }).collect::<Vec<_>>()
    });
    let finite = question.settings.finite;
    let mut rates = solved.motion.clone();
    if let (Status::NoEquilibrium, Some(rates)) = (solved.status, &mut rates) {
        let largest = largest_jump(&jumps(assembly, &velocities(assembly, problem, rates, None)));
        rates.iter_mut().flatten().for_each(|v| *v /= largest);
    }
    let motion = rates.as_ref().map(|rates| velocities(assembly, problem, rates, None));
    if let (Some(motion), false) = (&solved.motion, question.settings.finite) {
        let flow = flow_residual(problem, &solved.state.force, motion);
        certificate.residuals.insert("path_flow".into(), flow);
        if !small("path_flow", flow) {
            certificate.passed = false;
            certificate.failures.push(format!("the mechanism leaves the flow of the laws by {flow:.2e}"));
        }
    }
    let mut status = solved.status;
    let mut notes = solved.notes;
    notes.extend(coarse_joints(problem, assembly).first().map(|coarse| {
        format!(
            "joint {}: contact points {:.3} m apart are coarse for its characteristic length E G_I / f_t² = {:.3} m; \
             refine scene.mesh until three points and more stand in that length",
            coarse.joint, coarse.spacing, coarse.length
        )
    }));
    if status == Status::Stalled {
        certificate.passed = false;
        certificate.failures.push("not proven".into());
    }
    if !certificate.passed && status != Status::Stalled {
        notes.push(format!("{tag}: {}", certificate.failures.join("; ")));
        status = Status::Stalled;
    }
    let load_step = &problem.load_steps[solved.load_step];
    let stage = load_step.stage;
    let load_factor = match status {
        Status::Collapse | Status::LimitPoint if !load_step.gravity => solved.factor,
        _ => None,
    };
    let name = |body: usize| assembly.bodies[body].name.clone();
    // The mechanism is read at the undeformed place, velocities are those at the displaced one.
    let read = |motion| mechanism_of((assembly, problem), &solved.state, motion, solved.unique, finite);
    let mechanism = motion.as_deref().and_then(read);
    let hinges = mechanism.iter().flat_map(|m| &m.hinges).map(|hinge| hinge.joint).collect();
    let mut stages: Vec<StageResult> = question.stages[..stage]
        .iter()
        .map(|earlier| StageResult {
            name: earlier.name.clone(),
            status: Status::Stands,
            factor: match earlier.target {
                Target::Factor(factor) => Some(factor),
                Target::Collapse => None,
            },
            hinges: Vec::new(),
        })
        .collect();
    let reached = match status {
        Status::Stands => match question.stages[stage].target {
            Target::Factor(factor) => Some(factor),
            Target::Collapse => solved.factor,
        },
        _ => load_factor,
    };
    stages.push(StageResult { name: question.stages[stage].name.clone(), status, factor: reached, hinges });
    if status == Status::Stands {
        for idle in &question.stages[stage + 1..] {
            let Target::Factor(factor) = idle.target else { continue };
            let (name, factor) = (idle.name.clone(), Some(factor));
            stages.push(StageResult { name, status, factor, hinges: Vec::new() });
        }
    }
    let events = solved
        .events
        .iter()
        .map(|event| {
            let (load_step, contact) = (&problem.load_steps[event.load_step], &problem.contacts[event.contact]);
            EventEntry {
                stage: question.stages[load_step.stage].name.clone(),
                factor: event.factor,
                gravity: load_step.gravity,
                joint: contact.joint,
                point: contact.position.into(),
                what: event.what,
            }
        })
        .collect();
    let motion = match (finite, &rates) {
        (true, Some(rates)) => Some(velocities(assembly, problem, rates, Some(&solved.state.motion))),
        _ => motion,
    };
    let displacements = displacements(assembly, problem, &solved.state.motion, finite);
    let mut counters = solved.counters;
    counters.insert("states".into(), checker.states);
    let open: Vec<ContactForce> = problem
        .contacts
        .iter()
        .zip(&field)
        .filter(|(contact, _)| !contact.law.is_bonded())
        .map(|(_, force)| *force)
        .collect();
    CaseResult {
        status,
        load_factor,
        solver: tag.into(),
        mechanism,
        field_factor: Some(solved.state.factor),
        thrust_line: thrust_line(assembly, &open),
        field: Some(field_entries(&field)),
        ray: ray.as_deref().map(field_entries),
        motion: motion.map(|motion| {
            motion.into_iter().enumerate().map(|(body, velocity)| MotionEntry { body: name(body), velocity }).collect()
        }),
        displacements: Some(
            displacements
                .into_iter()
                .enumerate()
                .map(|(body, displacement)| DisplacementEntry { body: name(body), displacement })
                .collect(),
        ),
        yielded: crate::yielded::entries(assembly, problem, &solved.state),
        joint_states: (!solved.state.memory.is_empty()).then_some(solved.state.memory),
        certificate,
        counters,
        stages,
        events,
        curve: Some(checker.curve),
        notes,
        ..stalled(String::new())
    }
}

/// What a path's result claims that its own numbers do not confirm. The history (slip before the
/// end) is not stored; equilibrium, strength, contact and mechanism of the state are recomputed.
pub fn verify(case: &Case, result: &CaseResult) -> Result<Vec<String>, String> {
    let assembly = &case.assembly;
    let problem = PathProblem::new(assembly, &case.stages)?;
    let finite = case.solver.kinematics == crate::study::Kinematics::Finite;
    let mut wrong = Vec::new();
    let mut expect = |fine: bool, what: &str| {
        if !fine {
            wrong.push(what.to_string());
        }
    };
    let read = |entries: &[crate::results::FieldEntry]| -> Result<Vec<[f64; 2]>, String> {
        let forces = crate::verify::contacts(assembly, entries)?;
        let same = forces.len() == problem.contacts.len()
            && forces
                .iter()
                .zip(&problem.contacts)
                .all(|(f, c)| f.joint == c.joint && (f.point - c.position).norm() <= 1e-9 * problem.length);
        if same {
            Ok(forces.iter().map(|f| f.force).collect())
        } else {
            Err("field: not the contact points of the scene".into())
        }
    };
    let stage = result.stages.len() - 1;
    let load_step = problem.load_steps.iter().rposition(|d| d.stage <= stage).ok_or("no load")?;
    let load_step = match result.status {
        Status::NoEquilibrium => problem.load_steps.iter().position(|d| d.stage == stage).unwrap_or(load_step),
        _ => load_step,
    };
    let force = read(result.field.as_deref().ok_or("no field")?)?;
    let displaced = result.displacements.as_ref().ok_or("no displacements")?;
    let mut motion = vec![[0.0; 3]; problem.bodies.len()];
    expect(displaced.len() == assembly.bodies.len(), "displacements: not one per block");
    for (block, entry) in displaced.iter().enumerate().take(assembly.bodies.len()) {
        expect(entry.body == assembly.bodies[block].name, "displacements: another block");
        motion[problem.body_of[block]] = of_body(assembly, &problem, block, entry.displacement, finite);
    }
    let factor = result.field_factor.ok_or("no factor of the field")?;
    let mut state = PathState { load_step, factor, force, motion, ..PathState::default() };
    state.gap = vec![[0.0; 2]; problem.contacts.len()];
    state.memory = result.joint_states.clone().unwrap_or_default();
    state.yielded = crate::yielded::read(assembly, &problem, &result.yielded)?;
    let mut checker = PathChecker::new(finite);
    state.gap = Displaced::new(&problem, &state, finite).gaps();
    checker.state(&problem, &state);
    for (name, value) in &checker.worst {
        expect(small(name, *value), &format!("{name} is {value:.2e}"));
    }
    if matches!(result.status, Status::Collapse | Status::LimitPoint) && result.load_factor.is_some() {
        expect(result.load_factor == result.field_factor, "the load factor is not that of the field");
    }
    if result.status == Status::Collapse {
        expect(result.motion.is_some(), "a collapse without a mechanism");
    }
    if let (Some(_), false) = (&result.motion, finite) {
        let velocities = crate::verify::velocities(assembly, result.motion.as_deref().unwrap_or_default())?;
        let mut rates = vec![[0.0; 3]; problem.bodies.len()];
        for (block, [x, y, omega]) in velocities.iter().enumerate() {
            let body = problem.body_of[block];
            let v = Vec2::new(*x, *y) + turned(problem.bodies[body].pole - assembly.inertia(block).centroid) * *omega;
            rates[body] = [v.x, v.y, *omega];
        }
        let flow = flow_residual(&problem, &state.force, &rates);
        expect(small("path_flow", flow), &format!("the mechanism leaves the flow of the laws by {flow:.2e}"));
        if result.status == Status::Collapse {
            let power = power_residual(&problem, &problem.load_steps[load_step].loading, &rates);
            expect(small("path_power", power), "the mechanism is not scaled to p·q̇ = 1");
        }
        let unique = result.mechanism.as_ref().and_then(|m| m.unique);
        let found = mechanism_of((assembly, &problem), &state, &velocities, unique, finite);
        let kind = |m: &Option<voussoir_core::certificate::Mechanism>| m.as_ref().map(|m| (m.kind, m.hinge_count));
        expect(kind(&found) == kind(&result.mechanism), "the mechanism is not that of the motion");
    }
    if result.status == Status::Unbounded {
        let ray = read(result.ray.as_deref().ok_or("unbounded without a ray")?)?;
        let residual = ray_residual(&problem, &problem.load_steps[load_step].loading, &ray);
        expect(small("path_ray", residual), "the ray does not carry the load");
    }
    Ok(wrong)
}
