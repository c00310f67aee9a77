//! Solving a case along its path, while the certificate looks on.

use super::auto::{TaggedPathSolver, willing};
use super::case_input::CaseInput;
use super::path_result::{Seen, path_result};
use super::recorded::Recorder;
use crate::results::CaseResult;
use voussoir_core::certificate::PathChecker;
use voussoir_core::limit::Status;
use voussoir_core::path::{PathObserver, PathProblem, PathSettings, PathState};

/// A path's certificate, with somebody else who looks on.
struct Watched<'a> {
    checker: PathChecker,
    observer: &'a mut dyn PathObserver,
    /// Whether that somebody has ended the path.
    ended: bool,
    /// The last state of each stage, by index.
    ends: Vec<Option<PathState>>,
    recorder: Recorder<'a>,
}

impl PathObserver for Watched<'_> {
    fn state(&mut self, problem: &PathProblem, state: &PathState) -> bool {
        self.ends[problem.load_steps[state.load_step].stage] = Some(state.clone());
        self.recorder.state(problem, state);
        self.ended |= !self.observer.state(problem, state);
        self.checker.state(problem, state) && !self.ended
    }
}

/// Solves a case along its path by the first solver that takes it and does not stall; `observer` sees every state.
pub(super) fn solve_by_path(
    input: &CaseInput,
    solvers: &[TaggedPathSolver],
    observer: &mut dyn PathObserver,
) -> CaseResult {
    let problem = match PathProblem::new(input.assembly, input.stages) {
        Ok(problem) => problem,
        Err(why) => return failed(&solvers[0].0, why),
    };
    let (first, others) = match willing(solvers, &problem, input.settings) {
        Ok(willing) => willing,
        Err((tag, why)) => return failed(&tag, format!("{tag}: {why}")),
    };
    let (mut result, mut ended) = by_strategies(input, &problem, first, observer);
    for next in others {
        if ended || result.status != Status::Stalled {
            break;
        }
        let CaseResult { solver: tag, notes, .. } = result;
        (result, ended) = by_strategies(input, &problem, next, observer);
        result.notes.extend(notes.into_iter().map(|note| format!("{tag} stalled: {note}")));
    }
    result
}

/// Solves a case along its path by one solver, with further strategies where its own stalls; whether the observer has
/// ended it.
fn by_strategies(
    input: &CaseInput,
    problem: &PathProblem,
    solver: &TaggedPathSolver,
    observer: &mut dyn PathObserver,
) -> (CaseResult, bool) {
    let (mut own, mut ended) = traced(input, problem, solver, observer);
    if own.status != Status::Stalled {
        return (own, ended);
    }
    for strategy in solver.1.further_strategies(input.settings) {
        if ended {
            break;
        }
        let name = serde_json::to_string(&*strategy).unwrap_or_default();
        let settings = PathSettings { continuation: Some(strategy.clone()), ..input.settings.clone() };
        let (mut other, stopped) = traced(&CaseInput { settings: &settings, ..*input }, problem, solver, observer);
        ended = stopped;
        let why = |result: &CaseResult| result.notes.first().cloned().unwrap_or_default();
        if other.status != Status::Stalled {
            other.notes.push(format!("followed by {name}: the solver's own strategy stalled ({})", why(&own)));
            return (other, ended);
        }
        own.notes.push(format!("by {name}: {}", why(&other)));
    }
    (own, ended)
}

/// Solves a case along its path by one solver; whether the observer has ended it.
fn traced(
    input: &CaseInput,
    problem: &PathProblem,
    (tag, solver): &TaggedPathSolver,
    observer: &mut dyn PathObserver,
) -> (CaseResult, bool) {
    let checker = match PathChecker::certifying(input.assembly, input.stages, input.settings.finite) {
        Ok(checker) => checker,
        Err(why) => return (failed(tag, why), false),
    };
    let recorder = Recorder::new(input);
    let mut watched = Watched { checker, observer, ended: false, ends: vec![None; input.stages.len()], recorder };
    let solved = solver.trace(problem, input.settings, &mut watched);
    let energy = solver.energy_tolerance();
    let Watched { checker, ended, ends, recorder, .. } = watched;
    (path_result(input, tag, problem, solved, Seen { checker, ends, energy, states: recorder.chosen() }), ended)
}

fn failed(tag: &str, why: String) -> CaseResult {
    CaseResult { solver: tag.into(), ..CaseResult::stalled(why) }
}
