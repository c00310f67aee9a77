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

/// Violations below this share of the greatest force are rounding.
const ROUNDING: f64 = 1e-14;
/// Violations below this share of what the step adds to a point's own force change nothing.
const MATTERS: f64 = 1e-3;
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
}
