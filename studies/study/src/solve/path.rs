//! Solves a case along its path and checks every state. A stored path can replace the solver.

use super::auto::{TaggedPathSolver, path_solvers, willing};
use super::case_input::CaseInput;
use super::ours::path_is_ours;
use super::path_result::{Seen, path_result};
use super::path_status::{ELSEWHERE, Progress};
use super::recorded::Recorder;
use super::stored_path;
use crate::results::CaseResult;
use crate::results::stored_path::StoredPath;
use std::sync::Arc;
use voussoir_core::certificate::{Displaced, PathChain, PathChecker, tolerance};
use voussoir_core::path::{PathAnswer, PathObserver, PathProblem, PathSolver, PathState, Unobserved};

/// The certificate of a path, together with another observer.
struct Watched<'a> {
    input: &'a CaseInput<'a>,
    structure: Arc<PathProblem>,
    checker: PathChecker,
    chain: PathChain,
    observer: &'a mut dyn PathObserver,
    /// True if the other observer has ended the path.
    ended: bool,
    /// The last state of each earlier stage, by index.
    ends: Vec<Option<PathState>>,
    progress: Progress,
    recorder: Recorder<'a>,
    /// The error of the first state that cannot be read.
    malformed: Result<(), String>,
}

impl PathObserver for Watched<'_> {
    fn state(&mut self, problem: &PathProblem, state: &PathState) -> bool {
        self.malformed = std::mem::replace(&mut self.malformed, Ok(())).and_then(|()| state.check_form(problem));
        if self.malformed.is_err() {
            return false;
        }
        let stage = |state: &PathState| problem.load_steps[state.load_step].stage;
        if let Some(last) = self.progress.last().filter(|last| stage(last) != stage(state)) {
            self.ends[stage(last)] = Some(last.clone());
        }
        self.progress.add(problem, state);
        self.recorder.state(problem, state);
        let displaced = Displaced::new(&self.structure, state, self.input.settings.finite);
        if self.chain.broken().is_none() {
            // Gaps are not stored. The chain computes them from forces and motions, now and when it is read back.
            let mut own = state.clone();
            own.gap.copy_from_slice(displaced.gaps());
            self.chain.add(own);
        }
        self.checker.check(&displaced);
        self.ended |= !self.observer.state(problem, state);
        !self.ended
    }
}

impl<'a> Watched<'a> {
    fn new(input: &'a CaseInput<'a>, observer: &'a mut dyn PathObserver) -> Result<Self, String> {
        let finite = input.settings.finite;
        let checker = PathChecker::certifying(input.assembly, input.stages, finite)?;
        let structure = checker.structure().ok_or("no structure")?;
        Ok(Watched {
            input,
            chain: PathChain::new(structure.clone(), finite),
            structure,
            checker,
            observer,
            ended: false,
            ends: vec![None; input.stages.len()],
            progress: Progress::default(),
            recorder: Recorder::new(input),
            malformed: Ok(()),
        })
    }

    /// Returns the result of a path from its recorded states. If it is `believed`, parts that no check proves are kept.
    fn result(
        self,
        problem: &PathProblem,
        (tag, solver): (&str, &dyn PathSolver),
        solved: PathAnswer,
        believed: bool,
    ) -> CaseResult {
        let Watched { input, checker, chain, mut ends, progress, recorder, malformed, .. } = self;
        if let Err(why) = malformed.and_then(|()| solved.check_form(problem)) {
            return failed(tag, format!("{tag}: {why}"));
        }
        if let Some(last) = progress.last() {
            ends[problem.load_steps[last.load_step].stage] = Some(last.clone());
        }
        // A solver may require a stricter tolerance, never a looser one.
        let energy = solver.energy_tolerance().min(tolerance("path_energy").result);
        let seen = Seen { checker, chain, ends, progress, energy, states: recorder.chosen(), believed };
        path_result(input, tag, problem, solved, seen)
    }
}

/// Solves a case along its path by the first solver that accepts it; `observer` gets every state.
pub(crate) fn solve_by_path(
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
    let mut watched = match Watched::new(input, observer) {
        Ok(watched) => watched,
        Err(why) => return failed(tag, why),
    };
    let solved = solver.trace(problem, input.settings, &mut watched);
    watched.result(problem, (tag, solver.as_ref()), solved, path_is_ours(tag, input.settings))
}

/// Returns the result that the states and witnesses of a stored path prove, without solving and for any author of the path.
/// The result names the solver `tag`.
///
/// # Errors
/// The first reason why they do not prove the end of the path.
pub(crate) fn proved_by_stored_path(input: &CaseInput, tag: &str, path: &StoredPath) -> Result<CaseResult, String> {
    let solvers = path_solvers(input);
    let (_, solver) =
        solvers.iter().find(|(own, _)| own == tag).ok_or_else(|| format!("\"{tag}\" does not solve this case"))?;
    let problem = PathProblem::new(input.assembly, input.stages)?;
    let mut unobserved = Unobserved;
    let mut watched = Watched::new(input, &mut unobserved)?;
    let mut states = stored_path::states(path, problem.contacts.len())?;
    for (index, state) in states.iter_mut().enumerate() {
        state.check_form(&problem).map_err(|why| format!("state {index}: {why}"))?;
        state.gap = Displaced::new(&watched.structure, state, input.settings.finite).gaps().to_vec();
        watched.state(&problem, state);
    }
    let solved = stored_path::answer(path, &states)?;
    solved.check_form(&problem)?;
    let result = watched.result(&problem, (tag, solver.as_ref()), solved, false);
    if result.path.end_is_checked == Some(true) {
        return Ok(result);
    }
    let why = result.certificate.failures.join("; ");
    let why = why.strip_prefix(ELSEWHERE).map_or(why.as_str(), |why| why.trim_start_matches(": "));
    Err(if why.is_empty() { "the states do not prove the end".into() } else { why.into() })
}

fn failed(tag: &str, why: String) -> CaseResult {
    CaseResult { solver: tag.into(), ..CaseResult::stalled(why) }
}
