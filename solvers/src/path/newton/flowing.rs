//! Paths on which blocks flow as a whole: the load stands still while what flows moves on.
//!
//! A perfectly plastic block crushed over a whole section carries no more, whatever it is shortened by: its
//! tangent has no inverse, and under a given load there is no next state. In steps of motion or of dissipation the
//! path goes on as a plateau, and its first state is the limit point.

use super::model::{Rate, State};
use super::trace::Tracer;

/// Change of the factor, relative to it, below which it stands still.
const STILL: f64 = 1e-8;
/// The same relative to the motion of the step, both in units of the load: elastic steps have 1.
const FLAT: f64 = 1e-5;

impl Tracer<'_, '_> {
    /// Whether blocks yield in the step to `next` while the factor stands still.
    pub(super) fn stands_still(&self, next: &State) -> bool {
        let change = (next.factor - self.state.factor).abs();
        let motion = self.model.increment(&self.state, next).motion;
        next.yields() && change <= STILL * next.factor.abs() && change / self.model.units.factor <= FLAT * motion
    }

    /// Keeps the first state on a plateau as the limit point.
    pub(super) fn plateau(&mut self, next: &State, rate: &Rate) {
        if self.peak.is_none() && self.model.problem.yields() && self.stands_still(next) {
            let peak = self.peak_at(next.clone(), rate);
            self.notes.push(format!("at factor {} blocks flow and the load stands still", peak.factor));
            self.peak = Some(peak);
        }
    }
}
