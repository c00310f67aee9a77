//! A dishonest path solver as data: it begins with the states and the answer of an honest one.

use voussoir_core::limit::Status;
use voussoir_core::path::{PathAnswer, PathObserver, PathProblem, PathSettings, PathSolver, PathState};

/// A question to a path solver, with the honest solver that a lie is made from.
#[derive(Debug, Clone, Copy)]
pub struct PathAsked<'a> {
    /// The honest solver.
    pub honest: &'a dyn PathSolver,
    /// The problem.
    pub problem: &'a PathProblem,
    /// The settings.
    pub settings: &'a PathSettings,
}

/// The states that an observer gets, and the answer.
#[derive(Debug, Clone)]
pub struct Story {
    /// States in order.
    pub states: Vec<PathState>,
    /// The answer.
    pub answer: PathAnswer,
}

/// A dishonest path solver.
#[derive(Debug, Clone, Copy)]
pub struct PathLie {
    /// Its name.
    pub name: &'static str,
    /// Makes an honest story false; `None` if the lie does not apply.
    pub tell: fn(&PathAsked, &mut Story) -> Option<()>,
}

impl PathLie {
    /// A lie with a name.
    pub const fn new(name: &'static str, tell: fn(&PathAsked, &mut Story) -> Option<()>) -> Self {
        PathLie { name, tell }
    }
}

/// Records the states of a path.
#[derive(Debug, Default)]
struct Recorder(Vec<PathState>);

impl PathObserver for Recorder {
    fn state(&mut self, _: &PathProblem, state: &PathState) -> bool {
        self.0.push(state.clone());
        true
    }
}

impl PathAsked<'_> {
    /// Returns the honest story.
    pub fn story(&self) -> Story {
        self.story_of(self.problem, self.settings)
    }

    /// Returns the honest story of another problem or other settings.
    pub fn story_of(&self, problem: &PathProblem, settings: &PathSettings) -> Story {
        let mut recorder = Recorder::default();
        let answer = self.honest.trace(problem, settings, &mut recorder);
        Story { states: recorder.0, answer }
    }

    /// Returns the rate of all bodies between two states, scaled to p·q̇ = 1 if the load does work on it.
    pub fn rate(&self, from: &PathState, to: &PathState) -> Vec<[f64; 3]> {
        let mut rate: Vec<[f64; 3]> =
            to.motion.iter().zip(&from.motion).map(|(to, from)| [0, 1, 2].map(|i| to[i] - from[i])).collect();
        let loads = self.problem.wrenches(&self.problem.load_steps[to.load_step].loading);
        let power: f64 = loads.iter().flatten().zip(rate.iter().flatten()).map(|(load, v)| load * v).sum();
        if power != 0.0 {
            rate.iter_mut().flatten().for_each(|v| *v /= power);
        }
        rate
    }
}

impl Story {
    /// Returns `Some` if the honest path ends at its collapse or limit point.
    pub fn falls(&self) -> Option<()> {
        matches!(self.answer.status, Status::Collapse | Status::LimitPoint).then_some(())
    }

    /// Returns the indices of the states of the last load step.
    pub fn last_step(&self) -> Vec<usize> {
        let last = self.states.last().map_or(0, |state| state.load_step);
        (0..self.states.len()).filter(|state| self.states[*state].load_step == last).collect()
    }

    /// Returns the index of the last state of the last load step below a share of the greatest factor, before the peak.
    pub fn below(&self, share: f64) -> Option<usize> {
        let steps = self.last_step();
        let factor = |index: usize| self.states[index].factor;
        let peak = *steps.iter().max_by(|a, b| factor(**a).total_cmp(&factor(**b)))?;
        steps.into_iter().take_while(|index| *index < peak).filter(|i| factor(*i) <= share * factor(peak)).last()
    }

    /// Removes the states after an index; the answer ends at it.
    pub fn stop_at(&mut self, index: usize) {
        self.states.truncate(index + 1);
        let state = &self.states[index];
        (self.answer.load_step, self.answer.factor) = (state.load_step, Some(state.factor));
        (self.answer.state, self.answer.last) = (state.clone(), None);
        self.answer.limit_points.clear();
    }

    /// Changes all states, also in the answer.
    pub fn change(&mut self, change: impl Fn(&mut PathState)) {
        self.states.iter_mut().for_each(&change);
        change(&mut self.answer.state);
        self.answer.last.iter_mut().for_each(&change);
    }
}
