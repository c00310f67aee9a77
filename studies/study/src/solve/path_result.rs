//! The answer of a path solver in the form of a result, with its certificate.

use super::associated_load::associated_load;
use super::case_input::CaseInput;
use super::coarse_joints::coarse_joints;
use super::limit_mechanism::end_in_limit_mechanism;
use super::limit_points::{
    add_last_limit_point, first_limit_point, followed_to, limit_point_end, limit_points, search_range,
};
use super::load_history::LoadHistory;
use super::path_proof::PathProof;
use super::path_status::{Evidence, PathVerdict, Progress};
use super::safe_theorem::safe_theorem_holds;
use super::solver_outputs::solver_outputs;
use super::stored_path::stored;
use super::symmetric::symmetric;
use crate::results::convert::{field_entries, motion_entries};
use crate::results::inelastic_state;
use crate::results::path_state::{carried, mechanism_of, open_hinges, small};
use crate::results::stored_path::PathEntry;
use crate::results::thrust_line::thrust_line;
use crate::results::{
    BranchEntry, CaseResult, DisplacementEntry, EndProof, EventEntry, PathRecord, Proof, ProofFields, StabilityEntry,
    StageResult, StateEntry,
};
use crate::solve::load_entries::path_fill;
use std::collections::BTreeMap;
use std::sync::Arc;
use voussoir_core::certificate::{
    CentroidVelocity, Certificate, ContactForce, Hinge, Mechanism, MechanismPlace, PathChain, PathChecker,
    flow_residual, forces_rest, jumps, largest_jump, tolerance,
};
use voussoir_core::limit::Status;
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::model::{Assembly, Stage, Target};
use voussoir_core::path::{Branching, PathAnswer, PathEvent, PathProblem, PathState, StageStability};
use voussoir_core::plugin::PluginKind;

/// The note on a limit point of laws with a history.
const LOADING_SET: &str = "the limit point is proved for the loading set that was found: another set of points that soften or \
     yield may have a rate that raises the load";

/// Recorded data of a path.
pub(super) struct Seen {
    /// Residuals of all states.
    pub checker: PathChecker,
    /// The states as a chain.
    pub chain: PathChain,
    /// The last state of each stage, by index.
    pub ends: Vec<Option<PathState>>,
    /// The load steps that the states have reached.
    pub progress: Progress,
    /// Share of the energy of a stage that its steps may lose.
    pub energy: f64,
    /// States that are kept.
    pub states: Vec<StateEntry>,
    /// True if parts of the answer that no check proves are kept.
    pub believed: bool,
}

/// Returns the result of a path.
pub(super) fn path_result(
    input: &CaseInput,
    tag: &str,
    problem: &PathProblem,
    mut solved: PathAnswer,
    Seen { checker, mut chain, ends, mut progress, energy, states, believed }: Seen,
) -> CaseResult {
    let (assembly, finite) = (input.assembly, input.settings.finite);
    let associated = associated_load(input);
    if let (Some(load), Some(structure)) = (&associated, checker.structure()) {
        end_in_limit_mechanism(assembly, &structure, load, &mut solved);
    }
    let place = progress.history.last().map(|last| MechanismPlace::of(solved.state.factor, last.factor));
    let rest = forces_rest(problem, finite, place);
    if rest {
        prefer_symmetric(assembly, &checker, &mut solved);
    }
    let mut certificate = certificate(&solved, &checker, rest, energy);
    chain.add_peak(&solved.state);
    let proof = PathProof::new(&chain, problem, input.settings, &solved);
    let end = proof.end();
    let (end_proof, unproved) = (end.as_ref().ok().copied(), end.as_ref().err().cloned());
    let stored = end_proof.and_then(|_| stored(&chain, &solved, input.stored_numbers));
    if believed {
        progress.add_peak(&solved.state);
    } else {
        let limit_points = proof.limit_points();
        leave_out_unproved(&mut solved, end_proof.is_some());
        solved.limit_points = limit_points;
        if finite {
            // The rate just after a limit point is not checked.
            solved.motion = None;
        }
    }
    let evidence = Evidence {
        problem,
        progress: &progress,
        hint: (solved.status, solved.load_step, solved.factor),
        range: search_range(input, problem, &solved),
        certificate: &certificate,
        end: if believed { Ok(()) } else { end.map(|_| ()) },
        field_is_proof: !finite && safe_theorem_holds(assembly),
        associated: associated.as_ref(),
    };
    let PathVerdict { status, greatest, bounds, failures } = evidence.decide();
    let mut notes = solved.notes.clone();
    notes.extend(coarse_note(problem, assembly));
    if !status.is_answer() {
        certificate.passed = false;
        certificate.failures.extend(failures);
        if solved.status.is_answer() {
            notes.push(format!("{tag}: {}", certificate.failures.join("; ")));
        }
        keep_proved(&mut solved, &progress, problem, status);
    }
    let end_proof = end_proof.filter(|_| status.is_answer());
    if end_proof == Some(EndProof::LoadingSet) {
        notes.push(LOADING_SET.into());
    }
    if let Some(why) = unproved.filter(|_| status.is_answer()) {
        notes.push(format!("the end of the path relies on its solver, because its states do not prove it: {why}"));
    }
    solved.status = status;
    add_last_limit_point(&mut solved);
    let load_step = &problem.load_steps[solved.load_step];
    let load_factor = match status {
        Status::Collapse | Status::LimitPoint if !load_step.gravity => solved.factor,
        Status::Open => bounds[0],
        _ => None,
    };
    let rates = scaled_rates(assembly, problem, &solved);
    let motion = rates.as_ref().map(|rates| velocities(assembly, problem, rates, None));
    // The mechanism is evaluated in the undeformed position, velocities in the displaced one.
    let mechanism = motion
        .as_deref()
        .and_then(|motion| mechanism_of((assembly, problem), &solved.state, motion, solved.unique, finite))
        .map(|mechanism| Mechanism { at: place, ..mechanism });
    let reached = match (status, input.stages[load_step.stage].target) {
        (Status::Stands, Target::Factor(factor)) => Some(factor),
        (Status::Stands, Target::Collapse) => solved.factor,
        _ => load_factor,
    };
    let at_end = |stage: usize| ends[stage].as_ref().map(|state| open_hinges(assembly, problem, state));
    let mut hinges: Vec<Vec<Hinge>> = (0..=load_step.stage).map(|stage| at_end(stage).unwrap_or_default()).collect();
    if let (Some(mechanism), Some(last)) = (mechanism.as_ref().filter(|_| status != Status::Stands), hinges.last_mut())
    {
        last.clone_from(&mechanism.hinges);
    }
    let motion = match (finite, &rates) {
        (true, Some(rates)) => Some(velocities(assembly, problem, rates, Some(&solved.state.motion))),
        _ => motion,
    };
    let field = contact_forces(assembly, problem, &solved.state.force);
    let fill = path_fill(assembly, problem, input.stages, &solved.state.force);
    let (outputs, missing) = solver_outputs(PluginKind::PathSolver, tag, &solved.outputs);
    notes.extend(missing);
    let mut counters = solved.counters.clone();
    counters.insert("states".into(), checker.states);
    CaseResult {
        status,
        load_factor,
        bounds: (bounds != [None; 2]).then_some(bounds),
        greatest,
        proved_by: (status == Status::Stands).then_some(Proof::Path),
        solver: tag.into(),
        mechanism,
        proof: ProofFields {
            fill,
            field_factor: Some(solved.state.factor),
            thrust_line: thrust_line(assembly, &unbonded(problem, &field)),
            field: Some(field_entries(&field)),
            ray: solved.ray.as_ref().map(|ray| field_entries(&contact_forces(assembly, problem, ray))),
            motion: motion.map(|motion| motion_entries(assembly, motion)),
            associated_motion: None,
            space: None,
        },
        certificate,
        counters,
        stages: with_stability(
            stage_results(input.stages, load_step.stage, status, reached, hinges),
            &solved.stability,
        ),
        notes,
        outputs,
        path: PathRecord {
            states,
            end_is_checked: Some(end_proof.is_some()),
            end_proof,
            ..path_record(input, problem, solved, checker, &progress.history)
        },
        stored_path: stored.filter(|_| status.is_answer()).map(|path| PathEntry::Numbers(Arc::new(path))),
        ..CaseResult::empty()
    }
}

/// Removes the parts of an answer that no check proves. They are not accepted from a solver outside this project.
fn leave_out_unproved(solved: &mut PathAnswer, end_is_checked: bool) {
    solved.limit_points.clear();
    solved.limit_point_end = solved.limit_point_end.filter(|_| end_is_checked);
    solved.branchings.clear();
    solved.stability.clear();
    solved.events.clear();
    solved.unique = solved.unique.filter(|unique| !unique);
}

/// Keeps only the part of an answer that its states prove: the state with the greatest factor, without a mechanism.
fn keep_proved(solved: &mut PathAnswer, progress: &Progress, problem: &PathProblem, status: Status) {
    (solved.motion, solved.ray, solved.unique) = (None, None, None);
    match progress.load_step().and_then(|at| progress.greatest_of(at)) {
        Some(state) if status == Status::Open => {
            (solved.load_step, solved.factor, solved.state) = (state.load_step, Some(state.factor), state.clone());
        }
        _ => {
            solved.load_step = solved.load_step.min(problem.load_steps.len() - 1);
            solved.factor = None;
        }
    }
}

/// Replaces the mechanism of a symmetric scene by the symmetric one of its load.
fn prefer_symmetric(assembly: &Assembly, checker: &PathChecker, solved: &mut PathAnswer) {
    let (Status::Collapse, Some(structure), Some(rates)) = (solved.status, checker.structure(), &solved.motion) else {
        return;
    };
    let loading = &structure.load_steps[solved.load_step].loading;
    if let Some(mean) = symmetric(assembly, &structure, loading, &solved.state.force, rates) {
        // Its mirror image is another mechanism.
        (solved.motion, solved.unique) = (Some(mean), Some(false));
    }
}

/// Returns the record of the state, the events and the curve of a path.
fn path_record(
    input: &CaseInput,
    problem: &PathProblem,
    solved: PathAnswer,
    checker: PathChecker,
    history: &LoadHistory,
) -> PathRecord {
    let assembly = input.assembly;
    let name = |body: usize| assembly.bodies[body].name.clone();
    let displaced = displacements(assembly, problem, &solved.state.motion, input.settings.finite);
    let entry = |(body, displacement)| DisplacementEntry { body: name(body), displacement };
    let (first, continuation) =
        (first_limit_point(problem, &solved), limit_point_end(input.settings, problem, &solved));
    let mut limit_points = limit_points(input.stages, problem, &solved.limit_points, history);
    if let Some(last) = limit_points.last_mut().filter(|_| continuation.is_some()) {
        // The states just beyond the end of a path depend on the length of its last step.
        (last.released_energy, last.next_state) = (None, None);
    }
    let followed_to = followed_to(input.stages, problem, history);
    let branches = solved.branchings.iter().map(|branching| branch(input.stages, problem, branching)).collect();
    PathRecord {
        displacements: Some(displaced.into_iter().enumerate().map(entry).collect()),
        yielded: inelastic_state::entries(assembly, problem, &solved.state),
        joint_states: (!solved.state.memory.is_empty()).then_some(solved.state.memory),
        joint_time_step: Some(solved.state.time_step).filter(|time_step| *time_step > 0.0),
        joint_gaps: (solved.state.time_step > 0.0).then_some(solved.state.step_gap),
        events: events(input, problem, &solved.events),
        curve: Some(checker.curve),
        first_limit_point: first,
        continuation,
        followed_to,
        limit_points,
        branches,
        states: Vec::new(),
        end_is_checked: None,
        end_proof: None,
    }
}

fn branch(stages: &[Stage], problem: &PathProblem, branching: &Branching) -> BranchEntry {
    BranchEntry {
        stage: stages[problem.load_steps[branching.load_step].stage].name.clone(),
        factor: branching.factor,
        what: if branching.snaps { "snap" } else { "bifurcation" }.into(),
        released_energy: branching.released,
        twins: branching.twins,
    }
}

/// Adds the stability of their last states to the results of stages.
fn with_stability(mut results: Vec<StageResult>, found: &[StageStability]) -> Vec<StageResult> {
    for (index, result) in results.iter_mut().enumerate() {
        let Some(own) = found.iter().find(|own| own.stage == index) else { continue };
        let word = match (own.under_load, own.sufficient_only) {
            (None, _) => "not_proven",
            (Some(_), true) => "sufficient",
            (Some(_), false) => "proven",
        };
        result.stability = StabilityEntry {
            stable_under_load: own.under_load,
            stable_under_control: own.under_control,
            stability: Some(word.into()),
        };
    }
    results
}

/// Returns the residuals of all states, with their tolerances. If forces `rest` along the mechanism, its flow is included.
fn certificate(solved: &PathAnswer, checker: &PathChecker, rest: bool, energy: f64) -> Certificate {
    let mut certificate = Certificate { passed: true, residuals: BTreeMap::new(), failures: Vec::new() };
    for (name, value) in &checker.worst {
        certificate.residuals.insert((*name).into(), *value);
        let bound = if *name == "path_energy" { energy } else { tolerance(name).result };
        if value.is_nan() || *value > bound {
            certificate.passed = false;
            certificate.failures.push(format!("{name} is {value:.2e}"));
        }
    }
    if let (Some(structure), Some(motion), true) = (checker.structure(), &solved.motion, rest) {
        let flow = flow_residual(&structure, &solved.state.force, motion);
        certificate.residuals.insert("path_flow".into(), flow);
        if !small("path_flow", flow) {
            certificate.passed = false;
            certificate.failures.push(format!("the mechanism leaves the flow of the laws by {flow:.2e}"));
        }
    }
    certificate
}

/// Returns a warning if the mesh is coarse compared with the characteristic length of a softening joint.
fn coarse_note(problem: &PathProblem, assembly: &Assembly) -> Option<String> {
    coarse_joints(problem, assembly).first().map(|coarse| {
        format!(
            "joint {}: contact points {:.3} m apart are coarse for its characteristic length E G_I / f_t² = {:.3} m; \
             refine scene.mesh until three points and more stand in that length",
            coarse.joint, coarse.spacing, coarse.length
        )
    })
}

/// Returns the forces at the contact points of joints in the form of certificates, followed by the forces of the fill.
fn contact_forces(assembly: &Assembly, problem: &PathProblem, forces: &[[f64; 2]]) -> Vec<ContactForce> {
    let joints = assembly.joints.len();
    let pairs = problem.contacts.iter().zip(forces).filter(|(c, _)| c.joint < joints);
    pairs.map(|(c, force)| ContactForce { joint: c.joint, point: c.position, force: *force }).collect()
}

/// Returns the forces at joints that are not bonded.
fn unbonded(problem: &PathProblem, field: &[ContactForce]) -> Vec<ContactForce> {
    let pairs = problem.contacts.iter().zip(field);
    pairs.filter(|(contact, _)| !contact.law.is_bonded()).map(|(_, force)| *force).collect()
}

/// Returns the rates of the path's bodies; rates that refute equilibrium are scaled to a greatest jump of 1.
fn scaled_rates(assembly: &Assembly, problem: &PathProblem, solved: &PathAnswer) -> Option<Vec<[f64; 3]>> {
    let mut rates = solved.motion.clone()?;
    if solved.status == Status::NoEquilibrium {
        let largest = largest_jump(&jumps(assembly, &velocities(assembly, problem, &rates, None)));
        rates.iter_mut().flatten().for_each(|v| *v /= largest);
    }
    Some(rates)
}

/// Returns the results of all stages: stages before `last` stand; stages after it change nothing if it stands.
fn stage_results(
    stages: &[Stage],
    last: usize,
    status: Status,
    reached: Option<f64>,
    hinges: Vec<Vec<Hinge>>,
) -> Vec<StageResult> {
    let mut hinges = hinges.into_iter();
    let mut stood = |stage: &Stage| {
        let factor = match stage.target {
            Target::Factor(factor) => Some(factor),
            Target::Collapse => None,
        };
        StageResult {
            name: stage.name.clone(),
            status: Status::Stands,
            factor,
            hinges: hinges.next().unwrap_or_default(),
            stability: StabilityEntry::default(),
        }
    };
    let mut results: Vec<StageResult> = stages[..last].iter().map(&mut stood).collect();
    let end = stood(&stages[last]);
    results.push(StageResult { status, factor: reached, ..end });
    if status == Status::Stands {
        let after = results[last].hinges.clone();
        let idle = stages[last + 1..].iter().map(stood).filter(|idle| idle.factor.is_some());
        results.extend(idle.map(|idle| StageResult { hinges: after.clone(), ..idle }));
    }
    results
}

/// Returns the events of joints; changes in the fill are not events.
fn events(input: &CaseInput, problem: &PathProblem, events: &[PathEvent]) -> Vec<EventEntry> {
    let (stages, joints) = (input.stages, input.assembly.joints.len());
    let entry = |event: &PathEvent| {
        let (load_step, contact) = (&problem.load_steps[event.load_step], &problem.contacts[event.contact]);
        EventEntry {
            stage: stages[load_step.stage].name.clone(),
            factor: event.factor,
            gravity: load_step.gravity,
            joint: contact.joint,
            point: contact.position.into(),
            what: event.what,
        }
    };
    events.iter().filter(|event| problem.contacts[event.contact].joint < joints).map(entry).collect()
}

/// Returns the displacement of every block at its centroid, from the rigid motions of the path's bodies.
pub(super) fn displacements(
    assembly: &Assembly,
    problem: &PathProblem,
    motion: &[[f64; 3]],
    finite: bool,
) -> Vec<[f64; 3]> {
    let of_block = |block: usize| {
        let body = problem.body_of[block];
        // A path without states has no motion.
        let own = motion.get(body).copied().unwrap_or_default();
        let u = carried(own, problem.bodies[body].pole, assembly.inertia(block).centroid, finite);
        [u.x, u.y, own[2]]
    };
    (0..assembly.bodies.len()).map(of_block).collect()
}

/// Returns the velocity of every block at its centroid, from the velocities of the path's bodies about their poles at the
/// positions of `placed`. Velocities of fixed blocks that are rounding errors of the greatest velocity become zero.
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
