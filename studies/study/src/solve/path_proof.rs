//! The end of a path, proved by its states and witnesses without trust in its solver.
//!
//! The states are a chain: each follows from the previous one. A witness is a proof about rates at one of them. A limit point
//! is proved by a witness that no rate raises the load there. A plateau needs this witness and a mechanism. A target is proved
//! by a chain that reaches it. If laws have a history, a limit point is proved for the loading set of the rate just beyond it.

use super::limit_points::asked_end;
use crate::results::EndProof;
use std::cell::{Cell, RefCell};
use voussoir_core::certificate::{PathChain, ray_residual, tolerance};
use voussoir_core::limit::Status;
use voussoir_core::path::{
    LimitPointEnd, LoadStep, LoadStepEnd, PathAnswer, PathProblem, PathSettings, PathState, ProvenPeak, Witness,
};

/// Share of the greatest limit point to which the load has fallen at the end of the range.
const RANGE: f64 = 0.5;
/// Relative difference of two loads below which it is rounding.
const SAME: f64 = 1e-12;

/// Relative change of a load below which the load is stationary.
const STANDS_STILL: f64 = 1e-6;

/// Least dissipation of sliding, relative to the work of contact forces and of the load.
const DISSIPATES: f64 = 1e-6;

/// The chain of a path with the answer of its solver.
pub(super) struct PathProof<'a> {
    chain: &'a PathChain,
    problem: &'a PathProblem,
    settings: &'a PathSettings,
    solved: &'a PathAnswer,
    /// True if a limit point is proved for one loading set only.
    one_loading_set: Cell<bool>,
    /// States that are already proved to be limit points: several checks need each proof.
    proved: RefCell<Vec<PathState>>,
}

/// Returns 1 if a load step raises its factor, otherwise −1.
fn sense(step: &LoadStep) -> f64 {
    match step.end {
        LoadStepEnd::Factor(end) if end < step.start => -1.0,
        _ => 1.0,
    }
}

impl<'a> PathProof<'a> {
    /// Creates the proof of an answer whose states are a chain.
    pub fn new(
        chain: &'a PathChain,
        problem: &'a PathProblem,
        settings: &'a PathSettings,
        solved: &'a PathAnswer,
    ) -> Self {
        PathProof { chain, problem, settings, solved, one_loading_set: Cell::new(false), proved: RefCell::default() }
    }

    /// Checks the end that the solver claims.
    ///
    /// # Errors
    /// The first part that is not proved.
    pub fn end(&self) -> Result<EndProof, String> {
        self.check_end()?;
        Ok(if self.one_loading_set.get() { EndProof::LoadingSet } else { EndProof::StatesAndWitnesses })
    }

    fn check_end(&self) -> Result<(), String> {
        if let Some(why) = self.chain.broken() {
            return Err(why.to_string());
        }
        let Self { solved, .. } = self;
        if matches!(solved.status, Status::Collapse | Status::LimitPoint) && solved.factor != Some(solved.state.factor)
        {
            return Err("the factor and the state of the answer differ".into());
        }
        match solved.status {
            Status::Stands if self.chain.reaches_end() => Ok(()),
            Status::Stands => Err("the states do not reach the target without a limit point".into()),
            Status::Collapse => self.collapse(),
            Status::NoEquilibrium => self.no_equilibrium(),
            Status::Unbounded => self.ray(),
            Status::LimitPoint => self.ends_at_limit_point(),
            _ => Err("no check of this status exists".into()),
        }
    }

    /// Checks that a mechanism is at the last state, or a limit point below which the load stays up to the end of the range.
    fn collapse(&self) -> Result<(), String> {
        self.check_falls()?;
        let state = &self.solved.state;
        let by_mechanism = || {
            let motion = self.solved.motion.as_deref().ok_or("no mechanism")?;
            let witnesses: Vec<&Witness> = self.witnesses(state).collect();
            self.chain.check_collapse(state, motion, &witnesses)?;
            self.is_greatest(state)
        };
        let by_range = || {
            self.limit_point(state)?;
            self.chain.stands_still_after(state).or_else(|_| self.falls_after(state))
        };
        if self.settings.finite || self.chain.has_history() {
            return by_range();
        }
        by_mechanism().or_else(|why| by_range().map_err(|_| why))
    }

    /// Checks a mechanism that refutes equilibrium by itself. On another path, non-associated friction may carry the dead load.
    fn no_equilibrium(&self) -> Result<(), String> {
        let motion = self.solved.motion.as_deref().ok_or("no mechanism")?;
        self.chain.check_collapse(&self.solved.state, motion, &[])
    }

    /// Checks the ray that carries any load.
    fn ray(&self) -> Result<(), String> {
        let state = &self.solved.state;
        let loading = &self.problem.load_steps[state.load_step].loading;
        let ray = self.solved.ray.as_deref().ok_or("no ray")?;
        let residual = ray_residual(self.problem, loading, ray);
        if residual.is_nan() || residual > tolerance("path_ray").result {
            return Err("the ray does not carry the load".into());
        }
        self.check_falls()?;
        self.chain.check_ray(self.witnesses(state).next().ok_or("no witness of the ray")?)
    }

    /// Checks a limit point with the reason why the path ends at it: the question, a lost joint, or that no rate continues.
    fn ends_at_limit_point(&self) -> Result<(), String> {
        let state = &self.solved.state;
        let asked = asked_end(self.settings, &self.problem.load_steps[state.load_step]);
        let earlier = |own: &&PathState| own.load_step == state.load_step && own.factor != state.factor;
        if asked.is_some() && self.maxima().iter().any(earlier) {
            return Err("another limit point comes first".into());
        }
        match self.solved.limit_point_end {
            Some(LimitPointEnd::JointLost) => {
                self.chain.check_joint_lost()?;
                self.is_last(state)?;
                self.is_greatest(state)?;
                self.check_falls()
            }
            Some(LimitPointEnd::None) => {
                self.chain.check_none_continues(&self.solved.witnesses)?;
                self.is_greatest(state)?;
                self.limit_point(state)?;
                self.check_falls()
            }
            None if asked.is_none() => Err("the stage does not end at its first limit point".into()),
            end if end.is_some() && end != asked => Err("the path ends at its limit point for another reason".into()),
            _ => self.limit_point(state),
        }
    }

    /// Checks that no rate raises the load at a state of the chain; if laws have a history, no rate of one loading set.
    fn limit_point(&self, state: &PathState) -> Result<(), String> {
        if self.proved.borrow().iter().any(|own| own.is_same(state)) {
            return Ok(());
        }
        let witnesses: Vec<&Witness> = self.witnesses(state).collect();
        if self.chain.has_history() {
            self.one_loading_set.set(true);
            self.chain.check_loading_set(state, &witnesses)?;
        } else {
            self.chain.check_none_rises(state, &witnesses)?;
        }
        self.proved.borrow_mut().push(state.clone());
        Ok(())
    }

    /// Returns the witnesses at a state.
    fn witnesses(&self, state: &PathState) -> impl Iterator<Item = &Witness> {
        let (load_step, factor) = (state.load_step, state.factor);
        self.solved.witnesses.iter().filter(move |own| own.state.load_step == load_step && own.state.factor == factor)
    }

    fn of_step(&self, load_step: usize) -> impl Iterator<Item = &PathState> {
        self.chain.states().filter(move |own| own.load_step == load_step)
    }

    /// Checks that no state of its load step has a greater load, in the direction of the step.
    fn is_greatest(&self, state: &PathState) -> Result<(), String> {
        let sense = sense(&self.problem.load_steps[state.load_step]);
        let lower = |own: &PathState| (own.factor - state.factor) * sense <= SAME * state.factor.abs();
        if self.of_step(state.load_step).all(lower) {
            Ok(())
        } else {
            Err("the load is greater at another state".into())
        }
    }

    /// Checks that the chain ends at a state.
    fn is_last(&self, state: &PathState) -> Result<(), String> {
        let last = self.chain.states().last();
        let ends = last.is_some_and(|last| last.load_step == state.load_step && last.factor == state.factor);
        if ends { Ok(()) } else { Err("the path goes on behind its limit point".into()) }
    }

    /// Returns the states of the chain after which the load falls after it has risen, each by more than the tolerance of a
    /// stationary load.
    fn maxima(&self) -> Vec<&PathState> {
        let mut found: Vec<&PathState> = Vec::new();
        // The greatest load since the last minimum, or the least load since the last limit point.
        let mut turn: Option<(&PathState, bool)> = None;
        for state in self.chain.states() {
            let Some((last, rises)) = turn.filter(|(last, _)| last.load_step == state.load_step) else {
                turn = Some((state, false));
                continue;
            };
            let change = (state.factor - last.factor) * sense(&self.problem.load_steps[state.load_step]);
            let still = STANDS_STILL * last.factor.abs();
            match rises {
                true if change < -still => {
                    found.push(last);
                    turn = Some((state, false));
                }
                false if change > still => turn = Some((state, true)),
                true if change > 0.0 => turn = Some((state, true)),
                false if change < 0.0 => turn = Some((state, false)),
                _ => {}
            }
        }
        found
    }

    /// Checks that every state after which the load falls is a limit point, and that the load never falls by unloading only. From an
    /// elastic piece the structure unloads only along this piece: a point that opens or closes begins another one.
    fn check_falls(&self) -> Result<(), String> {
        self.maxima().into_iter().try_for_each(|state| self.limit_point(state))?;
        let states: Vec<&PathState> = self.chain.states().collect();
        let elastic_branch = |at: usize| {
            at > 0 && !self.flows(&states, at - 1) && (self.falls(&states, at - 1) || self.chain.opens_or_closes_at(at))
        };
        let unloads = |at: &usize| self.falls(&states, *at) && !self.goes_on(&states, *at) && !elastic_branch(*at);
        match (0..states.len().saturating_sub(1)).find(unloads) {
            Some(at) => Err(format!("behind the factor {} the structure may only unload", states[at].factor)),
            None => Ok(()),
        }
    }

    /// Returns the growth of a quantity on the piece behind a state, in the sense of its load step.
    fn growth(&self, states: &[&PathState], at: usize, of: fn(&PathState) -> f64) -> f64 {
        (of(states[at + 1]) - of(states[at])) * sense(&self.problem.load_steps[states[at + 1].load_step])
    }

    /// Returns true if the load falls on the piece behind a state.
    fn falls(&self, states: &[&PathState], at: usize) -> bool {
        states[at].load_step == states[at + 1].load_step
            && self.growth(states, at, |own| own.factor) < -SAME * states[at].factor.abs()
    }

    /// Returns true if the load does not fall by unloading behind a state: the structure flows, or the load moves on. If all sliding
    /// has stopped and the structure is stable, the load moves back as it falls, and nothing flows.
    fn goes_on(&self, states: &[&PathState], at: usize) -> bool {
        self.growth(states, at, |own| own.displacement) > 0.0 || self.flows(states, at)
    }

    /// Returns true if friction dissipates on the piece behind a state, or if a pressed point slips there: with associated flow, slip
    /// does not dissipate.
    fn flows(&self, states: &[&PathState], at: usize) -> bool {
        self.dissipation(states[at], states[at + 1]) > DISSIPATES || self.chain.slips_after(at)
    }

    /// Returns the dissipation between two states, relative to the work of contact forces and of the load.
    fn dissipation(&self, before: &PathState, after: &PathState) -> f64 {
        let forces = before.force.as_flattened().iter().zip(after.force.as_flattened()).map(|(a, b)| 0.5 * (a + b));
        let gaps = before.gap.as_flattened().iter().zip(after.gap.as_flattened()).map(|(a, b)| b - a);
        let terms = forces.zip(gaps).map(|(force, gap)| -force * gap);
        let (dissipated, size) = terms.fold((0.0, 0.0), |(sum, size), term: f64| (sum + term, size + term.abs()));
        let load = after.factor * self.problem.load_size(&self.problem.load_steps[after.load_step].loading);
        let work = (load * (after.displacement - before.displacement)).abs();
        dissipated / size.max(work).max(f64::MIN_POSITIVE)
    }

    /// Checks that after a state the load never exceeds it up to the end of the range: the end that the stage requests, otherwise
    /// half of this load, measured from the start of its load step, or a displacement of one span. A lost joint also ends the
    /// range.
    fn falls_after(&self, state: &PathState) -> Result<(), String> {
        let step = &self.problem.load_steps[state.load_step];
        let of_step = || self.of_step(state.load_step);
        let (Some(first), Some(last)) = (of_step().next(), of_step().last()) else {
            return Err("no state of the load step".into());
        };
        self.is_greatest(state)?;
        if self.chain.check_joint_lost().is_ok() {
            return Ok(());
        }
        let ended = match self.settings.stop(step.stage) {
            [None, None] => {
                let halved = last.factor - step.start <= RANGE * (state.factor - step.start);
                halved || (last.displacement - first.displacement).abs() >= self.problem.span
            }
            [most, least] => {
                let moved = (last.displacement - state.displacement).abs();
                most.is_some_and(|most| moved >= most) || least.is_some_and(|least| last.factor <= least)
            }
        };
        if ended { Ok(()) } else { Err("the states end before the end of the range".into()) }
    }

    /// Returns the limit points that are proved by the states.
    pub fn limit_points(&self) -> Vec<ProvenPeak> {
        let maxima = self.maxima();
        let mut states = maxima.clone();
        let end = &self.solved.state;
        let is_end = |state: &&PathState| state.load_step == end.load_step && state.factor == end.factor;
        let ends_there = self.solved.status == Status::LimitPoint || self.settings.finite;
        if ends_there && !states.iter().any(is_end) {
            states.extend(self.of_step(end.load_step).find(is_end));
        }
        let peak = |state: &PathState| {
            let is_next =
                |own: &PathState| !std::ptr::eq(own, state) && maxima.iter().any(|next| std::ptr::eq(*next, own));
            let after = self.of_step(state.load_step).skip_while(|own| !std::ptr::eq(*own, state));
            let after = after.take_while(|own| !is_next(own));
            let sense = sense(&self.problem.load_steps[state.load_step]);
            let lower = |a: f64, own: &PathState| if (own.factor - a) * sense < 0.0 { own.factor } else { a };
            let lowest = after.fold(state.factor, lower);
            ProvenPeak { load_step: state.load_step, factor: state.factor, displacement: state.displacement, lowest }
        };
        states.into_iter().filter(|state| self.limit_point(state).is_ok()).map(peak).collect()
    }
}
