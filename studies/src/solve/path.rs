//! Solving a case along its path, while the certificate looks on.

use super::auto::{TaggedPathSolver, willing};
use super::case_input::CaseInput;
use super::path_result::{Seen, path_result};
use super::recorded::Recorder;
use crate::results::CaseResult;
use voussoir_core::certificate::PathChecker;
use voussoir_core::limit::Status;
use voussoir_core::path::{PathObserver, PathProblem, PathState};

/// A path's certificate, with somebody else who looks on.
struct Watched<'a> {
    checker: PathChecker,
    observer: &'a mut dyn PathObserver,
    /// The last state of each stage, by index.
    ends: Vec<Option<PathState>>,
    recorder: Recorder<'a>,
}

impl PathObserver for Watched<'_> {
    fn state(&mut self, problem: &PathProblem, state: &PathState) -> bool {
        self.ends[problem.load_steps[state.load_step].stage] = Some(state.clone());
        self.recorder.state(problem, state);
        self.checker.state(problem, state) && self.observer.state(problem, state)
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
    let mut result = traced(input, &problem, first, observer);
    for next in others {
        if result.status != Status::Stalled {
            break;
        }
        let CaseResult { solver: tag, notes, .. } = result;
        result = traced(input, &problem, next, observer);
        result.notes.extend(notes.into_iter().map(|note| format!("{tag} stalled: {note}")));
    }
    result
}

/// Solves a case along its path by one solver.
fn traced(
    input: &CaseInput,
    problem: &PathProblem,
    (tag, solver): &TaggedPathSolver,
    observer: &mut dyn PathObserver,
) -> CaseResult {
    let checker = match PathChecker::certifying(input.assembly, input.stages, input.settings.finite) {
        Ok(checker) => checker,
        Err(why) => return failed(tag, why),
    };
    let recorder = Recorder::new(input);
    let mut watched = Watched { checker, observer, ends: vec![None; input.stages.len()], recorder };
    let solved = solver.trace(problem, input.settings, &mut watched);
    let energy = solver.energy_tolerance();
    let Watched { checker, ends, recorder, .. } = watched;
    path_result(input, tag, problem, solved, Seen { checker, ends, energy, states: recorder.chosen() })
}

fn failed(tag: &str, why: String) -> CaseResult {
    CaseResult { solver: tag.into(), ..CaseResult::stalled(why) }
}
