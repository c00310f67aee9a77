//! Drives to a factor: in one step where that is exact, from nothing by a spring, else in equal steps.

use super::model::{Control, Rate, State};
use super::trace::{Outcome, Tracer};
use voussoir_core::limit::Status;
use voussoir_core::path::LoadStep;

/// Why there is no first state.
const NO_START: &str = "the first load has no state that Newton's method or pivoting found, and no proof that there is none: friction that is not associated may leave no state, or several; try event_path, smaller stages, or limit_least";

impl Tracer<'_, '_> {
    /// To a factor: in one step where nothing irreversible happens in it, else in steps.
    pub(super) fn reach(&mut self, load_step: &LoadStep, factor: f64) -> Outcome {
        let control = Control::Factor(factor);
        let whole = self.model.newton(&self.state, self.state.clone(), &control);
        let small = !self.model.finite();
        if let Ok((next, iterations)) = whole {
            let slips = (0..next.gap.len()).any(|c| {
                let gap = self.model.step_gap(&self.state, &next, c);
                self.model.law(c).is_some_and(|law| {
                    !law.opens(next.regime[c]) && law.irreversible(next.regime[c], gap).0 != [0.0; 2]
                })
            });
            let slips = slips || next.yields();
            let far = !small && iterations > 12;
            let straight = !slips && !far && !self.model.response_yields(&next);
            if straight || (small && self.proportional()) {
                return if self.commit(next) { Outcome::Reached } else { Outcome::Ended };
            }
            if small && self.model.monotone() {
                return self.stepped(load_step, factor);
            }
        }
        if small && self.proportional() {
            return self.started(load_step, factor);
        }
        self.follow(load_step, factor)
    }

    /// The first load step where it is proportional and no state at its factor was found: by a spring, which
    /// has a solution whatever the load. If λ grows with it, that state in proportion is the one looked
    /// for. If λ stays at nothing, the motion is a mechanism. Where flow is not associated that proves
    /// something only if λ stays at nothing with associated flow too.
    pub(super) fn started(&mut self, load_step: &LoadStep, factor: f64) -> Outcome {
        let direction = if factor < load_step.start { -1.0 } else { 1.0 };
        let control = Control::Spring { weight: self.spring(), length: direction };
        let nothing = 1e-9 * self.model.units.factor;
        if !self.model.monotone()
            && let Some(next) = self.model.turned(&self.state, factor)
        {
            return if self.commit(next) { Outcome::Reached } else { Outcome::Ended };
        }
        let own = self.model.pivoted(&self.state, &self.state.clone(), &control);
        let Ok((state, _)) = own else {
            self.end(Status::Stalled, NO_START.into());
            return Outcome::Ended;
        };
        if (state.factor - load_step.start) * direction > nothing {
            let guess = self.model.in_proportion(&state, (factor - load_step.start) / (state.factor - load_step.start));
            return match self.model.iterate(&self.state, guess, &Control::Factor(factor), 8, None) {
                Ok((next, _)) if self.commit(next.clone()) => Outcome::Reached,
                Ok(_) => Outcome::Ended,
                Err(_) => self.follow(load_step, factor),
            };
        }
        if !self.model.monotone() {
            let polygons = self.model.associated();
            let other = self.model.pivoted(&self.state, &self.state.clone(), &control);
            self.model.polygons = polygons;
            if !other.is_ok_and(|(other, _)| (other.factor - load_step.start) * direction <= nothing) {
                self.end(Status::Stalled, NO_START.into());
                return Outcome::Ended;
            }
        }
        let mut rate = Rate {
            force: vec![[0.0; 2]; state.force.len()],
            motion: state.motion.clone(),
            factor: 0.0,
            gap: state.gap.clone(),
        };
        let size = self.model.motion_size(&rate).max(1e-300);
        rate = rate.scaled(1.0 / size);
        self.motion = self.scaled_motion(&self.state, &rate);
        self.end(Status::Collapse, String::new());
        Outcome::Ended
    }

    /// Whether the path to any factor is a straight line: nothing has happened yet, and neither gaps nor
    /// strengths give a load a size to be compared with.
    pub(super) fn proportional(&self) -> bool {
        let problem = self.model.problem;
        let untouched = self.state.force.iter().flatten().chain(self.state.gap.iter().flatten()).all(|v| *v == 0.0);
        let linear = self.model.piecewise_linear();
        linear && untouched && problem.shared_facets().0.into_iter().flatten().all(|f| f.bound == 0.0)
    }

    /// To a factor that is known to be carried, in equal steps of λ (associated flow: what carries a
    /// factor carries all between).
    pub(super) fn stepped(&mut self, load_step: &LoadStep, factor: f64) -> Outcome {
        let from = self.state.factor;
        let mut last: Option<State> = None;
        let mut at = 0.0;
        let mut share: f64 = 1.0 / 16.0;
        while at < 1.0 {
            let next_at = if at + share > 1.0 - 1e-9 { 1.0 } else { at + share };
            let target = if next_at < 1.0 { from + next_at * (factor - from) } else { factor };
            let mut guess = self.state.clone();
            if let Some(last) = &last {
                let ratio = (target - self.state.factor) / (self.state.factor - last.factor);
                for c in 0..guess.force.len() {
                    (0..2).for_each(|k| guess.force[c][k] += ratio * (guess.force[c][k] - last.force[c][k]));
                }
                for b in 0..guess.motion.len() {
                    (0..3).for_each(|k| guess.motion[b][k] += ratio * (guess.motion[b][k] - last.motion[b][k]));
                }
            }
            match self.model.newton(&self.state, guess, &Control::Factor(target)) {
                Ok((next, _)) => {
                    last = Some(self.state.clone());
                    if !self.commit(next) {
                        return Outcome::Ended;
                    }
                    at = next_at;
                }
                Err(_) => {
                    self.model.count("cutbacks", 1);
                    share *= 0.5;
                    if share < 1e-4 {
                        return self.follow(load_step, factor);
                    }
                }
            }
        }
        Outcome::Reached
    }
}
