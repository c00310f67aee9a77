//! What the states and the witnesses of a path prove, without trust in its solver.
//!
//! The states are a chain: each follows from the one before. A witness is a proof about rates at one of them. So a limit point is proved
//! by a witness that no rate raises the load there, a plateau by the same and a mechanism, a target by a chain that reaches it.

use super::limit_points::asked_end;
use voussoir_core::certificate::{PathChain, ray_residual, tolerance};
use voussoir_core::limit::Status;
use voussoir_core::path::{
    LoadStep, LoadStepEnd, PathAnswer, PathProblem, PathSettings, PathState, ProvenPeak, Witness,
};

/// Share of the greatest limit point to which the load has fallen at the end of the range.
const RANGE: f64 = 0.5;
/// Relative difference of two loads that is rounding.
const SAME: f64 = 1e-12;

/// Relative difference of the loads of two limit points that are one.
const SAME_LIMIT_POINT: f64 = 1e-6;

/// The chain of a path with the answer of its solver.
pub(super) struct PathProof<'a> {
    pub chain: &'a PathChain,
    pub problem: &'a PathProblem,
    pub settings: &'a PathSettings,
    pub solved: &'a PathAnswer,
}

/// 1 if a load step raises its factor, else −1.
fn sense(step: &LoadStep) -> f64 {
    match step.end {
        LoadStepEnd::Factor(end) if end < step.start => -1.0,
        _ => 1.0,
    }
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
        let Self { solved, .. } = self;
        if matches!(solved.status, Status::Collapse | Status::LimitPoint) && solved.factor != Some(solved.state.factor)
        {
            return Err("the factor is not that of the state".into());
        }
        match solved.status {
            Status::Stands if self.chain.reaches_end() => Ok(()),
            Status::Stands => Err("the states do not reach the target without a limit point".into()),
            Status::Collapse | Status::NoEquilibrium => self.collapse(),
            Status::Unbounded => self.ray(),
            Status::LimitPoint => self.ends_at_limit_point(),
            _ => Err("no check of this status exists".into()),
        }
    }

    /// A mechanism at the last state, or a limit point below which the load stays up to the end of the range.
    fn collapse(&self) -> Result<(), String> {
        self.check_maxima()?;
        let state = &self.solved.state;
        if self.settings.finite {
            self.limit_point(state)?;
            return self.chain.stands_still_after(state).or_else(|_| self.falls_after(state));
        }
        let motion = self.solved.motion.as_deref().ok_or("no mechanism")?;
        let witnesses: Vec<&Witness> = self.witnesses(state).collect();
        self.chain.check_collapse(state, motion, &witnesses)?;
        if self.is_greatest(state) { Ok(()) } else { Err("the load is greater at an earlier state".into()) }
    }

    /// The ray that carries any load.
    fn ray(&self) -> Result<(), String> {
        let state = &self.solved.state;
        let loading = &self.problem.load_steps[state.load_step].loading;
        let ray = self.solved.ray.as_deref().ok_or("no ray")?;
        let residual = ray_residual(self.problem, loading, ray);
        if residual.is_nan() || residual > tolerance("path_ray").result {
            return Err("the ray does not carry the load".into());
        }
        self.check_maxima()?;
        self.chain.check_ray(self.witnesses(state).next().ok_or("no witness of the ray")?)
    }

    /// The first limit point of a stage that ends there.
    fn ends_at_limit_point(&self) -> Result<(), String> {
        let state = &self.solved.state;
        if self.solved.limit_point_end.is_some() {
            return Err("the reason why the path ends at its limit point is not checked".into());
        }
        if asked_end(self.settings, &self.problem.load_steps[state.load_step]).is_none() {
            return Err("the stage does not end at its first limit point".into());
        }
        let earlier = |own: &&PathState| own.load_step == state.load_step && own.factor != state.factor;
        if self.maxima().iter().any(earlier) {
            return Err("another limit point comes first".into());
        }
        self.limit_point(state)
    }

    /// No rate raises the load at a state of the chain.
    fn limit_point(&self, state: &PathState) -> Result<(), String> {
        let witnesses: Vec<&Witness> = self.witnesses(state).collect();
        self.chain.check_none_rises(state, &witnesses)
    }

    /// Witnesses at a state.
    fn witnesses(&self, state: &PathState) -> impl Iterator<Item = &Witness> {
        let (load_step, factor) = (state.load_step, state.factor);
        self.solved.witnesses.iter().filter(move |own| own.state.load_step == load_step && own.state.factor == factor)
    }

    fn of_step(&self, load_step: usize) -> impl Iterator<Item = &PathState> {
        self.chain.states().filter(move |own| own.load_step == load_step)
    }

    /// True if no state of its load step has a greater load, in the sense of the step.
    fn is_greatest(&self, state: &PathState) -> bool {
        let sense = sense(&self.problem.load_steps[state.load_step]);
        self.of_step(state.load_step).all(|own| (own.factor - state.factor) * sense <= SAME * state.factor.abs())
    }

    /// States of the chain behind which the load falls after it has risen.
    fn maxima(&self) -> Vec<&PathState> {
        let mut found: Vec<&PathState> = Vec::new();
        let (mut last, mut rises): (Option<&PathState>, bool) = (None, false);
        for state in self.chain.states() {
            let sense = sense(&self.problem.load_steps[state.load_step]);
            let before = last.replace(state).filter(|before| before.load_step == state.load_step);
            let change = before.map_or(0.0, |before| (state.factor - before.factor) * sense);
            let rounding = SAME * state.factor.abs();
            if change < -rounding && rises {
                found.extend(before);
            }
            rises = change > rounding || (rises && before.is_some() && change >= -rounding);
        }
        found
    }

    /// Every state behind which the load falls is a limit point of the answer.
    fn check_maxima(&self) -> Result<(), String> {
        for state in self.maxima() {
            let same = |factor: f64| (factor - state.factor).abs() <= SAME_LIMIT_POINT * state.factor.abs();
            let is_listed = |peak: &ProvenPeak| peak.load_step == state.load_step && same(peak.factor);
            if !self.solved.limit_points.iter().any(is_listed) {
                return Err(format!("a limit point at the factor {} is left out", state.factor));
            }
        }
        Ok(())
    }

    /// After a state the load never exceeds it up to the end of the range: what the stage asks for, else half of this load, counted from
    /// the start of its load step, or a displacement of one span.
    fn falls_after(&self, state: &PathState) -> Result<(), String> {
        let step = &self.problem.load_steps[state.load_step];
        let of_step = || self.of_step(state.load_step);
        let (Some(first), Some(last)) = (of_step().next(), of_step().last()) else {
            return Err("no state of the load step".into());
        };
        if !self.is_greatest(state) {
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

    /// The limit points that are proved, as the states give them.
    pub fn limit_points(&self) -> Vec<ProvenPeak> {
        let mut states = self.maxima();
        let end = &self.solved.state;
        let is_end = |state: &&PathState| state.load_step == end.load_step && state.factor == end.factor;
        if self.solved.status == Status::LimitPoint || self.settings.finite && !states.iter().any(is_end) {
            states.extend(self.of_step(end.load_step).find(is_end));
        }
        let peak = |state: &PathState| {
            let after = self.of_step(state.load_step).skip_while(|own| !std::ptr::eq(*own, state));
            let sense = sense(&self.problem.load_steps[state.load_step]);
            let lower = |a: f64, own: &PathState| if (own.factor - a) * sense < 0.0 { own.factor } else { a };
            let lowest = after.fold(state.factor, lower);
            ProvenPeak { load_step: state.load_step, factor: state.factor, displacement: state.displacement, lowest }
        };
        states.into_iter().filter(|state| self.limit_point(state).is_ok()).map(peak).collect()
    }
}
