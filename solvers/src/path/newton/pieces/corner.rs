//! Corners of a path at which points of blocks begin or cease to yield.
//!
//! Material points have no events: Newton's method crosses such corners within a step. If a block softens or flows as a
//! whole, the path turns sharply, and a state beyond the corner is far from any predictor. Then the step ends at the
//! corner, which the law alone locates along the tangent.

use super::monitors::MAX_BISECTIONS;
use crate::path::newton::model::state::{State, Tangent, moved};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::inelastic::yielding_points;

/// Returns the length along a rate, up to `most`, at which a point of a block first begins or ceases to yield. Only blocks that
/// differ at `most` are examined between: a block that yields for a part of the step only has no lasting corner.
pub(super) fn corner(system: &mut StepSystem, state: &State, rate: &Tangent, most: f64) -> Option<f64> {
    let all: Vec<usize> = (0..state.blocks.len()).filter(|block| state.blocks[*block].is_some()).collect();
    let before = yielding_points(system, state, &all).ok()?;
    let there = yielding_points(system, &moved(state, rate, most), &all);
    let differs = |k: &usize| !there.as_ref().is_ok_and(|there| there[*k] == before[*k]);
    let (blocks, before): (Vec<usize>, Vec<usize>) =
        (0..all.len()).filter(differs).map(|k| (all[k], before[k])).unzip();
    if blocks.is_empty() {
        return None;
    }
    let (mut near, mut far) = (0.0, most);
    for _ in 0..MAX_BISECTIONS {
        let middle = 0.5 * (near + far);
        match yielding_points(system, &moved(state, rate, middle), &blocks) {
            Ok(there) if there == before => near = middle,
            _ => far = middle,
        }
    }
    Some(near)
}
