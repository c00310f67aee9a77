//! Planes with two axes.

use super::vector::Vec3;
use nalgebra::Vector2;

/// A direction with two axes across it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Axes {
    /// Unit normal n.
    pub normal: Vec3,
    /// Unit tangents s and t; (n, s, t) is right-handed.
    pub tangents: [Vec3; 2],
}

impl Axes {
    pub fn new(normal: Vec3) -> Self {
        Axes { normal, tangents: tangents(&normal) }
    }

    /// Returns the coordinates (s, t) of a point \[m\].
    pub fn flat(&self, point: &Vec3) -> Vector2<f64> {
        Vector2::new(self.tangents[0].dot(point), self.tangents[1].dot(point))
    }

    /// Returns the point with the coordinates (s, t) at a height along the normal \[m\].
    pub fn lifted(&self, flat: &Vector2<f64>, height: f64) -> Vec3 {
        self.normal * height + self.tangents[0] * flat.x + self.tangents[1] * flat.y
    }
}

/// Returns the unit tangents s and t of a unit normal, so that (n, s, t) is right-handed. s is horizontal; for a vertical
/// normal it is the x axis.
pub fn tangents(normal: &Vec3) -> [Vec3; 2] {
    // A normal within 0.06° of the vertical has no stable horizontal tangent from z × n.
    const VERTICAL: f64 = 1e-3;
    let across = Vec3::z().cross(normal);
    let s = if across.norm() > VERTICAL { across } else { Vec3::x() - normal * normal.x };
    let s = s.normalize();
    [s, normal.cross(&s)]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn frames_are_right_handed_and_orthonormal() {
        for normal in [Vec3::x(), -Vec3::z(), Vec3::z(), Vec3::new(0.3, -0.4, 0.5), Vec3::new(1e-5, 0.0, 1.0)] {
            let n = normal.normalize();
            let [s, t] = tangents(&n);
            assert!((n.cross(&s) - t).norm() < 1e-15 && (s.norm() - 1.0).abs() < 1e-15 && s.dot(&n).abs() < 1e-15);
            let axes = Axes::new(n);
            let point = Vec3::new(1.0, 2.0, 3.0);
            assert!((axes.lifted(&axes.flat(&point), n.dot(&point)) - point).norm() < 1e-14);
        }
    }
}
