//! Gaps, equilibrium and their exact derivatives, from one potential.
//!
//! With x± = X_b + u_b + R(θ_b)(ξ + v_b) for the two sides of a contact point, θ_c = θ⁻ + β (θ⁺ − θ⁻)
//! (β = ½, or 0 and 1 where the point is one body's and slides on the other's face:
//! [`Sliding`](voussoir_core::path::Sliding)), e_i = R(θ_c) n, R(θ_c) t, the gaps are g_i = g_0 + e_i·(x⁺ − x⁻) and
//!
//! ```text
//! Π(r, q) = Σ_c r·g_rigid(q) + ½ r·c r + Σ_b ½ fᵀ C f + Σ F·x_rigid(q)
//! f = ±R(θ_c − θ_b) [n t] r at contact points, R(−θ_b) F at loads     (forces in the body's frame)
//! ∂Π/∂r = g,   ∂Π/∂q = Gqᵀ r + w + λ p = 0 (the moments of v_b included)
//! ```
//!
//! C: flexibility of the body, relative to its mean motion, so that the weight is part of w only. Of a body
//! that yields, u = C f + c is its linearisation ([`Linearisation`](voussoir_core::elastic::Linearisation)):
//! Π is then no potential, its slopes and their derivatives stay as they are with this u, and C need not be
//! symmetric. Small displacements are the same potential to
//! second order at the undeformed place: R = 1 and no second derivatives of rotations.
//! Source: the mixed form of Hellinger and Reissner with corotational frames (Wriggers 2006,
//! Computational Contact Mechanics; Crisfield 1997, Non-linear Finite Element Analysis 2, ch. 17).

use super::equations::Equations;
use super::inelastic::Inner;
use super::model::Model;
use nalgebra::Matrix2;
use std::cell::OnceCell;
use std::rc::Rc;
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::path::{Loading, PathProblem};

/// A contact point on an elastic body.
#[derive(Debug, Clone, Copy)]
pub(super) struct Side {
    pub contact: usize,
    pub sign: f64,
    pub slot: usize,
}

/// The loads in force: each loading with its factor, the one that grows last.
pub(super) struct Loads<'a> {
    pub parts: Vec<(f64, &'a Loading)>,
}

impl Loads<'_> {
    fn acceleration(&self) -> Vec2 {
        self.parts.iter().map(|(factor, loading)| loading.acceleration * *factor).sum()
    }

    pub fn growing(&self) -> &Loading {
        self.parts[self.parts.len() - 1].1
    }

    /// Motion of all held bodies by settlement.
    pub fn settled(&self, bodies: usize) -> Vec<[f64; 3]> {
        let mut motion = vec![[0.0; 3]; bodies];
        for (factor, loading) in &self.parts {
            for (body, settlement) in &loading.settlements {
                (0..3).for_each(|k| motion[*body][k] += factor * settlement[k]);
            }
        }
        motion
    }
}

/// First derivatives of Π.
#[derive(Debug, Clone)]
pub(super) struct Slopes {
    /// Gaps \[m\].
    pub gap: Vec<[f64; 2]>,
    /// Out-of-balance wrench on every body about its pole \[N, N m\].
    pub balance: Vec<[f64; 3]>,
    /// Elastic displacement of the points of every body in its frame \[m\].
    pub deformation: Vec<Vec<f64>>,
    /// Elastic energy \[J\].
    pub stored: f64,
}

/// Second derivatives of Π over (r, q of all bodies): entry (i, j, value), both halves, and the
/// derivative of the slopes by the factor that grows.
#[derive(Debug, Clone, Default)]
pub(super) struct Curvature {
    pub entries: Vec<(usize, usize, f64)>,
    pub factor: Vec<f64>,
    rows: OnceCell<Rc<Equations>>,
}

impl Curvature {
    /// The same as rows in units, made when they are asked for first.
    pub fn rows(&self, model: &Model) -> &Rc<Equations> {
        self.rows.get_or_init(|| Rc::new(Equations::new(model, self)))
    }
}

/// Geometry of a problem as the path solver sees it.
pub(super) struct Kinematics<'a> {
    pub problem: &'a PathProblem,
    pub finite: bool,
    /// Contact points of every body.
    pub sides: Vec<Vec<Side>>,
}

fn rotation(angle: f64) -> Matrix2<f64> {
    let (sine, cosine) = angle.sin_cos();
    Matrix2::new(cosine, -sine, sine, cosine)
}

impl<'a> Kinematics<'a> {
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
        Kinematics { problem, finite, sides }
    }

    /// Rotation by an angle, none where displacements are small.
    pub fn turn(&self, angle: f64) -> Matrix2<f64> {
        if self.finite { rotation(angle) } else { Matrix2::identity() }
    }

    /// Displacement of a point of a body by its rigid motion.
    pub fn rigid(&self, body: usize, point: Vec2, motion: &[[f64; 3]]) -> Vec2 {
        let [x, y, theta] = motion[body];
        let arm = point - self.problem.bodies[body].pole;
        let swing = if self.finite { rotation(theta) * arm - arm } else { turned(arm) * theta };
        Vec2::new(x, y) + swing
    }

    /// (R⁺ξ⁺, R⁻ξ⁻, x⁺ − x⁻ of the rigid motions, e_n and e_t) of a contact point.
    fn frame(&self, contact: usize, motion: &[[f64; 3]]) -> (Vec2, Vec2, Vec2, [Vec2; 2]) {
        let c = &self.problem.contacts[contact];
        let (minus, plus) = (c.minus.body, c.plus.body);
        let (low, high) = (motion[minus][2], motion[plus][2]);
        let arm = |body: usize, theta: f64| self.turn(theta) * (c.position - self.problem.bodies[body].pole);
        let turn = self.turn(low + c.sliding.share * (high - low));
        let jump = self.rigid(plus, c.position, motion) - self.rigid(minus, c.position, motion);
        (arm(plus, high), arm(minus, low), jump, [turn * c.normal, turn * c.tangent])
    }

    /// First derivatives of Π at contact forces and motions; `blocks` are the bodies that yield.
    pub fn slopes(&self, force: &[[f64; 2]], motion: &[[f64; 3]], loads: &Loads, blocks: &[Option<Inner>]) -> Slopes {
        let problem = self.problem;
        let mut out = Slopes {
            gap: Vec::with_capacity(problem.contacts.len()),
            balance: vec![[0.0; 3]; problem.bodies.len()],
            deformation: vec![Vec::new(); problem.bodies.len()],
            stored: 0.0,
        };
        for (index, c) in problem.contacts.iter().enumerate() {
            let (arm_plus, arm_minus, jump, e) = self.frame(index, motion);
            let r = force[index];
            let mut gap = [c.gap, 0.0];
            for i in 0..2 {
                gap[i] += e[i].dot(&jump) + c.compliance[i] * r[i];
                out.stored += 0.5 * c.compliance[i] * r[i] * r[i];
            }
            out.gap.push(gap);
            let push = e[0] * r[0] + e[1] * r[1];
            let turning = if self.finite { turned(push).dot(&jump) } else { 0.0 };
            let share = c.sliding.share;
            let sides = [(c.plus.body, 1.0, arm_plus, share), (c.minus.body, -1.0, arm_minus, 1.0 - share)];
            for (body, sign, arm, share) in sides {
                let balance = &mut out.balance[body];
                balance[0] += sign * push.x;
                balance[1] += sign * push.y;
                balance[2] += sign * push.dot(&turned(arm)) + share * turning;
            }
        }
        let acceleration = loads.acceleration();
        for (body, b) in problem.bodies.iter().enumerate() {
            out.balance[body][0] += acceleration.x * b.mass;
            out.balance[body][1] += acceleration.y * b.mass;
            for (factor, loading) in &loads.parts {
                for (_, _, point, load) in loading.forces.iter().filter(|l| l.0 == body) {
                    let (load, arm) = (load * *factor, self.turn(motion[body][2]) * (point - b.pole));
                    out.balance[body][0] += load.x;
                    out.balance[body][1] += load.y;
                    out.balance[body][2] += load.dot(&turned(arm));
                }
            }
            if b.flexibility.is_some() {
                self.elastic_slopes(body, force, motion, loads, blocks, &mut out);
            }
        }
        out
    }

    /// Second derivatives of Π.
    pub fn curvature(
        &self,
        force: &[[f64; 2]],
        motion: &[[f64; 3]],
        loads: &Loads,
        slopes: &Slopes,
        blocks: &[Option<Inner>],
    ) -> Curvature {
        let problem = self.problem;
        let base = 2 * problem.contacts.len();
        let size = base + 3 * problem.bodies.len();
        let mut out = Curvature { factor: vec![0.0; size], ..Curvature::default() };
        let both = |entries: &mut Vec<(usize, usize, f64)>, i: usize, j: usize, value: f64| {
            entries.push((i, j, value));
            entries.push((j, i, value));
        };
        for (index, c) in problem.contacts.iter().enumerate() {
            let (arm_plus, arm_minus, jump, e) = self.frame(index, motion);
            let (plus, minus) = (base + 3 * c.plus.body, base + 3 * c.minus.body);
            let sides = [(plus, 1.0, arm_plus, c.sliding.share), (minus, -1.0, arm_minus, 1.0 - c.sliding.share)];
            for (i, e) in e.iter().enumerate() {
                let row = 2 * index + i;
                let turning = if self.finite { turned(*e).dot(&jump) } else { 0.0 };
                for (at, sign, arm, share) in sides {
                    both(&mut out.entries, row, at, sign * e.x);
                    both(&mut out.entries, row, at + 1, sign * e.y);
                    both(&mut out.entries, row, at + 2, sign * e.dot(&turned(arm)) + share * turning);
                }
                out.entries.push((row, row, c.compliance[i]));
            }
            if self.finite {
                let push = e[0] * force[index][0] + e[1] * force[index][1];
                let across = turned(push);
                for (at, sign, arm, share) in sides {
                    for (theta, _, _, share) in sides {
                        both(&mut out.entries, at, theta + 2, sign * share * across.x);
                        both(&mut out.entries, at + 1, theta + 2, sign * share * across.y);
                    }
                    let own = sign * (2.0 * share - 1.0) * push.dot(&arm) - share * share * push.dot(&jump);
                    out.entries.push((at + 2, at + 2, own));
                }
                let (high, low) = (c.sliding.share, 1.0 - c.sliding.share);
                let mixed = push.dot(&(arm_plus * low - arm_minus * high)) - high * low * push.dot(&jump);
                both(&mut out.entries, plus + 2, minus + 2, mixed);
            }
        }
        let growing = loads.growing();
        for (body, b) in problem.bodies.iter().enumerate() {
            let at = base + 3 * body;
            out.factor[at] += growing.acceleration.x * b.mass;
            out.factor[at + 1] += growing.acceleration.y * b.mass;
            let turn = self.turn(motion[body][2]);
            for (_, _, point, load) in growing.forces.iter().filter(|l| l.0 == body) {
                out.factor[at] += load.x;
                out.factor[at + 1] += load.y;
                out.factor[at + 2] += load.dot(&turned(turn * (point - b.pole)));
            }
            if self.finite {
                for (factor, loading) in &loads.parts {
                    for (_, _, point, load) in loading.forces.iter().filter(|l| l.0 == body) {
                        out.entries.push((at + 2, at + 2, -factor * load.dot(&(turn * (point - b.pole)))));
                    }
                }
            }
            if b.flexibility.is_some() {
                self.elastic_curvature(body, force, motion, loads, slopes, blocks, &mut out);
            }
        }
        // Settlements move with the factor.
        let mut settling = vec![0.0; size];
        for (body, settlement) in &growing.settlements {
            (0..3).for_each(|k| settling[base + 3 * body + k] += settlement[k]);
        }
        if settling.iter().any(|s| *s != 0.0) {
            for &(i, j, value) in &out.entries {
                out.factor[i] += value * settling[j];
            }
        }
        out
    }
}
