//! Force resultants about the origin.

use super::geometry::{Vec2, cross};

/// Force resultants on bodies, each \[F_x, F_y, moment about the origin\] in \[N, N m\].
pub type Wrenches = Vec<[f64; 3]>;

/// Adds a force at a point to a wrench about the origin.
pub fn add_force(wrench: &mut [f64; 3], point: Vec2, force: Vec2, factor: f64) {
    wrench[0] += factor * force.x;
    wrench[1] += factor * force.y;
    wrench[2] += factor * cross(point, force);
}
