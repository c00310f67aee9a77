//! Where blocks come to lie when a mechanism's velocities go on for a while.

use crate::results::MotionEntry;
use voussoir_core::model::Assembly;
use voussoir_core::model::geometry::Vec2;

/// A finite rigid motion: rotation by an angle about a centre, then a shift.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    centre: Vec2,
    angle: f64,
    shift: Vec2,
}

impl Placement {
    /// No motion.
    pub fn rest() -> Self {
        Placement { centre: Vec2::zeros(), angle: 0.0, shift: Vec2::zeros() }
    }

    /// A constant velocity (v at `centre`, ω) kept for the time `scale`: exact for any angle, so
    /// that blocks keep their size and blocks that move as one stay one.
    pub fn of_velocity(centre: Vec2, [x, y, spin]: [f64; 3], scale: f64) -> Self {
        let angle = spin * scale;
        let (a, b) =
            if angle.abs() < 1e-6 { (1.0, angle / 2.0) } else { (angle.sin() / angle, (1.0 - angle.cos()) / angle) };
        let shift = Vec2::new(a * x - b * y, b * x + a * y) * scale;
        Placement { centre, angle, shift }
    }

    /// The same, then a turn by `angle` about `pivot` and a shift.
    pub fn then(&self, pivot: Vec2, angle: f64, shift: Vec2) -> Self {
        let turn = Placement { centre: pivot, angle, shift };
        Placement {
            centre: self.centre,
            angle: self.angle + angle,
            shift: turn.of(self.centre + self.shift) - self.centre,
        }
    }

    /// Where a point of the body comes to lie \[m\].
    pub fn of(&self, point: Vec2) -> Vec2 {
        let (sin, cos) = self.angle.sin_cos();
        let from = point - self.centre;
        self.centre + self.shift + Vec2::new(cos * from.x - sin * from.y, sin * from.x + cos * from.y)
    }
}

/// Placements of all bodies, exaggerated so that the farthest vertex moves by about 12 % of the
/// scene's size (less where a block would turn by more than 0.4 rad), and the factor on the
/// motion; `None` where nothing moves.
pub fn displaced(assembly: &Assembly, motion: &[MotionEntry]) -> Option<(Vec<Placement>, f64)> {
    let by_name: std::collections::HashMap<&str, [f64; 3]> =
        motion.iter().map(|entry| (entry.body.as_str(), entry.velocity)).collect();
    let velocity = |body: usize| by_name.get(assembly.bodies[body].name.as_str()).copied().unwrap_or([0.0; 3]);
    let (mut farthest, mut fastest): (f64, f64) = (0.0, 0.0);
    for (index, body) in assembly.bodies.iter().enumerate() {
        let (centre, [x, y, spin]) = (assembly.inertia(index).centroid, velocity(index));
        for vertex in &body.vertices {
            let from = vertex - centre;
            farthest = farthest.max((x - spin * from.y).hypot(y + spin * from.x));
        }
        fastest = fastest.max(spin.abs());
    }
    if farthest <= 0.0 || !farthest.is_finite() {
        return None;
    }
    let scale = (0.12 * assembly.size() / farthest).min(0.4 / fastest.max(1e-300));
    let place = |body: usize| {
        let centre = assembly.inertia(body).centroid;
        if by_name.contains_key(assembly.bodies[body].name.as_str()) && velocity(body) != [0.0; 3] {
            Placement::of_velocity(centre, velocity(body), scale)
        } else {
            Placement::rest()
        }
    };
    Some(((0..assembly.bodies.len()).map(place).collect(), scale))
}
