//! Effect of rounding on the power of a motion, for strengths far above the loads or blocks far from the origin.

use super::mechanism::CentroidVelocity;
use crate::model::Joint;
use crate::model::geometry::Vec2;

/// Rounding error of a sum as a share of its terms: a few units in the last place.
pub const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// Returns the greatest coordinate of the ends of a joint.
fn reach(joint: &Joint) -> f64 {
    joint.ends.iter().map(|end| end.amax()).fold(0.0, f64::max)
}

/// Returns the rotation of a joint from rounding of its coordinates, in units of the rounding of one. Blocks slide
/// along the joint, so loads do work on this rotation.
pub fn lie(joint: &Joint) -> f64 {
    1.0 + reach(joint) / joint.height()
}

/// Returns the possible rounding error of the jump at a joint: of the velocities whose difference it is, and of the
/// coordinates of the position and direction of the joint.
pub fn jump_rounding(joint: &Joint, motion: &[CentroidVelocity], centroids: &[Vec2]) -> f64 {
    let of = |body: usize| {
        let [vx, vy, omega] = motion[body];
        let arm = (joint.middle() - centroids[body]).norm() + joint.height() / 2.0;
        (vx.hypot(vy) + omega.abs() * arm) * lie(joint) + omega.abs() * reach(joint)
    };
    ROUNDED * (of(joint.plus) + of(joint.minus))
}
