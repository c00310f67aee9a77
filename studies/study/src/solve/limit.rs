//! Solves a case by limit analysis, stage by stage, each with its certificate.

use super::auto::limit_solvers;
use super::case_input::CaseInput;
use super::limit_result::certified;
use super::safe_theorem::static_proof;
use super::settlement::{Settling, follow_supports, settles};
use super::solver_outputs::solver_outputs;
use crate::results::stage_start::search_start;
use crate::results::{CaseResult, StageResult};
use crate::study::SelectedSolver;
use voussoir_core::certificate::Hinge;
use voussoir_core::limit::{Counters, LimitAnswer, LimitProblem, LimitQuestion, Status};
use voussoir_core::model::{Assembly, Stage, StageLoads, Target, stage_loads};
use voussoir_core::plugin::PluginKind;

/// Returns the question of a stage: does it stand at its start, and up to which factor does it stand?
/// `idle`: its loads do not grow.
pub(super) fn ask(stage: &Stage, idle: bool) -> LimitQuestion {
    match stage.target {
        Target::Factor(factor) if idle || factor == 0.0 => LimitQuestion::Admissible(0.0),
        Target::Factor(factor) if factor < 0.0 => LimitQuestion::Admissible(factor),
        Target::Factor(factor) => LimitQuestion::Collapse { start: 0.0, max: factor },
        Target::Collapse => LimitQuestion::Collapse { start: search_start(stage), max: stage.factor_max },
    }
}

/// Returns true if the loads of a stage do not grow.
fn is_idle(problem: &LimitProblem) -> bool {
    problem.magnitude(&problem.varying) == 0.0
}

/// Returns true if the check of the next stage's start also answers this stage.
fn covered(stages: &[Stage], loads: &[StageLoads], index: usize) -> bool {
    let Some(next) = stages.get(index + 1) else {
        return false;
    };
    let reached = match stages[index].target {
        Target::Factor(factor) => factor,
        Target::Collapse => return false,
    };
    let idle = reached == 0.0 || loads[index].varying.iter().all(|w| *w == [0.0; 3]);
    let moves = !stages[index].settlements.is_empty();
    idle && !moves && next.target == Target::Collapse && next.gravity.is_none() && search_start(next) == 0.0
}

/// Solves a case stage by stage, until a stage does not stand.
pub(crate) fn solve_by_limit_analysis(input: &CaseInput) -> CaseResult {
    let CaseInput { assembly, stages, .. } = *input;
    let loads = stage_loads(assembly, stages);
    let mut done: Vec<StageResult> = Vec::new();
    let mut counters = Counters::new();
    for index in 0..stages.len() {
        if covered(stages, &loads, index) {
            continue;
        }
        let (mut result, hinges) = match LimitProblem::new(assembly, &loads[index]) {
            Ok(problem) => {
                let mut result = solve_stage(input, index, &problem, &loads);
                if index + 1 == stages.len() {
                    take_inner_field(input, index, (&problem, &loads[index]), &mut result);
                }
                let hinges = settled_hinges(input, index, (&problem, &loads[index]), &mut result);
                // The notes come last, because settlements may change how the flow was read.
                result.notes.extend(readings(assembly, &problem, &result));
                (result, hinges)
            }
            Err(why) => (CaseResult::stalled(why), Vec::new()),
        };
        for (name, count) in std::mem::take(&mut result.counters) {
            *counters.entry(name).or_default() += count;
        }
        record_stages(&mut done, stages, index, (&result, hinges));
        if result.status != Status::Stands || index + 1 == stages.len() {
            result.stages = done;
            result.counters = counters;
            result.proved_by = static_proof(assembly, &result);
            return result;
        }
    }
    CaseResult::stalled("the study has no stage")
}

/// Adds the result of stage `index`, and the earlier stages that the check of its start also answers.
pub(super) fn record_stages(
    done: &mut Vec<StageResult>,
    stages: &[Stage],
    index: usize,
    (result, settled): (&CaseResult, Vec<Hinge>),
) {
    let stage = |index: usize, status, factor, hinges| {
        let name = stages[index].name.clone();
        StageResult { name, status, factor, hinges, stability: Default::default() }
    };
    // Supports that cannot move as requested prove nothing against the loads.
    let carried = result.supports_cannot_move() || !matches!(result.status, Status::NoEquilibrium | Status::Stalled);
    let status = if carried { Status::Stands } else { result.status };
    for (earlier, covered) in stages.iter().enumerate().take(index).skip(done.len()) {
        let Target::Factor(factor) = covered.target else { continue };
        done.push(stage(earlier, status, carried.then_some(factor), Vec::new()));
    }
    let reached = match (result.status, stages[index].target) {
        (Status::Collapse | Status::Open, _) => result.load_factor,
        (Status::Stands, Target::Factor(factor)) => Some(factor),
        (Status::Stands, Target::Collapse) => result.proof.field_factor,
        _ => None,
    };
    let hinges = result.mechanism.as_ref().map_or(settled, |m| m.hinges.clone());
    done.push(stage(index, result.status, reached, hinges));
}

/// Adds the displacements due to settlements at the end of a stage that stands to its result. Returns the hinges.
fn settled_hinges(
    input: &CaseInput,
    index: usize,
    (problem, loads): (&LimitProblem, &StageLoads),
    result: &mut CaseResult,
) -> Vec<Hinge> {
    let idle = is_idle(problem);
    let stands = result.status == Status::Stands || (result.status == Status::Unbounded && idle);
    if !stands || !settles(input.stages, index) {
        return Vec::new();
    }
    let selected = input.of_stages.get(index).and_then(Option::as_ref).unwrap_or(input.solver);
    let factor = result.proof.field_factor.unwrap_or(0.0);
    match limit_solvers(selected, problem).find(|(_, solver)| solver.refuses(problem).is_none()) {
        Some((_, solver)) => follow_supports(input, index, Settling { solver, problem, loads, factor }, result),
        None => Vec::new(),
    }
}

/// Returns the result of an answer with its certificate, and true if it proves the start; a stalled result if the answer is
/// malformed.
fn read(
    input: &CaseInput,
    stage: &Stage,
    (problem, loads): (&LimitProblem, &StageLoads),
    asked: LimitQuestion,
    (tag, solved): (&str, LimitAnswer),
) -> (CaseResult, bool) {
    let (outputs, notes) = solver_outputs(PluginKind::LimitSolver, tag, &solved.outputs);
    match solved.check_form(problem) {
        Ok(()) => {
            let (mut result, start_is_carried) = certified(input, stage, (problem, loads), asked, (tag, solved));
            result.notes.extend(notes);
            (CaseResult { outputs, ..result }, start_is_carried)
        }
        Err(why) => (CaseResult::stalled(why), false),
    }
}

/// Returns the first certified answer of the solvers to try, or otherwise the best result that is proved.
fn solve_stage(input: &CaseInput, index: usize, problem: &LimitProblem, all_loads: &[StageLoads]) -> CaseResult {
    let loads = &all_loads[index];
    let stage = &input.stages[index];
    let asked = ask(stage, is_idle(problem));
    let (result, start_is_carried) = asked_of_solvers(input, index, (problem, loads), asked);
    if let LimitQuestion::Collapse { start, .. } = asked
        && matches!(result.status, Status::Collapse | Status::Unbounded | Status::Open)
        && !(start_is_carried || start_is_proved(input.stages, index, all_loads, start))
    {
        let (mut at_start, _) = asked_of_solvers(input, index, (problem, loads), LimitQuestion::Admissible(start));
        if at_start.status != Status::Stands {
            at_start.notes.push(start_is_open(start));
            return at_start;
        }
    }
    result
}

/// Returns the note of a load factor whose stage has an unproved start.
pub(super) fn start_is_open(start: f64) -> String {
    format!(
        "a load factor was found, but nothing proves that the loads at the start of the stage, at the factor {start}, are \
         carried"
    )
}

/// Replaces the field of the last stage, if it stands, by the field that is farthest from all bounds. The search for collapse
/// ends at a corner of the admissible fields, at which some joints are compressed at an edge only.
fn take_inner_field(
    input: &CaseInput,
    index: usize,
    (problem, loads): (&LimitProblem, &StageLoads),
    result: &mut CaseResult,
) {
    let searched = matches!(ask(&input.stages[index], is_idle(problem)), LimitQuestion::Collapse { .. });
    let Some(factor) = result.proof.field_factor.filter(|_| result.status == Status::Stands && searched) else {
        return;
    };
    let (inner, _) = asked_of_solvers(input, index, (problem, loads), LimitQuestion::Admissible(factor));
    for (name, count) in &inner.counters {
        *result.counters.entry(name.clone()).or_default() += count;
    }
    if inner.status == Status::Stands && inner.certificate.passed && inner.solver == result.solver {
        (result.proof, result.certificate) = (inner.proof, inner.certificate);
    }
}

/// Returns true if the state at the start of a stage is proved: no load acts there, or the previous stage was solved and ended
/// with the same loads.
fn start_is_proved(stages: &[Stage], index: usize, loads: &[StageLoads], start: f64) -> bool {
    let unloaded = start == 0.0 && loads[index].fixed.iter().all(|wrench| *wrench == [0.0; 3]);
    let continues = index > 0 && start == 0.0 && stages[index].gravity.is_none() && !covered(stages, loads, index - 1);
    unloaded || continues
}

/// Asks the solvers to try, one after the other. Returns the result, and true if its answer proves the start.
pub(crate) fn asked_of_solvers(
    input: &CaseInput,
    index: usize,
    (problem, loads): (&LimitProblem, &StageLoads),
    asked: LimitQuestion,
) -> (CaseResult, bool) {
    let stage = &input.stages[index];
    let selected = input.of_stages.get(index).and_then(Option::as_ref).unwrap_or(input.solver);
    let mut notes = Vec::new();
    let mut best: Option<(CaseResult, bool)> = None;
    // Solvers that `auto` chooses have already been checked.
    let named = matches!(selected, SelectedSolver::Limit(..));
    for (tag, solver) in limit_solvers(selected, problem) {
        if named && let Some(why) = solver.refuses(problem) {
            notes.push(format!("{tag}: {why}"));
            continue;
        }
        let solve =
            |posed: &LimitProblem| read(input, stage, (problem, loads), asked, (tag, solver.solve(posed, asked)));
        let (mut result, mut start_is_carried) = solve(problem);
        let bracketed = result.bounds.is_some() && result.non_associated.lower_proof.is_some();
        if !result.certificate.passed && !bracketed {
            // Solvers fail at numbers of very different sizes, so they get bounded ones; the certificate uses the laws unchanged.
            let within = problem.within_reach();
            let bounded = within.as_ref().unwrap_or(problem).with_bounded_shear();
            let mut easier = [within, bounded].into_iter().flatten();
            if let Some(again) =
                easier.find_map(|easier| Some(solve(&easier)).filter(|again| again.0.certificate.passed))
            {
                (result, start_is_carried) = again;
            }
        }
        result.solver = tag.to_string();
        if result.certificate.passed {
            return (result, start_is_carried);
        }
        if result.status == Status::Stalled {
            notes.push(format!("{tag}: {}", result.certificate.failures.join("; ")));
        }
        notes.append(&mut result.notes);
        if best.as_ref().is_none_or(|best| best.0.status == Status::Stalled && result.status == Status::Open) {
            best = Some((result, start_is_carried));
        }
    }
    let (best, start_is_carried) =
        best.unwrap_or_else(|| (CaseResult::stalled("no solver supports this scene"), false));
    (CaseResult { notes, ..best }, start_is_carried)
}

/// The note of a law whose flow is not associated but is read so.
pub(super) const READ_AS_ASSOCIATED: &str = "a joint law whose slip is non-associated is read with associated flow (slip opens \
     the joint by its friction angle): every load factor is an upper bound";

/// Returns notes on how limit analysis simplifies a scene with further properties.
fn readings(assembly: &Assembly, problem: &LimitProblem, result: &CaseResult) -> Vec<String> {
    let mut notes = Vec::new();
    if result.flow_read_as.is_some() {
        notes.push(READ_AS_ASSOCIATED.into());
    }
    let mut free = (0..assembly.bodies.len()).filter(|body| problem.group_of[*body].is_some());
    if free.clone().any(|body| !assembly.is_rigid(body)) {
        notes.push(
            "blocks are read as rigid: with small displacements the limit load does not depend on their elasticity"
                .into(),
        );
    }
    if free.any(|body| assembly.yields(body)) {
        notes.push(
            "limit analysis treats blocks as rigid and ignores their yielding: it includes crushing only in joints with a \
             compressive_strength; newton_path includes blocks that yield"
                .into(),
        );
    }
    notes
}
