//! What ends a path: limit points and peaks, mechanisms, rays, and how far it was asked to go.

use super::super::continuation::arc_length::ArcLength;
use super::model::{Control, Rate, Refusal, State, load_size};
use super::rising::Rising;
use super::trace::{Peak, Tracer};
use crate::contact::mode::ContactMode as Regime;
use voussoir_core::limit::Status;
use voussoir_core::path::{Continuation, Increment, LoadStep};

/// Share of its fall by which the load must rise for the least one to be that of a snap-through.
const RISES: f64 = 0.1;

impl Tracer<'_, '_> {
    /// No step is small enough: a limit point for strategies that cannot pass one, else a stall.
    pub(super) fn no_step(&mut self, refusal: &Refusal, rate: &Rate, direction: f64) {
        let points: Vec<String> = refusal
            .restless
            .iter()
            .take(6)
            .map(|&c| format!("{c} of joint {}", self.model.problem.contacts[c].joint))
            .collect();
        let who = if points.is_empty() { String::new() } else { format!(" (contact points {})", points.join(", ")) };
        let why = format!("no step from factor {} converges: {}{who}", self.state.factor, refusal.why);
        let falls = rate.factor * direction <= 0.0;
        if self.model.finite() && self.peak.is_some() {
            self.end(Status::Collapse, format!("the branch behind the peak was not followed further: {why}"));
            return;
        }
        if !self.strategy.passes_limit_points()
            && (falls || self.softens_down(rate, direction) || self.turns_back(rate, direction))
        {
            self.doubted(&self.state.clone(), direction);
            self.end(Status::LimitPoint, format!("{why}; the path goes on with a factor that does not grow"));
        } else {
            self.end(Status::Stalled, why);
            self.notes.extend(self.doubt.take().map(|doubt| format!("at its last state {doubt}")));
        }
    }

    /// Whether the path goes on with a factor that does not grow.
    pub(super) fn turns_back(&mut self, rate: &Rate, direction: f64) -> bool {
        let arc = ArcLength::default();
        let size = arc.constraint(&self.model.increment_of(&self.state, rate), None).value;
        for exponent in [-2, -3, -4, -6] {
            let length = size * 10f64.powi(exponent);
            let control = Control::Strategy { strategy: &arc, previous: None, length };
            let guess = self.moved(rate, 10f64.powi(exponent));
            if let Ok((next, _)) = self.model.newton(&self.state, guess, &control) {
                if self.stands_still(&next) {
                    return true;
                }
                let Some(after) = self.model.rate(&self.state, &next, &control) else { continue };
                if after.factor * direction <= 1e-9 * self.model.units.factor * self.model.motion_size(&after) {
                    return true;
                }
            }
        }
        false
    }

    /// Looks, with small displacements, for a rate with growing λ where there should be none. Where that
    /// is not decided, or not gone on with, the limit point is not proven. Where blocks flow, combinations
    /// of regimes say nothing of their Gauss points: there the path itself shows its limit point.
    pub(super) fn doubted(&mut self, state: &State, direction: f64) -> Option<(Rate, Vec<Regime>)> {
        if self.model.finite() || !self.model.responses.is_empty() || state.yields() {
            return None;
        }
        match self.model.rising(state, direction) {
            Rising::None => {
                self.doubt = None;
                self.proven = Some(state.factor);
            }
            Rising::Unknown(why) => self.doubt = Some(why),
            Rising::Rate(rate, regimes) => {
                self.doubt = Some("there is a rate on which the load grows".into());
                return Some((rate, regimes));
            }
        }
        None
    }

    /// Bisects the step from the present state for the point where λ stops growing in the sense `direction`:
    /// the state there and the rate just behind it.
    pub(super) fn locate_peak(
        &mut self,
        rate: &Rate,
        previous: Option<Increment>,
        length: f64,
        direction: f64,
    ) -> (State, Rate) {
        let strategy = self.strategy.clone();
        let per_rate = strategy.constraint(&self.model.increment_of(&self.state, rate), previous.as_ref()).value;
        let (mut low, mut high) = (0.0, length);
        let mut best = (self.state.clone(), rate.clone());
        let mut behind = rate.clone();
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            let control = Control::Strategy { strategy: &*strategy, previous, length: middle };
            let guess = self.moved(rate, middle / per_rate);
            let Ok((state, _)) = self.model.newton(&self.state, guess, &control) else { break };
            let Some(here) = self.model.rate(&self.state, &state, &control) else { break };
            if here.factor * direction > 0.0 {
                low = middle;
                best = (state, here);
            } else {
                high = middle;
                behind = here;
            }
            let gain = best.1.factor.abs() * (high - low);
            if low > 0.0 && gain <= 1e-11 * best.0.factor.abs().max(1e-6 * self.model.units.factor) {
                break;
            }
        }
        (best.0, behind)
    }

    /// Where the load rises again behind a peak with finite displacements: the least load between, if it is
    /// lower than any before and the path has not risen by much since.
    pub(super) fn note_trough(&mut self, rate: &Rate, previous: Option<Increment>, length: f64, direction: f64) {
        let lower = |factor: f64| self.trough.as_ref().is_none_or(|lowest| (lowest.factor - factor) * direction > 0.0);
        if !self.risen && lower(self.state.factor) {
            let (state, behind) = self.locate_peak(rate, previous, length, -direction);
            self.trough = Some(self.peak_at(state, &behind));
        }
    }

    /// A peak at a state between the last one and the next, with the rate just behind it.
    pub(super) fn peak_at(&mut self, mut state: State, behind: &Rate) -> Peak {
        let slopes = self.model.slopes(&state);
        let mut ledger = self.ledger;
        ledger.add(&self.model, &self.state, &state, [&self.slopes, &slopes]);
        let start = self.state.clone();
        self.model.keep(&start, &mut state);
        let recorded = ledger.recorded(&self.model, self.load_step, &state, &slopes);
        let motion = self.scaled_motion(&state, behind);
        Peak { factor: state.factor, state: recorded, motion }
    }

    /// Velocities with p·q̇ = 1; of settlements with finite displacements, which do no work, with 1 m of
    /// the fastest body's speed. `None` where the load does next to no work on them: rates are checked
    /// to 1e-8 of their size, so less work than a hundred times that proves nothing.
    pub(super) fn scaled_motion(&self, state: &State, rate: &Rate) -> Option<Vec<[f64; 3]>> {
        let u = self.model.units;
        let load = load_size(self.model.problem, self.model.loaded.growing);
        let power = self.model.increment_of(state, rate).displacement * u.displacement * load;
        let size = self.model.motion_size(rate) * u.displacement * u.force / u.factor;
        let by = if load == 0.0 && self.model.finite() {
            rate.motion.iter().map(|q| q[0].hypot(q[1]).max(q[2].abs() * u.length)).fold(0.0, f64::max)
        } else if power > 1e-6 * size {
            power
        } else {
            0.0
        };
        (by > 0.0).then(|| rate.motion.iter().map(|q| q.map(|x| x / by)).collect())
    }

    /// Whether the rate goes on for ever: collapse, or a ray that carries any load.
    pub(super) fn ray_ends(&mut self, rate: &Rate, direction: f64, target: f64) -> bool {
        let u = self.model.units;
        let motion = self.model.motion_size(rate);
        let force = rate.force.iter().flatten().map(|r| (r / u.force).abs()).fold(0.0, f64::max);
        let factor = rate.factor / u.factor * direction;
        let still = force <= 1e-9 * motion && factor.abs() <= 1e-9 * motion;
        let force_unit = if still { f64::INFINITY } else { force.max(factor.abs()) * u.force };
        let goes_on = (0..rate.gap.len()).all(|c| {
            let Some(law) = self.model.law(c) else { return true };
            let gap = rate.gap[c].map(|g| g / (u.displacement * motion));
            let r = rate.force[c].map(|r| r / force_unit);
            law.ray_violation(self.state.regime[c], r, gap) <= 1e-8
        });
        // The regimes may leave other motions than this one.
        let other = if still && !goes_on { self.model.mechanism(&self.state) } else { None };
        if !goes_on && other.is_none() {
            return false;
        }
        let rate = other.as_ref().unwrap_or(rate);
        if !self.model.responses_go_on(&self.state, rate) {
            return false;
        }
        self.forget_lower_peak(direction);
        if still {
            self.motion = self.scaled_motion(&self.state, rate);
            if self.motion.is_none() {
                return false;
            }
            self.end(if self.peak.is_some() { Status::LimitPoint } else { Status::Collapse }, String::new());
            if self.peak.is_some() {
                self.notes.push(format!(
                    "behind the limit point the path ends in a mechanism at factor {}",
                    self.state.factor
                ));
            }
            return true;
        }
        // What strengths bound is no ray: the facets have been looked at above with the ray's forces, and no
        // block that may yield carries any load.
        if target.is_infinite() && !self.model.problem.yields() && factor > 1e-9 * (motion + force) {
            self.ray = Some(rate.force.iter().map(|r| r.map(|x| x / rate.factor)).collect());
            self.end(if self.peak.is_some() { Status::LimitPoint } else { Status::Unbounded }, String::new());
            if self.peak.is_some() {
                self.notes.push(format!(
                    "behind the limit point the load grows without bound from factor {}",
                    self.state.factor
                ));
            }
            return true;
        }
        false
    }

    /// Whether the path went as far behind its peak as was asked for.
    pub(super) fn stops(&mut self, load_step: &LoadStep, direction: f64) -> bool {
        let (factor, displacement) = (self.state.factor, self.recorded.displacement);
        let Some(peak) = &self.peak else {
            if self.model.finite() && displacement.abs() > self.model.units.length {
                self.end(Status::Stalled, format!("no peak up to a displacement of {displacement} m, factor {factor}"));
                return true;
            }
            return false;
        };
        if !self.model.responses.is_empty() && (factor - peak.factor) * direction > 0.0 {
            return false;
        }
        let behind = (displacement - peak.state.displacement).abs();
        if let Some(trough) = &self.trough {
            self.risen |= (factor - trough.factor) * direction > RISES * (peak.factor - trough.factor).abs();
        }
        let (stop_displacement, stop_factor) = (self.settings.stop_displacement, self.settings.stop_factor);
        let done = match (stop_displacement, stop_factor) {
            (None, None) => {
                let grown = (peak.factor - load_step.start).abs();
                (peak.factor - factor) * direction >= 0.1 * grown || behind >= peak.state.displacement.abs()
            }
            (most, least) => {
                most.is_some_and(|most| behind >= most)
                    || least.is_some_and(|least| (factor - least) * direction <= 0.0)
            }
        };
        if !done && self.model.finite() {
            let asked = stop_displacement.unwrap_or(match stop_factor {
                Some(_) => self.model.units.length,
                None => peak.state.displacement.abs(),
            });
            let place = [displacement, factor];
            if let Some(why) =
                self.wandering.leads_nowhere(place, &self.recorded.motion, asked, self.model.units.length)
            {
                self.end(Status::Collapse, why);
                return true;
            }
        }
        if done {
            self.end(if self.model.finite() { Status::Collapse } else { Status::LimitPoint }, String::new());
        }
        done
    }
}
