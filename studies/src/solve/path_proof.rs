//! What the states and the witnesses of a path prove, without trust in its solver.
//!
//! The states are a chain: each follows from the one before. A witness is a proof of its state's rates. So a limit point is proved by a
//! witness that no rate raises the load there, a plateau by the same and a mechanism, a target by a chain that reaches it.

use voussoir_core::certificate::PathChain;
use voussoir_core::limit::Status;
use voussoir_core::path::{PathAnswer, PathProblem, PathSettings, PathState, ProvenPeak, Witness};

/// Share of the greatest limit point to which the load has fallen at the end of the range.
const RANGE: f64 = 0.5;

/// The chain of a path with the answer of its solver.
pub(super) struct PathProof<'a> {
    pub chain: &'a PathChain,
    pub problem: &'a PathProblem,
    pub solved: &'a PathAnswer,
    pub settings: &'a PathSettings,
}

impl PathProof<'_> {
    /// Checks the end that the solver claims.
    ///
    /// # Errors
    /// The first part that is not proved, in words.
    pub fn end(&self) -> Result<(), String> {
        if let Some(why) = self.chain.broken() {
            return Err(why.to_string());
        }
        match self.solved.status {
            Status::Stands if self.chain.reaches_end() => Ok(()),
            Status::Stands => Err("the states do not reach the target without a limit point".into()),
            Status::Collapse | Status::NoEquilibrium => self.collapse(),
            Status::Unbounded => {
                let state = &self.solved.state;
                let witness = self.witnesses(state.load_step, state.factor).next();
                self.chain.check_ray(witness.ok_or("no witness of the ray")?)
            }
            Status::LimitPoint if self.solved.limit_point_end.is_none() => self.limit_point(&self.solved.state),
            Status::LimitPoint => Err("that no rate falls is not checked".into()),
            _ => Err("no check of this status exists".into()),
        }
    }

    /// A mechanism at the last state, or a limit point below which the load stays up to the end of the range.
    fn collapse(&self) -> Result<(), String> {
        let state = &self.solved.state;
        if self.settings.finite {
            self.limit_point(state)?;
            return self.chain.stands_still_after(state).or_else(|_| self.falls_after(state));
        }
        let motion = self.solved.motion.as_deref().ok_or("no mechanism")?;
        let witnesses: Vec<&Witness> = self.witnesses(state.load_step, state.factor).collect();
        self.chain.check_collapse(state, motion, &witnesses)
    }

    /// No rate raises the load at a state of the chain.
    fn limit_point(&self, state: &PathState) -> Result<(), String> {
        let witnesses: Vec<&Witness> = self.witnesses(state.load_step, state.factor).collect();
        self.chain.check_none_rises(state, &witnesses)
    }

    /// Witnesses at a factor of a load step.
    fn witnesses(&self, load_step: usize, factor: f64) -> impl Iterator<Item = &Witness> {
        self.solved.witnesses.iter().filter(move |own| own.state.load_step == load_step && own.state.factor == factor)
    }

    /// After a state the load never exceeds it up to the end of the range: what the stage asks for, else half of this load, counted from
    /// the start of its load step, or a displacement of one span.
    fn falls_after(&self, state: &PathState) -> Result<(), String> {
        let step = &self.problem.load_steps[state.load_step];
        let of_step = || self.chain.states().filter(|own| own.load_step == state.load_step);
        let (Some(first), Some(last)) = (of_step().next(), of_step().last()) else {
            return Err("no state of the load step".into());
        };
        if of_step().any(|own| own.factor > state.factor) {
            return Err("the load exceeds the limit point".into());
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

    /// Limit points of the answer that are proved.
    pub fn limit_points(&self) -> Vec<ProvenPeak> {
        let proved = |peak: &&ProvenPeak| {
            let mut own = self.witnesses(peak.load_step, peak.factor).map(|witness| &witness.state);
            own.next().is_some_and(|state| self.limit_point(state).is_ok())
        };
        self.solved.limit_points.iter().filter(proved).cloned().collect()
    }
}
