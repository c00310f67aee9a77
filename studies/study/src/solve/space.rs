//! Solves a case in space by limit analysis, stage by stage, each with its certificate.

use super::auto::space_solvers;
use super::case_input::CaseInput;
use super::limit::{READ_AS_ASSOCIATED, ask, record_stages, start_is_open};
use super::ours::is_ours;
use super::space_entries::{field_entries, gap_in_space, motion_entries, stored_mechanism};
use super::space_settlement::follow_supports;
use crate::results::{CaseResult, NonAssociatedAnswer, ProofFields, SpaceProof};
use crate::study::SpaceCase;
use voussoir_core::law::FlowRule;
use voussoir_core::limit::{Counters, LimitQuestion, LowerProof, LowerProofKind, Status};
use voussoir_core::model::{Stage, Target};
use voussoir_core::space::{SpaceAnswer, SpaceClaim, SpaceLoads, SpaceProblem, SpaceVerdict, certify_space};

/// Returns the problem of limit analysis of one stage, with contacts divided into parts where their strength is more than a
/// cone.
pub(crate) fn space_problem(space: &SpaceCase, loads: &SpaceLoads) -> Result<SpaceProblem, String> {
    Ok(SpaceProblem::new(&space.assembly, (&space.cones()?, space.parts), [&loads.fixed, &loads.varying]))
}

/// Solves all stages of a case in space.
pub(crate) fn solve_in_space(input: &CaseInput, space: &SpaceCase) -> CaseResult {
    let (mut done, mut counters) = (Vec::new(), Counters::new());
    let loads = space.loads(input.stages);
    for (index, loads) in loads.iter().enumerate() {
        let problem = match space_problem(space, loads) {
            Ok(problem) => problem,
            Err(why) => return CaseResult::stalled(why),
        };
        let mut result = solve_stage(input, space, index, &problem);
        for (name, count) in std::mem::take(&mut result.counters) {
            *counters.entry(name).or_default() += count;
        }
        let settled = result.status == Status::Stands
            && space.settles(index)
            && follow_supports(input, space, (index, &problem), &mut result);
        record_stages(&mut done, input.stages, index, (&result, Vec::new()));
        if result.status != Status::Stands || index + 1 == input.stages.len() {
            // A stage that moves supports has its own note.
            let read = result.flow_read_as.iter().filter(|_| !settled).map(|_| READ_AS_ASSOCIATED.to_string());
            let read: Vec<String> = read.collect();
            result.notes.extend(read);
            return CaseResult { stages: done, counters, ..result };
        }
    }
    CaseResult::stalled("the study has no stage")
}

/// Returns the result of one stage. A load factor counts only if the loads at the start of the stage are carried.
fn solve_stage(input: &CaseInput, space: &SpaceCase, index: usize, problem: &SpaceProblem) -> CaseResult {
    let idle = problem.varying.iter().flatten().all(|component| *component == 0.0);
    let asked = ask(&input.stages[index], idle);
    let mut result = asked_of_solvers(input, space, (index, problem), asked);
    if let LimitQuestion::Collapse { start, .. } = asked
        && matches!(result.status, Status::Collapse | Status::Unbounded | Status::Open)
        && !start_is_proved(space, index, problem, start)
    {
        let mut at_start = asked_of_solvers(input, space, (index, problem), LimitQuestion::Admissible(start));
        if at_start.status != Status::Stands {
            at_start.notes.push(start_is_open(start));
            return at_start;
        }
        for (name, count) in at_start.counters {
            *result.counters.entry(name).or_default() += count;
        }
    }
    result
}

/// Returns true if the state at the start of a stage is proved: no load acts there, or the previous stage stands and ended with
/// the same loads.
fn start_is_proved(space: &SpaceCase, index: usize, problem: &SpaceProblem, start: f64) -> bool {
    let unloaded = problem.fixed.iter().flatten().all(|component| *component == 0.0);
    start == 0.0 && (unloaded || (index > 0 && space.stages[index].gravity.is_none()))
}

/// Returns the first certified answer of the solvers to try, or otherwise the best that is proved.
fn asked_of_solvers(
    input: &CaseInput,
    space: &SpaceCase,
    (index, problem): (usize, &SpaceProblem),
    asked: LimitQuestion,
) -> CaseResult {
    let selected = input.of_stages.get(index).and_then(Option::as_ref).unwrap_or(input.solver);
    let (mut notes, mut best): (Vec<String>, Option<CaseResult>) = (Vec::new(), None);
    for (tag, solver) in space_solvers(selected) {
        let Some(answer) = solver.solve_space(problem, asked) else {
            notes.push(format!("{tag}: the solver knows plane scenes only"));
            continue;
        };
        let result = certified(input, space, (&input.stages[index], problem), asked, (tag, answer));
        // Two sets of points leave a distance between the bounds, whatever the solver.
        let enclosed = !problem.is_exact() && matches!(result.bounds, Some([Some(_), Some(_)]));
        if result.certificate.passed || enclosed {
            return result;
        }
        notes.extend(result.certificate.failures.iter().map(|failure| format!("{tag}: {failure}")));
        notes.extend(result.notes.iter().cloned());
        if best.as_ref().is_none_or(|best| best.status == Status::Stalled) {
            best = Some(result);
        }
    }
    let best = best.unwrap_or_else(|| CaseResult::stalled("no solver supports scenes in space"));
    CaseResult { notes, ..best }
}

/// Returns the certified result of one stage.
fn certified(
    input: &CaseInput,
    space: &SpaceCase,
    (stage, problem): (&Stage, &SpaceProblem),
    asked: LimitQuestion,
    (tag, answer): (&str, SpaceAnswer),
) -> CaseResult {
    let (start, target) = match asked {
        LimitQuestion::Admissible(factor) => (factor, factor),
        LimitQuestion::Collapse { start, max } => (start, max),
    };
    let claim = SpaceClaim {
        hint: answer.status,
        target,
        start,
        factor: answer.factor,
        field_factor: answer.field_factor,
        field: answer.field.as_ref(),
        motion: answer.motion.as_deref(),
        ray: answer.ray.as_ref(),
        non_associated: answer.non_associated.as_ref(),
        search_is_trusted: is_ours(tag),
    };
    let SpaceVerdict { certificate, status, bounds, greatest } =
        certify_space(problem, &claim, gap_in_space(input.settings.tolerance));
    let shows = |statuses: &[Status]| statuses.contains(&status);
    let field = answer.field.filter(|_| shows(&[Status::Stands, Status::Collapse, Status::Unbounded, Status::Open]));
    let motion = answer.motion.filter(|_| shows(&[Status::Collapse, Status::NoEquilibrium, Status::Open]));
    let motion = motion.map(|motion| motion_entries(space, problem, &motion));
    let ray = answer.ray.filter(|_| shows(&[Status::Unbounded]));
    // A field at the end of the stage proves it for associated flow only. For the laws' own flow the search decides, and only ours is believed.
    let searched = answer.status == Status::Stands && shows(&[Status::Stands]) && is_ours(tag);
    let own = answer.non_associated.filter(|_| searched || shows(&[Status::Collapse, Status::Open]));
    let read = status != Status::Stalled && space.non_associated() && own.is_none();
    let flow = if own.is_some() { FlowRule::NonAssociated } else { FlowRule::Associated };
    // No check proves that a mechanism is unique.
    let unique = answer.unique.filter(|unique| !unique || is_ours(tag));
    let mechanism = motion.as_ref().and_then(|motion| stored_mechanism(space, problem, motion, (unique, flow)));
    let mut notes = answer.notes;
    if answer.self_stress && is_ours(tag) {
        notes.push(SELF_STRESS.to_string());
    }
    if status == Status::Collapse && answer.unique == Some(false) && is_ours(tag) {
        notes.push("the mechanism is not the only one with this load factor".into());
    }
    if status == Status::Stands && stage.target == Target::Collapse {
        notes.push(format!("no collapse up to factor_max = {}", stage.factor_max));
    }
    CaseResult {
        status,
        solver: tag.to_string(),
        load_factor: match status {
            Status::Collapse => answer.factor.or(bounds[0]),
            Status::Open => bounds[0],
            _ => None,
        },
        bounds: (bounds != [None; 2]).then_some(bounds),
        greatest,
        mechanism,
        proof: ProofFields {
            field_factor: field.is_some().then_some(answer.field_factor),
            space: Some(Box::new(SpaceProof {
                field: field.map(|field| field_entries(problem, &field)),
                motion,
                associated_motion: own
                    .as_ref()
                    .and_then(|own| own.associated_motion.as_ref())
                    .map(|motion| motion_entries(space, problem, motion)),
                ray: ray.map(|ray| field_entries(problem, &ray)),
            })),
            ..ProofFields::default()
        },
        flow_read_as: read.then(|| "associated".into()),
        non_associated: NonAssociatedAnswer {
            lower_proof: own.as_ref().and_then(|own| own.searched).filter(|_| is_ours(tag)).map(|lower| {
                LowerProof::by(if lower > start { LowerProofKind::Search } else { LowerProofKind::Start })
            }),
            associated_load_factor: own.and_then(|own| own.associated_factor),
            ..NonAssociatedAnswer::default()
        },
        certificate,
        counters: answer.counters,
        notes,
        ..CaseResult::empty()
    }
}

/// The note of blocks that interlock.
const SELF_STRESS: &str = "self-stress: forces strictly inside all friction cones are in balance without any load, because blocks \
     interlock. Every load is then in equilibrium with some forces, so equilibrium alone proves nothing about this scene";
