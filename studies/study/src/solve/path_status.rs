//! The status that the states of a path prove; the status in the solver's answer is only a hint.

use super::associated_load::AssociatedLoad;
use super::load_history::LoadHistory;
use voussoir_core::certificate::Certificate;
use voussoir_core::limit::{Greatest, Status};
use voussoir_core::path::{LoadStep, LoadStepEnd, PathProblem, PathState};

/// Relative distance from the end of a load step within which a state has reached it.
const REACHED: f64 = 1e-12;

/// Relative difference up to which the loads of a path and of limit analysis agree.
const SAME_LOAD: f64 = 1e-6;

/// Relative difference up to which two bounds of a load factor meet.
const SAME_BOUNDS: f64 = 1e-9;

/// States of a path, in the order of the solver's reports.
#[derive(Debug, Default)]
pub(super) struct Progress {
    /// The last state.
    last: Option<PathState>,
    /// The state with the greatest factor of the last load step, if it is not the last state.
    greatest: Option<PathState>,
    /// Number of load steps whose end a state has reached, in order.
    completed: usize,
    /// Load and displacement of all states.
    pub history: LoadHistory,
}

impl Progress {
    /// Adds the next state.
    pub fn add(&mut self, problem: &PathProblem, state: &PathState) {
        self.history.add(state);
        if let Some(before) = self.last.replace(state.clone()) {
            let turns = before.load_step == state.load_step && state.factor < before.factor;
            let of_step = self.greatest.as_ref().filter(|greatest| greatest.load_step == state.load_step);
            let exceeds = of_step.is_none_or(|greatest| before.factor > greatest.factor);
            if turns && exceeds {
                self.greatest = Some(before);
            }
        }
        while let Some(step) = problem.load_steps.get(self.completed) {
            let here = self.completed == state.load_step && is_complete(step, state.factor);
            if !here && !changes_nothing(problem, step) {
                break;
            }
            self.completed += 1;
        }
    }

    /// Adds the state of a located peak, which solvers do not report as a step.
    pub fn add_peak(&mut self, state: &PathState) {
        let Some(last) = &self.last else { return };
        let highest = self.greatest_of(last.load_step).is_none_or(|greatest| state.factor > greatest.factor);
        if state.load_step == last.load_step && highest {
            self.greatest = Some(state.clone());
        }
    }

    /// Returns the last state.
    pub fn last(&self) -> Option<&PathState> {
        self.last.as_ref()
    }

    /// Returns the load step of the last state.
    pub fn load_step(&self) -> Option<usize> {
        self.last.as_ref().map(|state| state.load_step)
    }

    /// Returns the state with the greatest factor of a load step.
    pub fn greatest_of(&self, load_step: usize) -> Option<&PathState> {
        let of_step = self.greatest.iter().chain(&self.last).filter(|state| state.load_step == load_step);
        of_step.max_by(|a, b| a.factor.total_cmp(&b.factor))
    }

    /// Returns true if states have reached the end of every load step before this one.
    pub fn arrives_at(&self, load_step: usize) -> bool {
        self.completed >= load_step
    }
}

/// Returns true if a factor is at the end of a load step, or beyond a bound of its search.
fn is_complete(step: &LoadStep, factor: f64) -> bool {
    match step.end {
        LoadStepEnd::Factor(end) => (factor - end).abs() <= REACHED * end.abs(),
        LoadStepEnd::Collapse(end) => end.is_finite() && factor >= end * (1.0 - REACHED * end.signum()),
    }
}

/// Returns true if the factor of a load step does not change, or if it has no load and no settlement. Solvers may skip it.
fn changes_nothing(problem: &PathProblem, step: &LoadStep) -> bool {
    let LoadStepEnd::Factor(end) = step.end else { return false };
    let unloaded = || problem.wrenches(&step.loading).iter().all(|wrench| *wrench == [0.0; 3]);
    end == step.start || (step.loading.settlements.is_empty() && unloaded())
}

/// The evidence that decides the status of a path.
pub(super) struct Evidence<'a> {
    pub problem: &'a PathProblem,
    pub progress: &'a Progress,
    /// The status, the load step and the factor in the solver's answer.
    pub hint: (Status, usize, Option<f64>),
    /// The displacement of the load up to which a limit point is searched \[m\]; `None` if the path has one, or goes to a factor.
    pub range: Option<f64>,
    /// Residuals of all states.
    pub certificate: &'a Certificate,
    /// The check of the end; not needed if solver and strategies belong to this project.
    pub end: Result<(), String>,
    /// True if a static field at the target is a sufficient proof: small displacements and associated flow, without softening.
    pub field_is_proof: bool,
    /// The load of limit analysis with associated flow, if no state of the path can be above it.
    pub associated: Option<&'a AssociatedLoad>,
}

/// The proved status of a path, with its bounds.
pub(super) struct PathVerdict {
    pub status: Status,
    pub greatest: Greatest,
    /// Proved bounds of the load factor of an open result.
    pub bounds: [Option<f64>; 2],
    /// Reasons why the hint is not accepted.
    pub failures: Vec<String>,
}

impl Evidence<'_> {
    /// Returns the proved status.
    pub fn decide(&self) -> PathVerdict {
        if !self.certificate.passed {
            return PathVerdict { failures: Vec::new(), ..PathVerdict::nothing() };
        }
        let (status, load_step, _) = self.hint;
        let Some(step) = self.problem.load_steps.get(load_step) else {
            return PathVerdict {
                failures: vec!["the path ends in a load step that does not exist".into()],
                ..PathVerdict::nothing()
            };
        };
        let mut failures = Vec::new();
        if !self.progress.arrives_at(load_step) {
            failures.push("no state reaches the end of an earlier load step".to_string());
        }
        match status {
            Status::Stands if !self.progress.arrives_at(self.problem.load_steps.len()) => {
                failures.push("no state of the path is at the target of the last stage".into());
            }
            Status::Open | Status::Stalled => failures.push(self.unproved_end(load_step)),
            Status::Stands if self.field_is_proof => {}
            _ => failures.extend(self.end.as_ref().err().map(|why| format!("{ELSEWHERE}: {why}"))),
        }
        failures.extend(self.contradiction(step));
        if failures.is_empty() {
            let met = self.meets_associated_load();
            let greatest = if met.is_some() { Greatest::ProvedOptimal } else { Greatest::ProvedOnThePath };
            return PathVerdict { status, greatest, bounds: met.map_or([None; 2], |met| met.map(Some)), failures };
        }
        let bounds = self.proved_ends();
        let status = if bounds == [None; 2] { Status::Stalled } else { Status::Open };
        PathVerdict { status, greatest: Greatest::Open, bounds, failures }
    }

    /// Returns both bounds of the load factor, if the path collapses at the associated load of its last stage.
    fn meets_associated_load(&self) -> Option<[f64; 2]> {
        let (status, load_step, factor) = self.hint;
        let is_last = load_step + 1 == self.problem.load_steps.len();
        let load = self.associated.filter(|_| is_last && status == Status::Collapse)?;
        meeting_bounds(factor?, load)
    }

    /// Returns the reason why the end of a path is not proved.
    fn unproved_end(&self, load_step: usize) -> String {
        let moved = self.progress.history.moved(load_step);
        match self.range.filter(|range| moved >= *range) {
            Some(range) => {
                format!(
                    "no_limit_point_in_range: the load has moved by {moved:.3} m without a limit point; the range is {range:.3} m"
                )
            }
            None => "the end of the path is not proved".into(),
        }
    }

    /// Returns the reason why limit analysis contradicts the claim: the path ends above the associated load, or below it although
    /// flow is associated, or it continues past it.
    fn contradiction(&self, step: &LoadStep) -> Option<String> {
        let AssociatedLoad { factor: limit, unit, associated, .. } = *self.associated?;
        let (status, load_step, factor) = self.hint;
        if load_step + 1 != self.problem.load_steps.len() || step.gravity {
            return None;
        }
        let reached = match status {
            Status::Collapse | Status::LimitPoint => factor?,
            Status::Stands => self.progress.greatest_of(load_step)?.factor,
            _ => return None,
        };
        let margin = SAME_LOAD * limit.abs().max(1e-3 * unit);
        let ends = matches!((status, step.end), (Status::Collapse | Status::LimitPoint, LoadStepEnd::Collapse(_)));
        if reached > limit + margin {
            Some(format!(
                "the path reaches the factor {reached}; limit analysis proves that none above {limit} is carried"
            ))
        } else if associated && ends && reached < limit - margin {
            Some(format!("the path ends at the factor {reached}; with associated flow limit analysis finds {limit}"))
        } else {
            None
        }
    }

    /// Returns the proved bounds of the load factor of the stage at which the path ends early: its greatest state and, for the
    /// last stage, the associated load.
    fn proved_ends(&self) -> [Option<f64>; 2] {
        let Some(at) = self.progress.load_step() else { return [None; 2] };
        let step = &self.problem.load_steps[at];
        if step.gravity || !self.progress.arrives_at(at) {
            return [None; 2];
        }
        let is_last = at + 1 == self.problem.load_steps.len();
        let upper = self.associated.filter(|_| is_last).map(|load| load.factor);
        let lower = self.progress.greatest_of(at).map(|state| state.factor).filter(|factor| *factor > step.start);
        ordered(lower, upper)
    }
}

/// Returns the lower bound, proved by the state of a path, and the associated load as the upper bound, if they meet.
pub(crate) fn meeting_bounds(lower: f64, load: &AssociatedLoad) -> Option<[f64; 2]> {
    let meets = (lower - load.factor).abs() <= SAME_BOUNDS * load.factor.abs().max(1e-3 * load.unit);
    meets.then(|| [lower.min(load.factor), lower.max(load.factor)])
}

/// Returns a lower and an upper bound in their order. The state of a path may be above the associated load by its tolerance;
/// a state further above proves nothing.
pub(crate) fn ordered(lower: Option<f64>, upper: Option<f64>) -> [Option<f64>; 2] {
    let Some((low, high)) = lower.zip(upper) else { return [lower, upper] };
    [(low <= high + SAME_LOAD * high.abs()).then_some(low.min(high)), upper]
}

/// The reason why a path of another project's solver proves no more than its states.
pub(crate) const ELSEWHERE: &str =
    "the end of a path by a solver or strategy from outside this project is not proved, only its states";

impl PathVerdict {
    fn nothing() -> Self {
        PathVerdict { status: Status::Stalled, greatest: Greatest::Open, bounds: [None; 2], failures: Vec::new() }
    }
}
