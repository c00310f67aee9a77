//! Steps and peaks of paths on which bonds soften.
//!
//! Where a bond begins to soften the path has a kink, in a brittle structure a sharp return: both
//! load and displacement fall. A step of a given length in motion or load may then not exist, or be the
//! way back. What always grows is the gap of the points that soften: where the strategy's own step
//! fails, one step is controlled by these gaps (de Borst 1987, Computers & Structures 25, 211-224).

use super::model::{Rate, State};
use super::response::Local;
use super::trace::Tracer;

/// Energy that the trapezoidal rule may lose in a step, as a share of all energy so far.
const ENERGY: f64 = 1e-4;

/// Times that a step is made shorter for the sake of its energy.
pub(super) const MOST_REFINEMENTS: u32 = 6;

impl Tracer<'_, '_> {
    /// By how much a step may grow (below 1: must shrink) so that the work of its loads by the
    /// trapezoidal rule misses the energy stored and dissipated by a small share; infinite without bonds that soften.
    pub(super) fn softening_accuracy(&mut self, next: &State) -> f64 {
        if self.model.responses.is_empty() {
            return f64::INFINITY;
        }
        let slopes = self.model.slopes(next);
        let mut ledger = self.ledger;
        ledger.add(&self.model, &self.state, next, [&self.slopes, &slopes]);
        let after = ledger.recorded(&self.model, self.load_step, next, &slopes);
        let of = |state: &voussoir_core::path::PathState| state.work - state.stored - state.dissipated;
        let lost = (of(&after) - of(&self.recorded)).abs();
        let whole = after.stored.abs() + after.dissipated.abs();
        (ENERGY * whole / lost.max(1e-300)).sqrt()
    }

    /// A step controlled by the gaps of the points that the rate softens. `None` where there are none, none is found, or
    /// the load falls in it and the strategy does not pass limit points.
    pub(super) fn softened(
        &mut self,
        rate: &Rate,
        share: f64,
        target: f64,
        direction: f64,
    ) -> Option<(State, u64, Local)> {
        let (from, passes) = (self.state.factor, self.strategy.passes_limit_points());
        let fits = |factor: f64| (factor - target) * direction <= 0.0 && (passes || (factor - from) * direction > 0.0);
        self.by_gaps(rate, share, fits)
    }

    /// Whether the path goes on with a load that falls, in a step controlled by the gaps of the points that soften.
    pub(super) fn softens_down(&mut self, rate: &Rate, direction: f64) -> bool {
        let from = self.state.factor;
        let falls = |factor: f64| (factor - from) * direction < -1e-9 * from.abs();
        [1e-1, 1e-2, 1e-3, 1e-4, 1e-6].iter().any(|share| self.by_gaps(rate, *share, falls).is_some())
    }

    /// The first step controlled by gaps that softens and whose factor fits.
    fn by_gaps(&mut self, rate: &Rate, share: f64, fits: impl Fn(f64) -> bool) -> Option<(State, u64, Local)> {
        if self.model.responses.is_empty() {
            return None;
        }
        let start = self.state.clone();
        let mut ahead = self.moved(rate, share);
        for (gap, rate) in ahead.gap.iter_mut().zip(&rate.gap) {
            (0..2).for_each(|k| gap[k] += share * rate[k]);
        }
        for local in self.model.local_controls(&start, &ahead, rate) {
            let Ok((next, iterations)) = self.model.newton(&start, ahead.clone(), &local.control(share)) else {
                continue;
            };
            if fits(next.factor) && self.model.response_yields(&next) {
                return Some((next, iterations, local));
            }
        }
        None
    }

    /// The rate in the sense in which what softened in the step goes on to.
    pub(super) fn onwards(&mut self, next: &State, rate: Rate) -> Rate {
        if self.model.responses.is_empty() || !self.model.response_yields(next) {
            return rate;
        }
        let back = rate.scaled(-1.0);
        let [on, off] = [&rate, &back].map(|rate| self.model.increment_of(next, rate).dissipation);
        if off > 100.0 * on { back } else { rate }
    }

    /// A limit point below the factor at which the path ends is not its greatest.
    pub(super) fn forget_lower_peak(&mut self, direction: f64) {
        let factor = self.state.factor;
        let lower = |peak: &super::trace::Peak| (factor - peak.factor) * direction > 0.0;
        if !self.model.responses.is_empty()
            && let Some(peak) = self.peak.take_if(|peak| lower(peak))
        {
            self.notes.push(format!("behind a limit point at factor {} the load rises above it again", peak.factor));
        }
    }

    /// Keeps the greatest factor between the last state and `next` as the peak, where the factor falls
    /// in the step and no earlier peak was higher. Bisects by the gaps of the points that soften in it.
    pub(super) fn softening_peak(&mut self, next: &State, falls: bool, direction: f64) {
        if !falls || self.model.responses.is_empty() {
            return;
        }
        let start = self.state.clone();
        let higher = |factor: f64, than: f64| (factor - than) * direction > 1e-12 * than.abs();
        let earlier = self.peak.as_ref().map(|peak| peak.factor);
        let Some(local) = self.model.local_of_step(&start, next) else { return };
        let (mut low, mut high) = (0.0, 1.0);
        let (mut best, mut behind) = (start.clone(), None);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let control = local.control(middle);
            let guess = between(&start, next, middle);
            let Ok((state, _)) = self.model.newton(&start, guess, &control) else { break };
            let Some(here) = self.model.rate(&start, &state, &control) else { break };
            let gain = here.factor.abs() * (high - low);
            if here.factor * direction > 0.0 {
                (low, best) = (middle, state);
                if gain <= 1e-11 * best.factor.abs().max(1e-6 * self.model.units.factor) {
                    break;
                }
            } else {
                (high, behind) = (middle, Some(here));
            }
        }
        let behind = match behind {
            Some(behind) => behind,
            None => match self.model.rate(&start, next, &local.control(1.0)) {
                Some(rate) => rate,
                None => return,
            },
        };
        if earlier.is_none_or(|earlier| higher(best.factor, earlier)) {
            if let Some(earlier) = earlier {
                self.notes.push(format!("behind a limit point at factor {earlier} the load rises above it again"));
            }
            self.peak = Some(self.peak_at(best, &behind));
        }
    }
}

/// The state a share of the way from one to another.
fn between(from: &State, to: &State, share: f64) -> State {
    let mut state = from.clone();
    for (r, end) in state.force.iter_mut().zip(&to.force) {
        (0..2).for_each(|k| r[k] += share * (end[k] - r[k]));
    }
    for (q, end) in state.motion.iter_mut().zip(&to.motion) {
        (0..3).for_each(|k| q[k] += share * (end[k] - q[k]));
    }
    state.factor += share * (to.factor - state.factor);
    state
}
