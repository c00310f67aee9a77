//! One-sided tangents: a point at its strength is stiff on one side of a state and yields or softens on the other.

use super::inelastic::update_blocks;
use super::measure::fastest;
use crate::path::newton::model::state::{State, Tangent, moved};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::model::tractions::update;
use crate::settings::SETTINGS;

/// Returns the length along a rate of size 1 for the tangents of a state: beyond the rounding of its motions.
pub fn length_ahead(system: &StepSystem, state: &State) -> f64 {
    SETTINGS.distinct() * (fastest(system, &state.motion) / system.units().displacement).max(1.0)
}

/// Returns the state with blocks and laws of tractions that have the tangents a short length ahead along a rate of size
/// 1. `None` if the laws give no stresses there.
pub fn facing_ahead(system: &mut StepSystem, state: &State, rate: &Tangent) -> Option<State> {
    let (mut facing, length) = (state.clone(), length_ahead(system, state));
    let mut ahead = moved(state, rate, length);
    update_blocks(system, &mut ahead).ok()?;
    facing.blocks = ahead.blocks;
    for (own, rate) in ahead.gap.iter_mut().zip(&rate.gap) {
        (0..2).for_each(|k| own[k] += length * rate[k]);
    }
    system.count("law_evaluations", system.laws.responses.count());
    let updates = update(&system.laws.responses, &ahead.gap, &state.updates.memory, &system.instant(state)).ok()?;
    let speed = |rate: &[f64; 2]| rate[0].hypot(rate[1]);
    let fastest = rate.gap.iter().map(speed).fold(0.0, f64::max);
    for ((own, ahead), rate) in facing.updates.points.iter_mut().zip(&updates.points).zip(&rate.gap) {
        if speed(rate) > SETTINGS.active * fastest {
            (own.tangent, own.branch) = (ahead.tangent, ahead.branch);
        }
    }
    Some(facing)
}
