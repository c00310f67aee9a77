//! Following a load step by its strategy: steps, cut-backs, other branches, peaks on the way.

use super::model::{Control, Model, Rate, Refusal, State};
use super::softening::MOST_REFINEMENTS;
use super::trace::{Outcome, Peak, Tracer};
use crate::contact::mode::ContactMode as Regime;
use voussoir_core::limit::Status;
use voussoir_core::path::{Increment, LoadStep, LoadStepEnd};

/// Greatest number of steps of a load step.
const MOST_STEPS: u64 = 5000;

/// Contact points up to which every change of regime counts for the length of the next step; of more the
/// same share does, so that the number of steps does not grow with the number of joints.
const ORDINARY: usize = 200;

/// Length, relative to the first step, down to which regimes guessed at a corner are tried before rates are searched.
const UNFOLLOWED: f64 = 1e-4;

/// Length, relative to the first step, from which on a line search helps. What shorter steps do not find is a corner,
/// where branches are chosen: a line search may find another state close by, on none of them.
const SEARCHED: f64 = 1e-3;

/// Movement in a step with finite displacements where the strategy sets no bound, as a share of the
/// scene's size.
const LARGEST_FINITE_STEP: f64 = 0.002;

/// Jump of λ in a step that is not one along a path with finite displacements, as a share of λ.
const JUMP: f64 = 1e-4;

/// How far a gain of λ is from those of a path whose rates at both ends of the step would give `before` and
/// `after`: a strategy that cannot turn back may step over a snap-back.
fn jump(before: f64, after: f64, gained: f64) -> f64 {
    let [low, high] = [before.min(after), before.max(after)];
    let slack = 0.5 * (high - low) + 0.5 * before.abs().max(after.abs());
    (low - slack - gained).max(gained - high - slack)
}

impl Tracer<'_, '_> {
    /// By the strategy, up to a factor or the end of the path.
    pub(super) fn follow(&mut self, load_step: &LoadStep, target: f64) -> Outcome {
        let direction = if target < load_step.start { -1.0 } else { 1.0 };
        let strategy = self.strategy.clone();
        let unit = self.model.units.factor;
        if target == self.state.factor {
            return Outcome::Reached;
        }
        let to_factor = matches!(load_step.end, LoadStepEnd::Factor(_));
        self.rose = None;
        self.model.rest(&mut self.state);
        let Some(first) = self.model.rate(&self.state, &self.state, &Control::Factor(target)) else {
            self.end(
                Status::Stalled,
                format!("at factor {} there is no rate of equilibrium under the growing load", self.state.factor),
            );
            return Outcome::Ended;
        };
        // The rate is per unit Λ of the factor.
        let mut rate = first.scaled(direction);
        let mut previous: Option<Increment> = None;
        let measure = |model: &Model, state: &State, rate: &Rate, previous: Option<&Increment>| {
            strategy.constraint(&model.increment_of(state, rate), previous).value
        };
        let weight = self.spring();
        let one = measure(&self.model, &self.state, &rate, None);
        if one.is_nan() || one <= 1e-14 * self.model.rate_size(&rate) {
            self.end(Status::Stalled, "what the continuation strategy controls does not change under this load".into());
            return Outcome::Ended;
        }
        let mut length = strategy.first_step() * one;
        if to_factor {
            // A load history: never coarser than a sixteenth of it.
            length = length.min(one * (target - self.state.factor).abs() / unit / 16.0);
        }
        let initial = length;
        let largest = match strategy.largest_step() {
            step if step.is_finite() => step,
            _ if self.model.finite() => LARGEST_FINITE_STEP,
            step => step,
        } * self.model.units.length
            / self.model.units.displacement;
        let linear = !self.model.finite() && self.model.piecewise_linear();
        let mut switched_at: Option<u64> = None;
        let mut searched_at: Option<u64> = None;
        let mut yielding: Option<Vec<Regime>> = None;
        let mut inaccurate = 0;
        let mut before_peak_rate = rate.factor * direction;
        for _ in 0..MOST_STEPS {
            let per_rate = measure(&self.model, &self.state, &rate, previous.as_ref());
            if per_rate.is_nan() || per_rate <= 0.0 {
                previous = None;
                if measure(&self.model, &self.state, &rate, None) <= 0.0 {
                    let why = "what the continuation strategy controls stopped changing".into();
                    self.no_step(&Refusal { why, restless: Vec::new() }, &rate, direction);
                    return Outcome::Ended;
                }
                continue;
            }
            let mut share = length / per_rate;
            let moves = self.model.increment_of(&self.state, &rate).motion * share;
            if moves > largest {
                share *= largest / moves;
                length = share * per_rate;
            }
            if to_factor && rate.factor != 0.0 {
                let most = (target - load_step.start).abs() / 16.0 / rate.factor.abs();
                if share > most {
                    share = most;
                    length = share * per_rate;
                }
            }
            if !strategy.passes_limit_points()
                && let Some(slip) = self.first_slip(&rate).filter(|slip| *slip < share)
            {
                share = slip.max(1e-6 * share) * (1.0 + 1e-9);
                length = share * per_rate;
            }
            let reaches = (self.state.factor + rate.factor * share - target) * direction >= -1e-12 * unit;
            let control = if reaches {
                Control::Factor(target)
            } else {
                Control::Strategy { strategy: &*strategy, previous, length }
            };
            let step = if reaches { (target - self.state.factor) / rate.factor } else { share };
            let mut guess = self.moved(&rate, step);
            if let Some(regimes) = &yielding {
                guess.regime = regimes.clone();
            }
            let mut control = control;
            self.model.searches = !self.model.finite() || length >= SEARCHED * initial;
            let mut found = self.model.newton(&self.state, guess.clone(), &control);
            // Where flow is not associated pivoting may step over a limit point: the last resort.
            let last = strategy.passes_limit_points() && length < 1e-8 * initial;
            if found.is_err() && !self.model.finite() && !reaches && (self.model.monotone() || last) {
                if strategy.passes_limit_points() {
                    let along = weight * rate.factor / unit + self.model.work_along(&rate);
                    control = Control::Spring { weight, length: step * along };
                }
                found = self.model.pivoted(&self.state, &guess, &control);
            }
            let found = found.and_then(|(next, iterations)| {
                if yielding.is_some() && next.regime == self.state.regime {
                    return Err(Refusal { why: "the step went back the way it came".into(), restless: Vec::new() });
                }
                let judged = self.judge(&rate, step, &next, target, direction, reaches);
                judged.map(|()| (next, iterations))
            });
            let found = found.and_then(|(next, iterations)| self.follows(next, iterations, &control));
            let found = match found {
                // A step by arc length may go back; one by λ cannot.
                Err(refusal)
                    if !self.model.finite()
                        && !reaches
                        && rate.factor * direction > 0.0
                        && (yielding.is_some() || last) =>
                {
                    control = Control::Factor(guess.factor);
                    let by_factor = self.model.newton(&self.state, guess.clone(), &control);
                    let judged = by_factor.and_then(|(next, iterations)| {
                        self.judge(&rate, step, &next, target, direction, false).map(|()| (next, iterations))
                    });
                    judged.map_err(|_| refusal)
                }
                found => found,
            };
            let (found, local) = match found {
                Err(refusal) => match self.softened(&rate, step, target, direction) {
                    Some((next, iterations, local)) => (Ok((next, iterations)), Some(local)),
                    None => (Err(refusal), None),
                },
                found => (found, None),
            };
            let reaches = reaches && local.is_none();
            let control = local.as_ref().map_or(control, |local| local.control(step));
            let (next, iterations) = match found {
                Ok(found) => found,
                Err(refusal) => {
                    self.model.count("cutbacks", 1);
                    let slip = self.first_slip(&rate).unwrap_or(f64::INFINITY);
                    let steps = self.model.counters.get("steps").copied();
                    if length <= 1e-7 * initial
                        && switched_at != steps
                        && let Some(other) = self.beyond_yield(&rate, 1e-5 * initial / per_rate)
                    {
                        // A block at its strength softens: the path turns where it begins to yield.
                        switched_at = steps;
                        if other.factor * direction <= 0.0 {
                            if !strategy.passes_limit_points() {
                                self.no_step(&refusal, &other, direction);
                                return Outcome::Ended;
                            }
                            if self.peak.is_none() {
                                let motion = self.scaled_motion(&self.state, &other);
                                self.peak =
                                    Some(Peak { factor: self.state.factor, state: self.recorded.clone(), motion });
                            }
                        }
                        rate = other;
                        yielding = None;
                        before_peak_rate = rate.factor * direction;
                        previous = None;
                        length = 0.1 * initial;
                        continue;
                    }
                    // With finite displacements points that open together turn the path as sharply as slip does.
                    let at_corner = self.model.finite() && length <= 1e-7 * initial;
                    if (slip <= 1e-9 * share.max(initial / per_rate) || at_corner) && switched_at != steps {
                        // At the very event: another branch, on which the points at their limit yield.
                        switched_at = steps;
                        let found = match self.onward(&rate, initial / per_rate) {
                            Ok(found) => found,
                            Err(why) => {
                                if self.peak.is_none() {
                                    let motion = self.scaled_motion(&self.state, &rate);
                                    self.peak =
                                        Some(Peak { factor: self.state.factor, state: self.recorded.clone(), motion });
                                }
                                self.end(Status::Collapse, why);
                                return Outcome::Ended;
                            }
                        };
                        if let Some((other, regimes)) = found {
                            let falls = other.factor * direction <= 0.0;
                            let state = self.state.clone();
                            let rises = if falls { self.rises(&state, direction) } else { None };
                            let (other, regimes, falls) = match rises {
                                Some((rate, regimes)) => (rate, regimes, false),
                                None => (other, regimes, falls),
                            };
                            if falls && !strategy.passes_limit_points() {
                                self.no_step(&refusal, &other, direction);
                                return Outcome::Ended;
                            }
                            if falls && self.peak.is_none() {
                                let motion = self.scaled_motion(&self.state, &other);
                                self.peak =
                                    Some(Peak { factor: self.state.factor, state: self.recorded.clone(), motion });
                            }
                            rate = other;
                            yielding = Some(regimes);
                            before_peak_rate = rate.factor * direction;
                            previous = None;
                            length = 0.1 * initial;
                            continue;
                        }
                    }
                    // Rounding must not leave the length as it is.
                    length = if slip > 1e-9 * share && slip < 0.9 * share { slip * per_rate } else { 0.3 * length };
                    // Regimes that were guessed at a corner and that no step follows: the search knows better.
                    let guessed = linear && yielding.is_some() && self.peak.is_none() && length < UNFOLLOWED * initial;
                    let unsearched = guessed && searched_at != steps;
                    if length < 1e-10 * initial || unsearched {
                        searched_at = steps;
                        let state = self.state.clone();
                        let rises = if self.peak.is_none() { self.rises(&state, direction) } else { None };
                        if let Some((other, regimes)) = rises {
                            before_peak_rate = other.factor * direction;
                            (rate, yielding) = (other, Some(regimes));
                            previous = None;
                            length = 0.1 * initial;
                            continue;
                        }
                        if unsearched && self.doubt.take().is_some() {
                            // Not decided: shorter steps may still find the way.
                            continue;
                        }
                        if linear && self.doubt.is_none() {
                            let why = self.not_followed(&refusal.why);
                            self.end(Status::LimitPoint, why);
                        } else {
                            self.no_step(&refusal, &rate, direction);
                        }
                        return Outcome::Ended;
                    }
                    continue;
                }
            };
            let accuracy = self.softening_accuracy(&next);
            if accuracy < 1.0 && inaccurate < MOST_REFINEMENTS {
                self.model.count("cutbacks", 1);
                inaccurate += 1;
                length *= accuracy.max(0.25);
                continue;
            }
            inaccurate = 0;
            let increment = self.model.increment(&self.state, &next);
            let next_rate = self.model.rate(&self.state, &next, &control);
            let Some(next_rate) = next_rate else {
                if self.cut_back(&mut length, initial, "the state has no rate", &rate, direction) {
                    return Outcome::Ended;
                }
                continue;
            };
            let steps = matches!(control, Control::Strategy { .. }) && self.model.finite() && local.is_none();
            let gained = next.factor - self.state.factor;
            let off = jump(rate.factor / per_rate * length, next_rate.factor * length, gained);
            if steps && off > JUMP * next.factor.abs().max(unit) {
                if self.cut_back(&mut length, initial, "the state jumps to another branch", &rate, direction) {
                    return Outcome::Ended;
                }
                continue;
            }
            let next_rate = match control {
                Control::Spring { length, .. } => next_rate.scaled(length.signum()),
                Control::Factor(_) => next_rate.scaled(direction),
                _ => self.onwards(&next, next_rate),
            };
            let size = next.factor.abs().max(unit * 1e-3);
            let fell = (next.factor - self.state.factor) * direction < -1e-10 * size;
            let still = 1e-10 * unit * self.model.motion_size(&next_rate);
            // With finite displacements a load that stands still is a limit point: what slides on a plane
            // does so under the same load for ever.
            let falls = next_rate.factor * direction < if self.model.finite() { still } else { -still };
            if (fell || falls) && !strategy.passes_limit_points() && !self.model.responses.is_empty() {
                if self.cut_back(&mut length, initial, "the load falls in the step", &next_rate, direction) {
                    return Outcome::Ended;
                }
                continue;
            }
            if self.peak.is_none()
                && self.model.responses.is_empty()
                && (fell || (falls && before_peak_rate > 0.0))
                && !reaches
            {
                let (state, behind) = self.locate_peak(&rate, previous, length, direction);
                if let Some((other, regimes)) = self.rises(&state, direction) {
                    // Newton's method went over to a falling branch where another one rises.
                    if !self.commit(state) {
                        return Outcome::Ended;
                    }
                    before_peak_rate = other.factor * direction;
                    (rate, yielding) = (other, Some(regimes));
                    previous = None;
                    length = 0.1 * initial;
                    continue;
                }
                self.peak = Some(self.peak_at(state, &behind));
            }
            let rises = next_rate.factor * direction > 1e-10 * unit * self.model.motion_size(&next_rate);
            if self.model.finite() && self.peak.is_some() && before_peak_rate < 0.0 && rises && !reaches {
                self.note_trough(&rate, previous, length, direction);
            }
            self.softening_peak(&next, fell || (falls && before_peak_rate > 0.0), direction);
            self.plateau(&next, &next_rate);
            before_peak_rate = next_rate.factor * direction;
            let changes = (0..next.regime.len()).filter(|c| next.regime[*c] != self.state.regime[*c]).count();
            // The same share of the joints, whatever their number.
            let changes = changes * ORDINARY / next.regime.len().max(ORDINARY);
            let softening = self.model.response_changes(&self.state, &next);
            if !self.commit(next) {
                return Outcome::Ended;
            }
            if reaches {
                if self.peak.is_some() {
                    self.notes.push(format!("after a limit point the path came back to the factor {target}"));
                }
                return Outcome::Reached;
            }
            rate = next_rate;
            yielding = None;
            if !self.model.finite() && !self.state.yields() && self.ray_ends(&rate, direction, target) {
                return Outcome::Ended;
            }
            if self.stops(load_step, direction) {
                return Outcome::Ended;
            }
            previous = Some(increment);
            let growth = match (changes, iterations) {
                (0, 0..=5) if softening > 0 => 1.5,
                (0, 0..=6) => 2.0,
                (0..=2, 0..=6) => 1.5,
                (_, 0..=12) => 1.0,
                _ => 0.5,
            };
            let growth = accuracy.clamp(0.25, growth);
            length = growth * strategy.constraint(&increment, previous.as_ref()).value;
        }
        if linear && self.peak.is_some() && self.doubt.is_none() {
            let why = self.not_followed(&format!("{MOST_STEPS} steps were not enough"));
            self.end(Status::LimitPoint, why);
            return Outcome::Ended;
        }
        let found = self.model.finite() && self.peak.is_some();
        self.end(
            if found { Status::Collapse } else { Status::Stalled },
            format!("{MOST_STEPS} steps were not enough; the last state is at factor {}: larger steps (continuation, first_step) or event_path may pass", self.state.factor),
        );
        Outcome::Ended
    }

    /// Shortens a step that converged and is none along the path; whether it is too short for that, and the
    /// path has ended.
    fn cut_back(&mut self, length: &mut f64, initial: f64, why: &str, rate: &Rate, direction: f64) -> bool {
        self.model.count("cutbacks", 1);
        *length *= 0.3;
        let ends = *length < 1e-10 * initial;
        if ends {
            self.no_step(&Refusal { why: why.into(), restless: Vec::new() }, rate, direction);
        }
        ends
    }

    /// Weight of the factor in a control by a spring: with it every step of associated flow is a
    /// monotone problem. Between weight × λ + ∂Π/∂λ and λ there must be a growing relation even with
    /// all points stuck, where ∂Π/∂λ may fall (a settlement pulls at its reaction).
    pub(super) fn spring(&mut self) -> f64 {
        let mut stuck = self.state.clone();
        stuck.regime.fill(Regime::Stick);
        let factor = stuck.factor;
        let rate = self.model.rate(&self.state, &stuck, &Control::Factor(factor));
        let work = rate.map_or(0.0, |rate| self.model.work_along(&rate) * self.model.units.factor / rate.factor);
        (-2.0 * work).max(work).max(1e-3)
    }

    pub(super) fn moved(&self, rate: &Rate, share: f64) -> State {
        let mut guess = self.state.clone();
        for (r, dr) in guess.force.iter_mut().zip(&rate.force) {
            (0..2).for_each(|k| r[k] += share * dr[k]);
        }
        for (q, dq) in guess.motion.iter_mut().zip(&rate.motion) {
            (0..3).for_each(|k| q[k] += share * dq[k]);
        }
        guess.factor += share * rate.factor;
        guess
    }

    /// Share of the rate after which the first stuck point whose slip is not associated would slide.
    pub(super) fn first_slip(&self, rate: &Rate) -> Option<f64> {
        let mut first = f64::INFINITY;
        for c in 0..self.state.gap.len() {
            let (Regime::Stick, Some(law)) = (self.state.regime[c], self.model.law(c)) else { continue };
            for f in law.facets.iter().filter(|f| f.flow != f.normal) {
                let (r, dr) = (self.state.force[c], rate.force[c]);
                let slack = f.bound * self.model.problem.contacts[c].area - f.normal[0] * r[0] - f.normal[1] * r[1];
                let speed = f.normal[0] * dr[0] + f.normal[1] * dr[1];
                if speed > 0.0 {
                    first = first.min(slack.max(0.0) / speed);
                }
            }
        }
        first.is_finite().then_some(first)
    }

    /// Whether a converged step is one along the path.
    pub(super) fn judge(
        &mut self,
        rate: &Rate,
        share: f64,
        next: &State,
        target: f64,
        direction: f64,
        reaches: bool,
    ) -> Result<(), Refusal> {
        let no = |why: &str| Err(Refusal { why: why.into(), restless: Vec::new() });
        if !reaches && (next.factor - target) * direction > 0.0 {
            return no("the step went beyond the factor asked for");
        }
        let u = self.model.units;
        let (mut along, mut size) = (0.0, 0.0);
        let mut force_jump = 0.0;
        for c in 0..next.gap.len() {
            for k in 0..2 {
                let moved = (next.gap[c][k] - self.state.gap[c][k]) / u.displacement;
                along += moved * rate.gap[c][k] / u.displacement;
                size += moved * moved;
                force_jump += ((next.force[c][k] - self.state.force[c][k]) / u.force).powi(2);
            }
        }
        for b in 0..next.motion.len() {
            for k in 0..3 {
                let unit = if k == 2 { u.displacement / u.length } else { u.displacement };
                let moved = (next.motion[b][k] - self.state.motion[b][k]) / unit;
                along += moved * rate.motion[b][k] / unit;
                size += moved * moved;
            }
        }
        along += (next.factor - self.state.factor) * rate.factor / (u.factor * u.factor);
        // Where a block softens the path may snap back sharply: what dissipates does not go back.
        if along <= 0.0 && self.model.plastic_work(&self.state, next) <= 1e-9 * size {
            return no("the step turned back");
        }
        // Friction that is not associated: several states may belong to one load. A state far from
        // what both ends' rates can reach is another branch.
        let slides = (0..next.regime.len()).any(|c| {
            next.regime[c] != self.state.regime[c] && self.model.law(c).is_some_and(|law| law.is_non_associated())
        });
        if slides && !self.strategy.passes_limit_points() {
            let after = self.model.rate(&self.state, next, &Control::Factor(next.factor));
            let Some(after) = after else { return no("the state has no rate under growing load") };
            let before = self.model.rate_size(rate) * share;
            let after = self.model.rate_size(&after) * (next.factor - self.state.factor).abs() / u.factor;
            let jump = (size + force_jump).sqrt();
            if jump > 2.0 * (before + after) {
                return no("the state jumps to another branch");
            }
        }
        Ok(())
    }
}
