//! One-sided tangents: a material point at its strength is stiff on one side of a state and yields on the other.

use super::inelastic::update_blocks;
use super::state::{State, Tangent};
use super::system::StepSystem;
use super::tracer::moved;

/// A state whose blocks have the tangents of a place a short length ahead along a rate. `None` if their stresses are not
/// found there.
pub(super) fn facing_ahead(system: &mut StepSystem, state: &State, rate: &Tangent, length: f64) -> Option<State> {
    let mut ahead = moved(state, rate, length);
    update_blocks(system, &mut ahead).ok()?;
    Some(State { blocks: ahead.blocks, ..state.clone() })
}
