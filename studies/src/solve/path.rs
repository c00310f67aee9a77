//! Solving a case along its path, while the certificate looks on.

use super::auto::{TaggedPathSolver, willing};
use super::case_input::CaseInput;
use super::path_result::{Seen, path_result};
use super::path_status::Progress;
use super::recorded::Recorder;
use crate::results::CaseResult;
use voussoir_core::certificate::{PathChain, PathChecker, tolerance};
use voussoir_core::path::{PathObserver, PathProblem, PathState};

/// A path's certificate, with somebody else who looks on.
struct Watched<'a> {
    checker: PathChecker,
    chain: PathChain,
    observer: &'a mut dyn PathObserver,
    /// Whether that somebody has ended the path.
    ended: bool,
    /// The last state of each stage, by index.
    ends: Vec<Option<PathState>>,
    progress: Progress,
    recorder: Recorder<'a>,
    /// The first state that cannot be read, in words.
    malformed: Result<(), String>,
}

impl PathObserver for Watched<'_> {
    fn state(&mut self, problem: &PathProblem, state: &PathState) -> bool {
        self.malformed = std::mem::replace(&mut self.malformed, Ok(())).and_then(|()| state.check_form(problem));
        if self.malformed.is_err() {
            return false;
        }
        self.ends[problem.load_steps[state.load_step].stage] = Some(state.clone());
        self.progress.add(problem, state);
        self.recorder.state(problem, state);
        self.chain.add(state);
        self.ended |= !self.observer.state(problem, state);
        self.checker.state(problem, state) && !self.ended
    }
}

/// Solves a case along its path by the first solver that accepts it; `observer` sees every state.
pub(super) fn solve_by_path(
    input: &CaseInput,
    solvers: &[TaggedPathSolver],
    observer: &mut dyn PathObserver,
) -> CaseResult {
    let problem = match PathProblem::new(input.assembly, input.stages) {
        Ok(problem) => problem,
        Err(why) => return failed(&solvers[0].0, why),
    };
    match willing(solvers, &problem, input.settings) {
        Ok(solver) => traced(input, &problem, solver, observer),
        Err((tag, why)) => failed(&tag, format!("{tag}: {why}")),
    }
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
    let Some(structure) = checker.structure() else { return failed(tag, "no structure".into()) };
    let recorder = Recorder::new(input);
    let mut watched = Watched {
        chain: PathChain::new(structure, input.settings.finite),
        checker,
        observer,
        ended: false,
        ends: vec![None; input.stages.len()],
        progress: Progress::default(),
        recorder,
        malformed: Ok(()),
    };
    let solved = solver.trace(problem, input.settings, &mut watched);
    // A solver may ask for less, never for more.
    let energy = solver.energy_tolerance().min(tolerance("path_energy").result);
    let Watched { checker, chain, ends, progress, recorder, malformed, .. } = watched;
    if let Err(why) = malformed.and_then(|()| solved.check_form(problem)) {
        return failed(tag, format!("{tag}: {why}"));
    }
    let seen = Seen { checker, chain, ends, progress, energy, states: recorder.chosen() };
    path_result(input, tag, problem, solved, seen)
}

fn failed(tag: &str, why: String) -> CaseResult {
    CaseResult { solver: tag.into(), ..CaseResult::stalled(why) }
}
