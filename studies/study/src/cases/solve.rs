//! Solves cases: one, or several in parallel.

use crate::cases::{Observer, PathProgress};
use crate::checks::case::verify_case;
use crate::checks::outputs::law_outputs;
use crate::results::carried::CarriedLoad;
use crate::results::stored_path::StoredPath;
use crate::results::{CaseLabel, CaseResult, OutputEntry};
use crate::side_by_side::{in_order, side_by_side};
use crate::solve::CaseInput;
use crate::solve::accuracy::{estimate, words};
use crate::solve::auto::path_solvers;
use crate::solve::carried::carried_load;
use crate::solve::load_entries::load_entries;
use crate::solve::sensitivity::sensitivities;
use crate::solve::space::solve_in_space;
use crate::solve::statics::{falls_by_statics, stands_by_statics, stands_without_a_path};
use crate::solve::{limit, path};
use crate::study::{Case, Study};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::time::Instant;
use voussoir_core::elastic::SharedFlexibilities;
use voussoir_core::limit::{Greatest, Status};
use voussoir_core::path::{PathObserver, PathProblem, PathState, Unobserved};
use voussoir_core::plugin::{PluginKind, card};

/// Solves a case; an observer gets the states of a path. The caller sets the label and `seconds`.
pub fn solve_input(input: &CaseInput, observer: &mut dyn PathObserver) -> CaseResult {
    if let Some(space) = input.space {
        return solve_in_space(input, space);
    }
    let solvers = path_solvers(input);
    if solvers.is_empty() {
        return limit::solve_by_limit_analysis(input);
    }
    if let Some(result) = stands_by_statics(input).or_else(|| falls_by_statics(input)) {
        return result;
    }
    let result = path::solve_by_path(input, &solvers, observer);
    stands_without_a_path(input, &result).unwrap_or(result)
}

/// Returns the label that identifies a case.
pub fn label_of(case: &Case) -> CaseLabel {
    CaseLabel {
        id: case.id,
        case_hash: case.hash(),
        variant: case.variant.clone(),
        scene: case.scene.clone(),
        parameters: case.parameters.clone(),
    }
}

/// Solves one case.
pub fn solve_case(case: &Case) -> CaseResult {
    solve_observed(case, &mut Unobserved)
}

/// Returns the result, or a result with the message of a panic in a plug-in or a solver. A panic ends its case, not the run.
fn caught(solve: impl FnOnce() -> CaseResult) -> CaseResult {
    catch_unwind(AssertUnwindSafe(solve)).unwrap_or_else(|panic| {
        let said = panic.downcast_ref::<String>().map(String::as_str).or(panic.downcast_ref::<&str>().copied());
        CaseResult::stalled(format!("a panic ended the case: {}", said.unwrap_or("it said nothing")))
    })
}

fn solve_observed(case: &Case, observer: &mut dyn PathObserver) -> CaseResult {
    let started = Instant::now();
    let _stored = SharedFlexibilities::new();
    let mut result = caught(|| solve_input(&CaseInput::of(case), observer));
    add_label(case, &mut result);
    add_carried(case, &mut result);
    add_outputs(case, &mut result);
    if result.status != Status::Stalled && card(PluginKind::PathSolver, &result.solver).is_some() {
        let checked = catch_unwind(AssertUnwindSafe(|| verify_case(case, &result)));
        let wrong = checked.unwrap_or_else(|_| vec!["a panic ended its check".into()]);
        withdraw(&mut result, wrong);
    }
    result.notes.extend(case.notes.iter().cloned());
    if !case.output_sensitivities.is_empty() {
        let found = catch_unwind(AssertUnwindSafe(|| sensitivities(case, &result)));
        match found.unwrap_or_else(|_| Err("a panic ended their search".into())) {
            Ok(found) => result.sensitivities = found,
            Err(why) => result.notes.push(format!("no sensitivities: {why}")),
        }
    }
    if case.output_accuracy {
        let found =
            catch_unwind(AssertUnwindSafe(|| estimate(case, &result, &|input| solve_input(input, &mut Unobserved))));
        match found.unwrap_or_else(|_| Err("a panic ended it".into())) {
            Ok(found) => {
                result.notes.push(words(&found));
                result.load_factor_error = Some(found);
            }
            Err(why) => result.notes.push(format!("no estimate of the load factor's error: {why}")),
        }
    }
    // Last, because the steps above need these parts.
    leave_out(case, &mut result);
    result.seconds = started.elapsed().as_secs_f64();
    result
}

/// Adds the label of a case, its loads and its partial factors.
fn add_label(case: &Case, result: &mut CaseResult) {
    result.label = label_of(case);
    result.loads = load_entries(case);
    result.partial_factors = case.resolved.get("factors").cloned();
}

/// Adds the description of a load that is carried.
fn add_carried(case: &Case, result: &mut CaseResult) {
    match catch_unwind(AssertUnwindSafe(|| carried_load(case, result))) {
        Ok(carried) => result.carried = carried,
        Err(_) => result.notes.push("a panic ended the search for the reserve and the zone of thrust".into()),
    }
}

/// Adds the outputs of laws at the end of a path.
fn add_outputs(case: &Case, result: &mut CaseResult) {
    if result.status == Status::Stalled {
        return;
    }
    match catch_unwind(AssertUnwindSafe(|| law_outputs(case, result))) {
        Ok(Ok(found)) => {
            result.notes.extend(found.iter().filter_map(OutputEntry::note));
            result.outputs.extend(found);
        }
        Ok(Err(why)) => result.notes.push(format!("no outputs of laws: {why}")),
        Err(_) => result.notes.push("a panic ended the outputs of laws".into()),
    }
}

/// Removes the parts of a result that the study does not request.
fn leave_out(case: &Case, result: &mut CaseResult) {
    if !case.output_curve {
        result.path.curve = None;
    }
    if !case.output_fields {
        result.leave_out_fields();
    }
}

/// Returns the result of a case that a stored path proves, without solving; it names the solver with this tag.
///
/// # Errors
/// The first reason why its states do not prove the end.
pub fn proved_case(case: &Case, tag: &str, path: &StoredPath) -> Result<CaseResult, String> {
    let input = CaseInput { stored_numbers: 0, ..CaseInput::of(case) };
    let mut result = path::proved_by_stored_path(&input, tag, path)?;
    add_label(case, &mut result);
    add_carried(case, &mut result);
    add_outputs(case, &mut result);
    leave_out(case, &mut result);
    Ok(result)
}

/// Withdraws a result in which `verify` finds a mistake, so that both use the same criterion.
fn withdraw(result: &mut CaseResult, wrong: Vec<String>) {
    if wrong.is_empty() {
        return;
    }
    result.stored_path = None;
    result.status = Status::Stalled;
    result.greatest = Greatest::Open;
    (result.load_factor, result.bounds, result.proved_by) = (None, None, None);
    result.carried = CarriedLoad::default();
    result.outputs.clear();
    if let Some(last) = result.stages.last_mut() {
        (last.status, last.factor) = (Status::Stalled, None);
    }
    result.notes.push(format!("{}: {}", result.solver, wrong.join("; ")));
    result.certificate.passed = false;
    result.certificate.failures.extend(wrong);
}

/// Solves one case and reports it to an observer; `None` if the observer has cancelled before the result.
pub fn solve_followed(case: &Case, observer: &dyn Observer) -> Option<CaseResult> {
    let result = solve_unless_cancelled(case, observer)?;
    observer.answered(&result);
    Some(result)
}

/// Solves the cases of a study whose ids are in `wanted`, with `jobs` cases in parallel; results are in the order of `wanted`.
/// Cases without a result when the observer cancels are omitted.
pub fn solve_cases(study: &Study, wanted: &[usize], jobs: usize, observer: &dyn Observer) -> Vec<CaseResult> {
    let one = |id: &usize| solve_followed(&*study.case(*id)?, observer);
    if jobs > 1 {
        side_by_side(jobs, || in_order(wanted, one)).into_iter().flatten().collect()
    } else {
        wanted.iter().filter_map(one).collect()
    }
}

/// Solves one case; `None` if the observer has cancelled before the result.
pub fn solve_unless_cancelled(case: &Case, observer: &dyn Observer) -> Option<CaseResult> {
    if observer.cancelled() {
        return None;
    }
    let result = solve_observed(case, &mut Followed { case, observer, states: 0 });
    // A path that was cancelled is stalled. A path that ended at the same moment has its result.
    (result.status.is_answer() || !observer.cancelled()).then_some(result)
}

/// Reports the progress of the path of a case to the observer of a study.
struct Followed<'a> {
    case: &'a Case,
    observer: &'a dyn Observer,
    states: u64,
}

impl PathObserver for Followed<'_> {
    fn state(&mut self, problem: &PathProblem, state: &PathState) -> bool {
        self.states += 1;
        let load_step = &problem.load_steps[state.load_step];
        self.observer.on_path(&PathProgress {
            case: self.case.id,
            stage: &self.case.stages[load_step.stage].name,
            gravity: load_step.gravity,
            factor: state.factor,
            states: self.states,
            problem,
            state,
        });
        !self.observer.cancelled()
    }
}
