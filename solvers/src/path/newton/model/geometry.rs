//! Rigid motions, frames of contact points and forces in the axes of a body.

use super::blocks::YieldingBlock;
use super::loads::Loads;
use crate::linear::blocks::Pattern;
use nalgebra::Matrix2;
use std::sync::Arc;
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::path::{Contact, PathProblem};

/// A contact point on an elastic body.
#[derive(Debug, Clone, Copy)]
pub struct Side {
    pub contact: usize,
    pub sign: f64,
    pub slot: usize,
}

/// Point at which derivatives are computed: contact forces, motions, loads, and the yielding bodies.
#[derive(Clone, Copy)]
pub struct Place<'a> {
    pub force: &'a [[f64; 2]],
    pub motion: &'a [[f64; 3]],
    pub loads: &'a Loads<'a>,
    pub blocks: &'a [Option<YieldingBlock>],
}

/// A contact point after rigid motions of its bodies.
pub struct Frame {
    /// R⁺ξ⁺ and R⁻ξ⁻.
    pub arms: [Vec2; 2],
    /// x⁺ − x⁻.
    pub jump: Vec2,
    /// e_n and e_t.
    pub axes: [Vec2; 2],
    /// β and its derivatives by the slip in the mean axes.
    pub share: [f64; 3],
    /// θ⁺ − θ⁻.
    pub turn: f64,
}

impl Frame {
    /// Returns the mean axes: the axes turned back by β.
    pub fn mean(&self) -> [Vec2; 2] {
        let back = rotation((0.5 - self.share[0]) * self.turn);
        self.axes.map(|e| back * e)
    }
}

/// The rotation of a body.
#[derive(Debug, Clone, Copy)]
struct Turn {
    angle: f64,
    rotation: Matrix2<f64>,
    /// Sine of half the angle.
    half: f64,
}

impl Turn {
    fn by(angle: f64) -> Self {
        Turn { angle, rotation: rotation(angle), half: (0.5 * angle).sin() }
    }
}

/// Frames of contact points in order. Sines and cosines of a joint are computed once.
pub struct Frames<'m> {
    geometry: &'m Geometry<'m>,
    motion: &'m [[f64; 3]],
    turns: Vec<Turn>,
    /// The last angles of the axes and of the mean axes, with their rotations.
    last: [(f64, Matrix2<f64>); 2],
}

impl Frames<'_> {
    /// Returns the rotation by an angle, reused for equal angles; the identity with small displacements.
    fn turn(&mut self, which: usize, angle: f64) -> Matrix2<f64> {
        if self.last[which].0 != angle {
            self.last[which] = (angle, self.geometry.turn(angle));
        }
        self.last[which].1
    }

    /// Returns the displacement of a point of a body by its rigid motion.
    fn rigid(&self, body: usize, point: Vec2) -> Vec2 {
        self.geometry.displaced(body, point, self.motion[body], &self.turns[body])
    }

    /// Returns the frame of a contact point.
    pub fn of(&mut self, contact: usize) -> Frame {
        let geometry = self.geometry;
        let c = &geometry.problem.contacts[contact];
        let (minus, plus) = (c.minus.body, c.plus.body);
        let (low, high) = (self.turns[minus].angle, self.turns[plus].angle);
        let arm = |body: usize| self.turns[body].rotation * (c.position - geometry.problem.bodies[body].pole);
        let arms = [arm(plus), arm(minus)];
        let jump = self.rigid(plus, c.position) - self.rigid(minus, c.position);
        let turn = high - low;
        let mut share = [c.sliding.share, 0.0, 0.0];
        if geometry.finite && c.sliding.passing != 0.0 {
            let middle = self.turn(1, low + 0.5 * turn) * c.tangent;
            share = c.sliding.share_at(middle.dot(&jump));
        }
        let axes = self.turn(0, low + share[0] * turn);
        Frame { arms, jump, axes: [axes * c.normal, axes * c.tangent], share, turn }
    }
}

/// Geometry of a problem for the path solver.
pub struct Geometry<'a> {
    pub problem: &'a PathProblem,
    pub finite: bool,
    /// Contact points of every body.
    pub sides: Vec<Vec<Side>>,
    /// Contact points by joints; joints on the same elastic body are coupled.
    pub pattern: Arc<Pattern>,
}

fn rotation(angle: f64) -> Matrix2<f64> {
    let (sine, cosine) = angle.sin_cos();
    Matrix2::new(cosine, -sine, sine, cosine)
}

/// Returns the contact points by joints; joints on the same elastic body are coupled.
fn by_joints(problem: &PathProblem, sides: &[Vec<Side>]) -> Pattern {
    let joint = |c: &Contact| (c.joint, c.minus.body, c.plus.body);
    let joints = problem.contacts.chunk_by(|a, b| joint(a) == joint(b)).enumerate();
    let group: Vec<usize> = joints.flat_map(|(index, points)| points.iter().map(move |_| index)).collect();
    let on_body = |sides: &Vec<Side>| {
        let mut own: Vec<usize> = sides.iter().map(|side| group[side.contact]).collect();
        own.dedup();
        let pairs: Vec<_> = own.iter().flat_map(|a| own.iter().map(|b| (*a, *b))).collect();
        pairs
    };
    let pairs: Vec<_> = sides.iter().flat_map(on_body).collect();
    Pattern::new(group, pairs)
}

impl<'a> Geometry<'a> {
    pub fn new(problem: &'a PathProblem, finite: bool) -> Self {
        let mut sides = vec![Vec::new(); problem.bodies.len()];
        for (contact, c) in problem.contacts.iter().enumerate() {
            for (attachment, sign) in [(c.minus, -1.0), (c.plus, 1.0)] {
                if let Some(slot) = attachment.slot
                    && problem.bodies[attachment.body].flexibility.is_some()
                {
                    sides[attachment.body].push(Side { contact, sign, slot });
                }
            }
        }
        let pattern = Arc::new(by_joints(problem, &sides));
        Geometry { problem, finite, sides, pattern }
    }

    fn turned(&self, angle: f64) -> Turn {
        if self.finite { Turn::by(angle) } else { Turn { angle, ..Turn::by(0.0) } }
    }

    fn displaced(&self, body: usize, point: Vec2, [x, y, _]: [f64; 3], turn: &Turn) -> Vec2 {
        let arm = point - self.problem.bodies[body].pole;
        // R a − a without subtraction: rounding of gaps is relative to the motions, not to the scene.
        let swing = if self.finite {
            turned(arm) * turn.rotation[(1, 0)] - arm * (2.0 * turn.half * turn.half)
        } else {
            turned(arm) * turn.angle
        };
        Vec2::new(x, y) + swing
    }

    /// Returns the displacement of a point of a body by its rigid motion.
    pub fn rigid(&self, body: usize, point: Vec2, motion: &[[f64; 3]]) -> Vec2 {
        self.displaced(body, point, motion[body], &self.turned(motion[body][2]))
    }

    /// Returns the velocity of a point of a body that moves from a motion at a rate.
    pub fn velocity(&self, body: usize, point: Vec2, motion: &[[f64; 3]], rate: &[[f64; 3]]) -> Vec2 {
        let arm = self.turn(motion[body][2]) * (point - self.problem.bodies[body].pole);
        Vec2::new(rate[body][0], rate[body][1]) + turned(arm) * rate[body][2]
    }

    /// Returns the frames of contact points for these motions of the bodies.
    pub fn frames<'m>(&'m self, motion: &'m [[f64; 3]]) -> Frames<'m> {
        Frames {
            geometry: self,
            motion,
            turns: motion.iter().map(|q| self.turned(q[2])).collect(),
            last: [(0.0, Matrix2::identity()); 2],
        }
    }

    /// Returns the rotation by an angle; the identity with small displacements.
    pub fn turn(&self, angle: f64) -> Matrix2<f64> {
        if self.finite { rotation(angle) } else { Matrix2::identity() }
    }

    /// Returns [n t] r in the undeformed axes, and R(−s φ/2).
    pub fn carried(&self, side: &Side, force: &[[f64; 2]], motion: &[[f64; 3]]) -> (Vec2, Matrix2<f64>) {
        let c = &self.problem.contacts[side.contact];
        let phi = motion[c.plus.body][2] - motion[c.minus.body][2];
        let [normal, tangent] = force[side.contact];
        (c.normal * normal + c.tangent * tangent, self.turn(-side.sign * phi / 2.0))
    }

    /// Returns the same for all points of a body; the points of one joint have one rotation.
    pub fn all_carried(
        &self,
        body: usize,
        force: &[[f64; 2]],
        motion: &[[f64; 3]],
    ) -> impl Iterator<Item = (&Side, Vec2, Matrix2<f64>)> {
        let mut last: Option<(usize, f64, Matrix2<f64>)> = None;
        self.sides[body].iter().map(move |side| {
            let c = &self.problem.contacts[side.contact];
            let group = self.pattern.group(side.contact);
            let turn = match last {
                Some((own, sign, turn)) if own == group && sign == side.sign => turn,
                _ => self.carried(side, force, motion).1,
            };
            last = Some((group, side.sign, turn));
            let [normal, tangent] = force[side.contact];
            (side, c.normal * normal + c.tangent * tangent, turn)
        })
    }

    /// Returns the forces on the points of a body in its axes \[N\].
    pub fn body_forces(&self, body: usize, force: &[[f64; 2]], motion: &[[f64; 3]], loads: &Loads) -> Vec<f64> {
        let points = self.problem.bodies[body].flexibility.as_ref().map_or(0, |c| c.nrows());
        let mut f = vec![0.0; points];
        for (side, r, turn) in self.all_carried(body, force, motion) {
            let on = turn * r * side.sign;
            f[2 * side.slot] += on.x;
            f[2 * side.slot + 1] += on.y;
        }
        let back = self.turn(-motion[body][2]);
        for (factor, loading) in &loads.parts {
            for (_, slot, _, load) in loading.forces.iter().filter(|l| l.0 == body) {
                if let Some(slot) = slot {
                    let on = back * *load * *factor;
                    f[2 * slot] += on.x;
                    f[2 * slot + 1] += on.y;
                }
            }
        }
        f
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use voussoir_core::limit::Counters;
    use voussoir_core::path::PathBody;

    /// Small rotations move points by angle times arm, to relative rounding; large rotations by R a − a.
    #[test]
    fn a_small_turn_moves_a_point_to_relative_rounding() {
        let body = PathBody {
            members: vec![0],
            pole: Vec2::zeros(),
            held: false,
            mass: 0.0,
            points: vec![],
            flexibility: None,
            inelastic: None,
        };
        let problem = PathProblem {
            bodies: vec![body],
            body_of: vec![0],
            contacts: vec![],
            load_steps: vec![],
            length: 1.0,
            span: 1.0,
            counters: Counters::new(),
            width: 1.0,
        };
        let geometry = Geometry::new(&problem, true);
        let arm = Vec2::new(0.7, -0.3);
        for angle in [1e-12, -1e-9, 1e-6] {
            let moved = geometry.rigid(0, arm, &[[0.0, 0.0, angle]]);
            let second = turned(arm) * angle - arm * (0.5 * angle * angle);
            assert!((moved - second).norm() <= 1e-15 * angle.abs() + angle.abs().powi(3), "{angle}: {moved}");
        }
        for angle in [0.3, -2.0, 3.1] {
            let moved = geometry.rigid(0, arm, &[[0.0, 0.0, angle]]);
            assert!((moved - (rotation(angle) * arm - arm)).norm() <= 1e-15, "{angle}: {moved}");
        }
    }
}
