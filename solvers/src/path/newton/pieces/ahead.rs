//! One-sided tangents: a material point at its strength is stiff on one side of a state and yields on the other.

use super::super::inelastic::update_blocks;
use super::super::state::{State, Tangent};
use super::super::system::StepSystem;
use super::super::tracer::moved;

/// A state whose blocks have the tangents of a place a short length ahead along a rate.
pub(super) fn facing_ahead(system: &mut StepSystem, state: &State, rate: &Tangent, length: f64) -> State {
    if state.blocks.iter().all(Option::is_none) {
        return state.clone();
    }
    let mut ahead = moved(state, rate, length);
    match update_blocks(system, &mut ahead) {
        Ok(()) => State { blocks: ahead.blocks, ..state.clone() },
        Err(_) => state.clone(),
    }
}
