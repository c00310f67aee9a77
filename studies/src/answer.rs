//! Answering one case: its stages in turn, each by a limit solver, each with its certificate.

use crate::results::{CaseResult, FieldEntry, MotionEntry, StageResult};
use std::sync::Arc;
use voussoir_core::certificate::{
    CentroidVelocity, Certificate, Claim, ContactForce, NonAssociatedClaim, certify, jumps, largest_jump, mechanism,
};
use voussoir_core::law::FlowRule;
use voussoir_core::limit::{
    Counters, JointForce, LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, Status, Velocity,
};
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::model::{Assembly, Stage, StageLoads, Target, stage_loads};
use voussoir_core::path::{PathObserver, PathSettings, PathSolver};

/// A choice of solver for the problems of a case.
#[derive(Debug, Clone)]
pub enum Choice {
    /// The cheapest that answers.
    Auto,
    /// This one, with its tag.
    Named(String, Arc<dyn LimitSolver>),
    /// This path solver, with its tag.
    Path(String, Arc<dyn PathSolver>),
}

/// One case, ready to be answered.
#[derive(Debug, Clone, Copy)]
pub struct Question<'a> {
    /// Blocks and joints.
    pub assembly: &'a Assembly,
    /// Stages in order.
    pub stages: &'a [Stage],
    /// Which solver.
    pub solver: &'a Choice,
    /// Greatest relative gap between the bounds.
    pub tolerance: f64,
    /// What a path solver is told.
    pub settings: &'a PathSettings,
}

/// Where a stage's search for collapse starts.
pub fn start_of(stage: &Stage) -> f64 {
    0.0f64.clamp(stage.factor_min, stage.factor_max)
}

/// What is asked of a stage: can it stand at its start, and how far does it go from there?
fn ask(stage: &Stage, problem: &LimitProblem) -> LimitQuestion {
    let idle = problem.magnitude(&problem.varying) == 0.0;
    match stage.target {
        Target::Factor(factor) if idle || factor == 0.0 => LimitQuestion::Admissible(0.0),
        Target::Factor(factor) if factor < 0.0 => LimitQuestion::Admissible(factor),
        Target::Factor(factor) => LimitQuestion::Collapse { start: 0.0, max: factor },
        Target::Collapse => LimitQuestion::Collapse { start: start_of(stage), max: stage.factor_max },
    }
}

/// Whether the next stage's own check of its start answers this stage too.
fn covered(stages: &[Stage], loads: &[StageLoads], index: usize) -> bool {
    let Some(next) = stages.get(index + 1) else {
        return false;
    };
    let reached = match stages[index].target {
        Target::Factor(factor) => factor,
        Target::Collapse => return false,
    };
    let idle = reached == 0.0 || loads[index].varying.iter().all(|w| *w == [0.0; 3]);
    idle && next.target == Target::Collapse && next.gravity.is_none() && start_of(next) == 0.0
}

/// The path solver that answers, if it is not for limit analysis: the one named, or for `auto` on
/// deformable scenes the exact one where it can.
pub fn path_solver(question: &Question) -> Option<(String, Arc<dyn PathSolver>)> {
    use voussoir_solvers::path::continuation::exact_events::ExactEvents;
    use voussoir_solvers::path::{event::EventPath, newton::NewtonPath};
    match question.solver {
        Choice::Named(..) => None,
        Choice::Path(tag, solver) => Some((tag.clone(), solver.clone())),
        Choice::Auto => {
            let assembly = question.assembly;
            let settles = question.stages.iter().any(|stage| !stage.settlements.is_empty());
            if !assembly.deforms() && !question.settings.finite && !settles {
                return None;
            }
            let facets =
                assembly.joints.iter().all(|j| assembly.law(j).is_none_or(|l| l.formulation().facets().is_some()));
            let exact = question.settings.continuation.as_ref().is_none_or(|c| ExactEvents::is(&**c));
            let linear = (0..assembly.bodies.len()).all(|b| assembly.bodies[b].fixed || !assembly.yields(b));
            if !question.settings.finite && facets && exact && linear {
                Some(("event_path".into(), Arc::new(EventPath {})))
            } else {
                Some(("newton_path".into(), Arc::new(NewtonPath {})))
            }
        }
    }
}

/// Answers a case; an observer sees the states of a path. `id`, `variant`, `parameters` and `seconds`
/// are left for the caller to fill.
pub fn answer(question: &Question, observer: &mut dyn PathObserver) -> CaseResult {
    let Question { assembly, stages, .. } = *question;
    if let Some((tag, solver)) = path_solver(question) {
        return crate::path::answer(question, &tag, &*solver, observer);
    }
    let loads = stage_loads(assembly, stages);
    let mut done: Vec<StageResult> = Vec::new();
    let mut counters = Counters::new();
    for index in 0..stages.len() {
        if covered(stages, &loads, index) {
            continue;
        }
        let mut result = match LimitProblem::new(assembly, &loads[index]) {
            Ok(problem) => solve_stage(question, &stages[index], &problem, &loads[index]),
            Err(why) => stalled(why),
        };
        for (name, count) in std::mem::take(&mut result.counters) {
            *counters.entry(name).or_default() += count;
        }
        let hinges = result.mechanism.iter().flat_map(|m| &m.hinges).map(|hinge| hinge.joint).collect();
        let stage = |index: usize, status, factor, hinges| StageResult {
            name: stages[index].name.clone(),
            status,
            factor,
            hinges,
        };
        // Stages answered by this one's check of its start.
        let carried = !matches!(result.status, Status::NoEquilibrium | Status::Stalled);
        let status = if carried { Status::Stands } else { result.status };
        for (earlier, covered) in stages.iter().enumerate().take(index).skip(done.len()) {
            let Target::Factor(factor) = covered.target else { continue };
            done.push(stage(earlier, status, carried.then_some(factor), Vec::new()));
        }
        let reached = match (result.status, stages[index].target) {
            (Status::Collapse, _) => result.load_factor,
            (Status::Stands, Target::Factor(factor)) => Some(factor),
            (Status::Stands, Target::Collapse) => result.field_factor,
            _ => None,
        };
        let carries_on = result.status == Status::Stands && index + 1 < stages.len();
        done.push(stage(index, result.status, reached, hinges));
        if !carries_on {
            result.stages = done;
            result.counters = counters;
            return result;
        }
    }
    stalled("the study has no stage".into())
}

pub(crate) fn stalled(why: String) -> CaseResult {
    CaseResult {
        id: 0,
        variant: None,
        scene: None,
        parameters: serde_json::Map::new(),
        status: Status::Stalled,
        load_factor: None,
        bounds: None,
        associated_load_factor: None,
        associated_motion: None,
        lower_proof: None,
        feasible_interval: None,
        flow_read_as: None,
        solver: String::new(),
        notes: vec![why],
        mechanism: None,
        field_factor: None,
        field: None,
        motion: None,
        ray: None,
        thrust_line: None,
        certificate: Certificate { passed: false, residuals: Default::default(), failures: vec!["not proven".into()] },
        counters: Counters::new(),
        seconds: 0.0,
        stages: Vec::new(),
        events: Vec::new(),
        curve: None,
        displacements: None,
        joint_states: None,
        yielded: Vec::new(),
    }
}

/// The solvers to try, in order.
fn candidates(choice: &Choice, problem: &LimitProblem) -> Vec<(String, Arc<dyn LimitSolver>)> {
    match choice {
        Choice::Named(tag, solver) => vec![(tag.clone(), solver.clone())],
        Choice::Auto | Choice::Path(..) => {
            use voussoir_solvers::limit::{chain::LimitChain, conic::LimitConic, least::LimitLeast};
            let chain: Arc<dyn LimitSolver> = Arc::new(LimitChain {});
            let conic: Arc<dyn LimitSolver> = Arc::new(LimitConic {});
            let general = ("limit_conic".to_string(), conic);
            let mut all = vec![general];
            if chain.refuses(problem).is_none() {
                all.insert(0, ("limit_chain".to_string(), chain));
            }
            if problem.non_associated {
                all.insert(0, ("limit_least".to_string(), Arc::new(LimitLeast::default())));
            }
            all
        }
    }
}

/// Tag of the solver that is tried first.
pub fn first_solver(choice: &Choice, problem: &LimitProblem) -> String {
    candidates(choice, problem).swap_remove(0).0
}

fn solve_stage(question: &Question, stage: &Stage, problem: &LimitProblem, loads: &StageLoads) -> CaseResult {
    let mut notes = Vec::new();
    let mut best: Option<CaseResult> = None;
    for (tag, solver) in candidates(question.solver, problem) {
        if let Some(why) = solver.refuses(problem) {
            notes.push(format!("{tag}: {why}"));
            continue;
        }
        let asked = ask(stage, problem);
        let solved = solver.solve(problem, asked);
        let mut result = proven(question, stage, problem, loads, asked, solved);
        result.solver = tag.clone();
        if result.certificate.passed {
            best = Some(result);
            break;
        }
        notes.push(format!("{tag}: {}", result.certificate.failures.join("; ")));
        notes.append(&mut result.notes);
        best.get_or_insert(result);
    }
    let mut result = best.unwrap_or_else(|| stalled("no solver takes this scene".into()));
    if !result.certificate.passed {
        // An answer without proof is no answer.
        result.status = Status::Stalled;
        result.load_factor = None;
        result.bounds = None;
        result.notes = notes;
    }
    if result.flow_read_as.is_some() {
        result.notes.push(
            "a joint law whose slip is non-associated is read with associated flow (slip opens the joint by its \
             friction angle): every load factor is an upper bound"
                .into(),
        );
    }
    if (0..question.assembly.bodies.len()).any(|b| problem.group_of[b].is_some() && !question.assembly.is_rigid(b)) {
        result.notes.push(
            "blocks are read as rigid: with small displacements the limit load does not depend on their elasticity"
                .into(),
        );
    }
    if (0..question.assembly.bodies.len()).any(|b| problem.group_of[b].is_some() && question.assembly.yields(b)) {
        result.notes.push(
            "the material of blocks yields, which limit analysis of rigid blocks does not see: crushing counts here only \
             where a joint has a compressive_strength; newton_path follows blocks that yield"
                .into(),
        );
    }
    result
}

/// A solver's answer in the form of a result, with its certificate.
fn proven(
    question: &Question,
    stage: &Stage,
    problem: &LimitProblem,
    loads: &StageLoads,
    asked: LimitQuestion,
    solved: LimitAnswer,
) -> CaseResult {
    let assembly = question.assembly;
    let field = solved.field.as_ref().map(|forces| contact_forces(problem, forces));
    let ray = solved.ray.as_ref().map(|forces| contact_forces(problem, forces));
    let mut motion = solved.motion.as_ref().map(|motion| body_velocities(assembly, problem, motion));
    if let (Status::NoEquilibrium, None, Some(motion)) = (solved.status, solved.feasible_interval, &mut motion) {
        let largest = largest_jump(&jumps(assembly, motion));
        motion.iter_mut().flatten().for_each(|v| *v /= largest);
    }
    let start = match asked {
        LimitQuestion::Admissible(factor) => factor,
        LimitQuestion::Collapse { start, .. } => start,
    };
    let own = solved.non_associated.as_ref();
    let associated_motion =
        own.and_then(|own| own.associated_motion.as_ref()).map(|motion| body_velocities(assembly, problem, motion));
    let reading = if own.is_some() { FlowRule::NonAssociated } else { FlowRule::Associated };
    let claim = Claim {
        status: solved.status,
        factor: solved.factor,
        field_factor: solved.field_factor,
        start,
        field: field.as_deref(),
        motion: motion.as_deref(),
        ray: ray.as_deref(),
        feasible_interval: solved.feasible_interval,
        non_associated: own.map(|own| NonAssociatedClaim {
            proved_lower: own.proved_lower,
            lower_proof: own.lower_proof.as_ref(),
            associated_factor: own.associated_factor,
            associated_motion: associated_motion.as_deref(),
        }),
    };
    let (certificate, bounds) = certify(assembly, loads, &claim, question.tolerance);
    let finite = |x: f64| x.is_finite().then_some(x);
    let mut notes = solved.notes;
    if solved.status == Status::Stands && stage.target == Target::Collapse {
        notes.push(format!("no collapse up to factor_max = {}", stage.factor_max));
    }
    CaseResult {
        status: solved.status,
        load_factor: solved.factor,
        bounds,
        associated_load_factor: own.and_then(|own| own.associated_factor),
        flow_read_as: (problem.non_associated && own.is_none()).then(|| "associated".into()),
        feasible_interval: solved.feasible_interval.map(|ends| ends.map(finite)),
        mechanism: motion.as_ref().and_then(|motion| mechanism(assembly, motion, solved.unique, reading)),
        field_factor: field.is_some().then_some(solved.field_factor),
        thrust_line: field.as_ref().and_then(|field| thrust_line(assembly, field)),
        field: field.as_deref().map(field_entries),
        ray: ray.as_deref().map(field_entries),
        motion: motion.map(|motion| motion_entries(assembly, motion)),
        associated_motion: associated_motion.map(|motion| motion_entries(assembly, motion)),
        lower_proof: solved.non_associated.and_then(|own| own.lower_proof),
        certificate,
        counters: solved.counters,
        ..stalled_without(notes)
    }
}

fn stalled_without(notes: Vec<String>) -> CaseResult {
    CaseResult { notes, ..stalled(String::new()) }
}

fn motion_entries(assembly: &Assembly, motion: Vec<CentroidVelocity>) -> Vec<MotionEntry> {
    let name = |body: usize| assembly.bodies[body].name.clone();
    motion.into_iter().enumerate().map(|(body, velocity)| MotionEntry { body: name(body), velocity }).collect()
}

pub(crate) fn field_entries(forces: &[ContactForce]) -> Vec<FieldEntry> {
    forces.iter().map(|c| FieldEntry { joint: c.joint, point: c.point.into(), force: c.force }).collect()
}

/// Forces at the two ends of every joint; shear goes with the normal forces, so that each end's
/// force lies in the cone of dry friction where the sum does.
fn contact_forces(problem: &LimitProblem, forces: &[JointForce]) -> Vec<ContactForce> {
    let mut contacts = Vec::with_capacity(2 * forces.len());
    for (joint, force) in problem.joints.iter().zip(forces) {
        let sum = force.normal[0] + force.normal[1];
        let share = |end: usize| {
            if force.normal[0] >= 0.0 && force.normal[1] >= 0.0 && sum > 0.0 { force.normal[end] / sum } else { 0.5 }
        };
        let shears = [force.shear * share(0), force.shear - force.shear * share(0)];
        for (end, shear) in shears.into_iter().enumerate() {
            let force = [force.normal[end], shear];
            contacts.push(ContactForce { joint: joint.joint, point: joint.ends[end], force });
        }
    }
    contacts
}

fn body_velocities(assembly: &Assembly, problem: &LimitProblem, motion: &[Velocity]) -> Vec<CentroidVelocity> {
    let velocity = |body: usize| match problem.group_of[body] {
        None => [0.0; 3],
        Some(group) => {
            let [x, y, omega] = motion[group];
            let v = Vec2::new(x, y) + turned(assembly.inertia(body).centroid - problem.pole) * omega;
            [v.x, v.y, omega]
        }
    };
    (0..assembly.bodies.len()).map(velocity).collect()
}

/// Where the resultant crosses each joint of an arch.
pub fn thrust_line(assembly: &Assembly, field: &[ContactForce]) -> Option<Vec<Option<[f64; 2]>>> {
    assembly.arch.as_ref()?;
    let largest = field.iter().map(|c| c.force[0].abs()).fold(0.0, f64::max);
    let mut sums = vec![(0.0, Vec2::zeros()); assembly.joints.len()];
    for contact in field {
        sums[contact.joint].0 += contact.force[0];
        sums[contact.joint].1 += contact.point * contact.force[0];
    }
    Some(sums.into_iter().map(|(n, moment)| (n > 1e-12 * largest).then(|| (moment / n).into())).collect())
}
