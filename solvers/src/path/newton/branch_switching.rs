//! Branch switching: the rates on which points or blocks yield at a state from which no step converges.

use super::ahead::facing_ahead;
use super::control::Control;
use super::inelastic::plastic_power;
use super::state::Tangent;
use super::tangent::{modes_ahead, tangent_at, tangent_of_yielding};
use super::tracer::{Tracer, moved_along};
use crate::contact::mode::ContactMode;

/// A rate with the modes on which it starts.
type Start = (Tangent, Vec<ContactMode>);

/// Shares of a first step ahead at which the arriving rate is asked for other modes: a first step may be long for events
/// that lie close together.
const BEYOND: [f64; 3] = [1e-3, 1e-5, 1e-7];

/// The rate on which the points at their limit yield, if a small share of `rate` asks for that; the longest share first.
pub(super) fn yielding_branch(tracer: &mut Tracer, rate: &Tangent, share: f64) -> Option<Start> {
    let state = tracer.state.clone();
    let mut tried = vec![state.mode.clone()];
    for beyond in BEYOND {
        let ahead = moved_along(tracer, rate, beyond * share);
        let modes = modes_ahead(&mut tracer.system, &state, &ahead);
        if tried.contains(&modes) {
            continue;
        }
        if let Some(rate) = tangent_of_yielding(&mut tracer.system, &state, &modes) {
            return Some((rate, modes));
        }
        tried.push(modes);
    }
    None
}

/// The rate on which blocks yield that a small share of `rate` takes beyond their strength, in the sense
/// in which they dissipate. Their next predictor is that of the yielding tangent.
pub(super) fn yielding_blocks_branch(tracer: &mut Tracer, rate: &Tangent, share: f64) -> Option<Tangent> {
    let turning = facing_ahead(&mut tracer.system, &tracer.state, rate, share)?;
    if !turning.yields() {
        return None;
    }
    let other = tangent_at(&mut tracer.system, &tracer.state, &turning, &Control::Factor(tracer.state.factor))?;
    let power = plastic_power(&tracer.system, &turning, &other);
    tracer.state.blocks = turning.blocks;
    Some(other.scaled(if power < 0.0 { -1.0 } else { 1.0 }))
}
