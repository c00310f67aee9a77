//! What rounding may change of the power of a motion, where strengths are far beyond the loads or blocks far from the origin.

use super::mechanism::CentroidVelocity;
use crate::model::Joint;
use crate::model::geometry::Vec2;

/// Share of the terms of a sum that its rounding may be: a few units in the last place.
pub const ROUNDED: f64 = 4.0 * f64::EPSILON;

/// The greatest coordinate of a joint's ends.
fn reach(joint: &Joint) -> f64 {
    joint.ends.iter().map(|end| end.amax()).fold(0.0, f64::max)
}

/// By how much rounding of coordinates turns a joint, in units of the rounding of one: along it blocks slide, and loads do
/// work on that.
pub fn lie(joint: &Joint) -> f64 {
    1.0 + reach(joint) / joint.height()
}

/// By how much rounding may change the jump at a joint: that of the velocities of which it is the difference, and of the
/// coordinates that say where the joint is and how it lies.
pub fn jump_rounding(joint: &Joint, motion: &[CentroidVelocity], centroids: &[Vec2]) -> f64 {
    let of = |body: usize| {
        let [vx, vy, omega] = motion[body];
        let arm = (joint.middle() - centroids[body]).norm() + joint.height() / 2.0;
        (vx.hypot(vy) + omega.abs() * arm) * lie(joint) + omega.abs() * reach(joint)
    };
    ROUNDED * (of(joint.plus) + of(joint.minus))
}
