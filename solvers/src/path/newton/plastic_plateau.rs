//! Paths on which blocks flow as a whole: the load stands still while what flows moves on.
//!
//! A perfectly plastic block crushed over a whole section carries no more, whatever it is shortened by: its
//! tangent has no inverse, and under a given load there is no next state. In steps of motion or of dissipation the
//! path goes on as a plateau, and its first state is the limit point.

use super::measure::increment_between;
use super::peak::peak_at;
use super::state::{State, Tangent};
use super::tracer::Tracer;

/// Change of the factor, relative to it, below which it stands still.
const STILL: f64 = 1e-8;

/// The same relative to the motion of the step, both in units of the load: elastic steps have 1.
const FLAT: f64 = 1e-5;

/// Whether blocks yield in the step to `next` while the factor stands still.
pub(super) fn stands_still(tracer: &Tracer, next: &State) -> bool {
    let change = (next.factor - tracer.state.factor).abs();
    let motion = increment_between(&tracer.system, &tracer.state, next).motion;
    next.yields() && change <= STILL * next.factor.abs() && change / tracer.system.units().factor <= FLAT * motion
}

/// Keeps the first state on a plateau as the limit point.
pub(super) fn note_plateau(tracer: &mut Tracer, next: &State, rate: &Tangent) {
    if tracer.limit.peak.is_none() && tracer.system.problem.yields() && stands_still(tracer, next) {
        let peak = peak_at(tracer, next.clone(), rate);
        tracer.record.notes.push(format!("at factor {} blocks flow and the load stands still", peak.factor));
        tracer.limit.peak = Some(peak);
    }
}
