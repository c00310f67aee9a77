//! Corners of the path (small displacements, laws of facets): which way it goes on where several points
//! change at once, and steps that only seem to follow it.
//!
//! With flow that is not associated the regimes that a step asks for at a corner may be those of no solution: whatever
//! its length, a point slips against its friction. A step so short that this is below the tolerance of the law
//! would still pass for converged, and the next, as short, again: the path would creep along what is no solution
//! of its rates. Such a step is refused: what it violates grows in proportion to it. Where a guess of the regimes at
//! a corner is followed by no step, the rates are searched to their end instead (`rising`).

use super::model::{Control, Model, Rate, Refusal, State};
use super::trace::Tracer;
use crate::contact::mode::ContactMode as Regime;

/// Violations below this share of the greatest force are rounding.
const ROUNDING: f64 = 1e-14;
/// Violations below this share of what the step adds to a point's own force change nothing.
const MATTERS: f64 = 1e-3;
/// Branches with growing λ that are taken at one factor.
const MOST_BRANCHES: u32 = 3;
/// What another step like the last adds to its violation, relative to it, where the step creeps.
const GROWTH: [f64; 2] = [0.3, 3.0];

impl Model<'_> {
    /// The contact point, if any, whose law a step violates, within the tolerance, in proportion to its
    /// length: with the rate of the regimes at its end the violation grows by as much again.
    fn creeps(&mut self, start: &State, next: &State, control: &Control) -> Option<usize> {
        if self.finite() || !self.piecewise_linear() || self.monotone() {
            return None;
        }
        let largest = next.force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
        let violation = |model: &Self, c: usize, ahead: Option<(&Rate, f64)>| {
            let Some(law) = model.law(c) else { return 0.0 };
            let rho = model.stiffness(c);
            let gap = model.step_gap(start, next, c);
            let z = [0, 1].map(|k| {
                let more = ahead.map_or(0.0, |(rate, share)| share * (rate.force[c][k] - rho[k] * rate.gap[c][k]));
                next.force[c][k] - rho[k] * gap[k] + more
            });
            law.violation(next.regime[c], z, rho, model.problem.contacts[c].area)
        };
        let violated: Vec<(usize, f64)> = (0..next.gap.len())
            .map(|c| (c, violation(self, c, None)))
            .filter(|&(c, now)| {
                let [n, t] = [0, 1].map(|k| next.force[c][k] - start.force[c][k]);
                now > (ROUNDING * largest).max(MATTERS * n.hypot(t))
            })
            .collect();
        if violated.is_empty() {
            return None;
        }
        let rate = self.rate(start, next, control)?;
        let (whole, step) = (self.increment_of(next, &rate), self.increment(start, next));
        let size = whole.motion.hypot(whole.factor);
        if size.is_nan() || size <= 0.0 {
            return None;
        }
        let along: f64 =
            (0..next.gap.len()).flat_map(|c| [0, 1].map(|k| (next.gap[c][k] - start.gap[c][k]) * rate.gap[c][k])).sum();
        let share = (step.motion.hypot(step.factor) / size).copysign(along);
        let grows = |&(c, now): &(usize, f64)| {
            let more = violation(self, c, Some((&rate, share))) / now - 1.0;
            (GROWTH[0]..=GROWTH[1]).contains(&more)
        };
        violated.into_iter().find(grows).map(|(c, _)| c)
    }

    /// ρ of a contact point: the inverse of its own compliance \[N/m\].
    pub(super) fn stiffness(&self, contact: usize) -> [f64; 2] {
        let mean = self.units.displacement / self.units.force;
        self.compliance[contact].map(|own| 1.0 / if own > 1e-9 * mean { own } else { mean })
    }
}

impl Tracer<'_, '_> {
    /// Refuses a converged step that creeps.
    pub(super) fn follows(&mut self, next: State, iterations: u64, control: &Control) -> Result<(State, u64), Refusal> {
        let start = self.state.clone();
        match self.model.creeps(&start, &next, control) {
            None => Ok((next, iterations)),
            Some(c) => {
                self.model.count("creeping_steps", 1);
                let why = "a contact point slips against its friction, however short the step";
                Err(Refusal { why: why.into(), restless: vec![c] })
            }
        }
    }

    /// Why the path ends at a proven limit point, or behind it.
    pub(super) fn not_followed(&self, why: &str) -> String {
        match &self.peak {
            None => format!("the path was not followed behind it: {why}"),
            Some(_) => format!("behind it the path was followed to factor {} only: {why}", self.state.factor),
        }
    }

    /// A branch with growing λ, where there should be none; a few times at most at one factor. Otherwise
    /// the limit point is proven, or in doubt.
    pub(super) fn rises(&mut self, state: &State, direction: f64) -> Option<(Rate, Vec<Regime>)> {
        let other = self.doubted(state, direction)?;
        let same = |factor: f64| (state.factor - factor) * direction <= 1e-10 * factor.abs();
        let times = match self.rose {
            Some((factor, times)) if same(factor) => times + 1,
            _ => 1,
        };
        if times > MOST_BRANCHES {
            return None;
        }
        self.rose = Some((state.factor, times));
        self.doubt = None;
        self.model.count("branches", 1);
        Some(other)
    }

    /// The rate on which the points at their limit yield, where a small share of `rate` asks for that.
    pub(super) fn yielding(&mut self, rate: &Rate, share: f64) -> Option<(Rate, Vec<Regime>)> {
        let ahead = self.moved(rate, 1e-3 * share);
        let state = self.state.clone();
        let regimes = self.model.regimes_ahead(&state, &ahead);
        if regimes == state.regime {
            return None;
        }
        self.model.rate_of_yielding(&state, &regimes).map(|rate| (rate, regimes))
    }

    /// The rate on which blocks yield that a small share of `rate` takes beyond their strength, in the sense
    /// in which they dissipate. Their next predictor is that of the yielding tangent.
    pub(super) fn beyond_yield(&mut self, rate: &Rate, share: f64) -> Option<Rate> {
        let mut ahead = self.moved(rate, share);
        self.model.deform(&mut ahead).ok()?;
        let mut turning = self.state.clone();
        turning.blocks = ahead.blocks;
        if !turning.yields() {
            return None;
        }
        let other = self.model.rate(&self.state, &turning, &Control::Factor(self.state.factor))?;
        let power = self.model.plastic_power(&turning, &other);
        self.state.blocks = turning.blocks;
        Some(other.scaled(if power < 0.0 { -1.0 } else { 1.0 }))
    }
}
