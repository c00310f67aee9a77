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
pub(super) struct Side {
    pub contact: usize,
    pub sign: f64,
    pub slot: usize,
}

/// Where derivatives are taken: contact forces, motions, loads, and the bodies that yield.
#[derive(Clone, Copy)]
pub(super) struct Place<'a> {
    pub force: &'a [[f64; 2]],
    pub motion: &'a [[f64; 3]],
    pub loads: &'a Loads<'a>,
    pub blocks: &'a [Option<YieldingBlock>],
}

/// A contact point where its bodies have moved rigidly.
pub(super) struct Frame {
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
    /// Axes turned back from those by β to the mean ones.
    pub fn mean(&self) -> [Vec2; 2] {
        let back = rotation((0.5 - self.share[0]) * self.turn);
        self.axes.map(|e| back * e)
    }
}

/// Geometry of a problem as the path solver sees it.
pub(super) struct Geometry<'a> {
    pub problem: &'a PathProblem,
    pub finite: bool,
    /// Contact points of every body.
    pub sides: Vec<Vec<Side>>,
    /// Contact points by joints, and which joints are on one elastic body.
    pub pattern: Arc<Pattern>,
}

fn rotation(angle: f64) -> Matrix2<f64> {
    let (sine, cosine) = angle.sin_cos();
    Matrix2::new(cosine, -sine, sine, cosine)
}

/// Contact points by joints; those on one elastic body feel each other.
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

    /// Rotation by an angle, none where displacements are small.
    pub fn turn(&self, angle: f64) -> Matrix2<f64> {
        if self.finite { rotation(angle) } else { Matrix2::identity() }
    }

    /// Displacement of a point of a body by its rigid motion.
    pub fn rigid(&self, body: usize, point: Vec2, motion: &[[f64; 3]]) -> Vec2 {
        let [x, y, theta] = motion[body];
        let arm = point - self.problem.bodies[body].pole;
        // R a − a without the difference of what is as large as the arm: gaps round by the motions, not by the scene.
        let swing = if self.finite {
            let half = (0.5 * theta).sin();
            turned(arm) * theta.sin() - arm * (2.0 * half * half)
        } else {
            turned(arm) * theta
        };
        Vec2::new(x, y) + swing
    }

    /// Of a contact point.
    pub fn frame(&self, contact: usize, motion: &[[f64; 3]]) -> Frame {
        let c = &self.problem.contacts[contact];
        let (minus, plus) = (c.minus.body, c.plus.body);
        let (low, high) = (motion[minus][2], motion[plus][2]);
        let arm = |body: usize, theta: f64| self.turn(theta) * (c.position - self.problem.bodies[body].pole);
        let jump = self.rigid(plus, c.position, motion) - self.rigid(minus, c.position, motion);
        let turn = high - low;
        let mut share = [c.sliding.share, 0.0, 0.0];
        if self.finite && c.sliding.passing != 0.0 {
            let middle = self.turn(low + 0.5 * turn) * c.tangent;
            share = c.sliding.share_at(middle.dot(&jump));
        }
        let axes = self.turn(low + share[0] * turn);
        Frame { arms: [arm(plus, high), arm(minus, low)], jump, axes: [axes * c.normal, axes * c.tangent], share, turn }
    }

    /// [n t] r in the undeformed axes, and R(−s φ/2).
    pub fn carried(&self, side: &Side, force: &[[f64; 2]], motion: &[[f64; 3]]) -> (Vec2, Matrix2<f64>) {
        let c = &self.problem.contacts[side.contact];
        let phi = motion[c.plus.body][2] - motion[c.minus.body][2];
        let [normal, tangent] = force[side.contact];
        (c.normal * normal + c.tangent * tangent, self.turn(-side.sign * phi / 2.0))
    }

    /// The same of all points of a body: those of one joint have one rotation.
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

    /// Forces on the points of a body in its axes \[N\].
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

    /// Small turns move points by their angle times the arm to rounding of that, not of the arm; large ones as R a − a.
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
