//! Solving a case along its path, while the certificate looks on.

use super::auto::{TaggedPathSolver, willing};
use super::case_input::CaseInput;
use super::path_result::{Seen, path_result};
use super::path_status::Progress;
use super::recorded::Recorder;
use crate::results::{CaseResult, LimitPointEntry};
use voussoir_core::certificate::{PathChain, PathChecker, tolerance};
use voussoir_core::path::{PathObserver, PathProblem, PathState};

/// Relative difference of two strategies' limit points that are one.
const SAME_PEAK: f64 = 1e-6;

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
        Ok(solver) => by_strategies(input, &problem, solver, observer),
        Err((tag, why)) => failed(&tag, format!("{tag}: {why}")),
    }
}

/// Solves a case along its path by one solver, with further strategies if its own stalls.
fn by_strategies(
    input: &CaseInput,
    problem: &PathProblem,
    solver: &TaggedPathSolver,
    observer: &mut dyn PathObserver,
) -> CaseResult {
    let (mut own, mut ended) = traced(input, problem, solver, observer);
    if own.status.is_answer() {
        return own;
    }
    let own_why = why(&own);
    let named = input.settings.strategies().next().is_some();
    let whose = if named { "the strategy that was asked for" } else { "the solver's own strategy" };
    for strategy in solver.1.further_strategies(input.settings) {
        if ended {
            break;
        }
        let name = serde_json::to_string(&*strategy).unwrap_or_default();
        let settings = input.settings.followed_by(strategy);
        let (mut other, stopped) = traced(&CaseInput { settings: &settings, ..*input }, problem, solver, observer);
        ended = stopped;
        let missed = missed_peak(&own, &other).filter(|_| other.status.is_answer());
        if other.status.is_answer() && missed.is_none() {
            other.notes.push(format!("followed by {name}: {whose} stalled ({own_why})"));
            return other;
        }
        own.notes.push(match missed {
            Some(peak) => format!("by {name}: no limit point at the factor {peak}, which {whose} found"),
            None => format!("by {name}: {}", why(&other)),
        });
    }
    own
}

/// Why a path stalled, in the words of its notes but for that on its energy.
fn why(stalled: &CaseResult) -> String {
    let words = stalled.notes.iter().filter(|note| !note.starts_with("energy of the last stage"));
    words.cloned().collect::<Vec<_>>().join("; ")
}

/// The greatest limit point that a stalled path has proven, where another path of the same case does not pass it: one of
/// them has left its branch.
fn missed_peak(stalled: &CaseResult, other: &CaseResult) -> Option<f64> {
    let of_last =
        |known: &&LimitPointEntry| stalled.path.limit_points.last().is_some_and(|last| last.stage == known.stage);
    let proven = stalled.path.limit_points.iter().filter(of_last).map(|peak| peak.factor);
    let greatest = proven.reduce(|a, b| if b.abs() > a.abs() { b } else { a })?;
    let found = |known: &LimitPointEntry| (known.factor - greatest).abs() <= SAME_PEAK * greatest.abs();
    (!other.path.limit_points.iter().filter(of_last).any(found)).then_some(greatest)
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
    let Some(structure) = checker.structure() else { return (failed(tag, "no structure".into()), false) };
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
    let Watched { checker, chain, ended, ends, progress, recorder, malformed, .. } = watched;
    if let Err(why) = malformed.and_then(|()| solved.check_form(problem)) {
        return (failed(tag, format!("{tag}: {why}")), ended);
    }
    let seen = Seen { checker, chain, ends, progress, energy, states: recorder.chosen() };
    (path_result(input, tag, problem, solved, seen), ended)
}

fn failed(tag: &str, why: String) -> CaseResult {
    CaseResult { solver: tag.into(), ..CaseResult::stalled(why) }
}
