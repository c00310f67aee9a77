//! Corners of a path at which points of blocks begin or cease to yield.
//!
//! Material points have no events: Newton's method crosses such corners within a step. If a block softens or flows as a
//! whole, the path turns sharply, and a state beyond the corner is far from any predictor. Then the step ends at the
//! corner, which the law alone locates along the tangent.

use super::monitors::MAX_BISECTIONS;
use crate::path::newton::model::state::{State, Tangent, moved};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::inelastic::update_blocks;

/// Returns the length along a rate, up to `most`, at which a point of a block first begins or ceases to yield.
pub(super) fn corner(system: &mut StepSystem, state: &State, rate: &Tangent, most: f64) -> Option<f64> {
    let mut yielding = |length: f64| -> Option<Vec<usize>> {
        let mut there = moved(state, rate, length);
        update_blocks(system, &mut there).ok()?;
        Some(there.blocks.iter().flatten().map(|block| block.linear.yielding).collect())
    };
    let before = yielding(0.0)?;
    let (mut near, mut far) = (0.0, most);
    if yielding(far).is_some_and(|there| there == before) {
        return None;
    }
    for _ in 0..MAX_BISECTIONS {
        let middle = 0.5 * (near + far);
        match yielding(middle) {
            Some(there) if there == before => near = middle,
            _ => far = middle,
        }
    }
    Some(near)
}
