//! Where blocks come to lie when a mechanism's velocities go on for a while.

use voussoir_core::model::Assembly;
use voussoir_core::model::geometry::Vec2;
use voussoir_study::results::MotionEntry;

/// Shift along and across a unit velocity whose direction turns by `angle` in unit time: a circular arc.
fn arc(angle: f64) -> [f64; 2] {
    if angle.abs() < 1e-6 {
        return [1.0, angle / 2.0];
    }
    let half = (angle / 2.0).sin();
    [angle.sin() / angle, 2.0 * half * half / angle]
}

/// A finite rigid motion: rotation by an angle about a centre, then a shift. `writers/page/draw.js` evaluates the same
/// formula; `placements.json` holds values that both must give.
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
        let [along, across] = arc(angle);
        let shift = Vec2::new(along * x - across * y, across * x + along * y) * scale;
        Placement { centre, angle, shift }
    }

    /// The placement after a rotation about `centre` and a shift.
    pub fn of_displacement(centre: Vec2, [x, y, angle]: [f64; 3]) -> Self {
        Placement { centre, angle, shift: Vec2::new(x, y) }
    }

    /// The velocity (v at the centre, ω) that leads to this placement in unit time, for less than a full turn.
    pub fn twist(&self) -> [f64; 3] {
        let [along, across] = arc(self.angle);
        let square = along * along + across * across;
        let shift = self.shift / square;
        [along * shift.x + across * shift.y, along * shift.y - across * shift.x, self.angle]
    }

    /// The placement after a share of the time.
    pub fn at_share(&self, share: f64) -> Self {
        if *self == Placement::rest() { *self } else { Placement::of_velocity(self.centre, self.twist(), share) }
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Centre, twist, point and its place: matrix exponentials of 40 digits. `.ci/page` evaluates the same table with
    /// the page's script.
    const TABLE: &str = include_str!("placements.json");

    #[test]
    fn placements_are_those_of_the_table() {
        let table: Vec<[Vec<f64>; 4]> = serde_json::from_str(TABLE).expect("the table");
        assert!(table.len() > 20);
        for [centre, twist, point, place] in table {
            let [centre, point, place] = [centre, point, place].map(|at| Vec2::new(at[0], at[1]));
            let placement = Placement::of_velocity(centre, [twist[0], twist[1], twist[2]], 1.0);
            assert!((placement.of(point) - place).norm() < 1e-12, "{twist:?}");
            let again = placement.twist();
            assert!(again.iter().zip(&twist).all(|(a, b)| (a - b).abs() < 1e-12), "{again:?} {twist:?}");
        }
    }

    /// Blocks with the same velocity field keep their distance and form, however far they go.
    #[test]
    fn blocks_that_move_as_one_stay_one() {
        let (pole, spin) = (Vec2::new(-3.0, 2.0), 0.7);
        let field = |at: Vec2| [-spin * (at.y - pole.y), spin * (at.x - pole.x), spin];
        let joint = Vec2::new(1.0, 5.0);
        let [a, b] = [Vec2::new(0.5, 4.0), Vec2::new(2.0, 5.5)]
            .map(|centre| Placement::of_velocity(centre, field(centre), 1.5).of(joint));
        assert!((a - b).norm() < 1e-14);
        assert!(((a - pole).norm() - (joint - pole).norm()).abs() < 1e-14);
    }
}
