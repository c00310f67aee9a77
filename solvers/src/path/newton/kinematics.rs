//! Gaps, equilibrium and their exact derivatives, from one potential.
//!
//! With x± = X_b + u_b + R(θ_b)(ξ + v_b) for the two sides of a contact point, θ_c the mean rotation
//! of its bodies, e_i = R(θ_c) n, R(θ_c) t, the gaps are g_i = g_0 + e_i·(x⁺ − x⁻) and
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

use super::inelastic::Inner;
use nalgebra::{DMatrix, Matrix2};
use voussoir_core::geometry::{Vec2, turned};
use voussoir_core::path::{Loading, PathProblem};

/// A contact point on an elastic body.
#[derive(Debug, Clone, Copy)]
struct Side {
    contact: usize,
    sign: f64,
    slot: usize,
}

/// The loads in force: each loading with its factor, the one that grows last.
pub(super) struct Loads<'a> {
    pub parts: Vec<(f64, &'a Loading)>,
}

impl Loads<'_> {
    fn acceleration(&self) -> Vec2 {
        self.parts.iter().map(|(factor, loading)| loading.acceleration * *factor).sum()
    }

    fn growing(&self) -> &Loading {
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
}

/// Geometry of a problem as the path solver sees it.
pub(super) struct Kinematics<'a> {
    pub problem: &'a PathProblem,
    pub finite: bool,
    sides: Vec<Vec<Side>>,
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

    fn turn(&self, angle: f64) -> Matrix2<f64> {
        if self.finite { rotation(angle) } else { Matrix2::identity() }
    }

    /// Displacement of a point of a body by its rigid motion.
    pub fn rigid(&self, body: usize, point: Vec2, motion: &[[f64; 3]]) -> Vec2 {
        let [x, y, theta] = motion[body];
        let arm = point - self.problem.bodies[body].pole;
        let swing = if self.finite { rotation(theta) * arm - arm } else { turned(arm) * theta };
        Vec2::new(x, y) + swing
    }

    /// (R⁺ξ⁺, R⁻ξ⁻, x⁺ − x⁻ of the rigid motions, e_n, e_t, θ⁺ − θ⁻) of a contact point.
    fn frame(&self, contact: usize, motion: &[[f64; 3]]) -> (Vec2, Vec2, Vec2, [Vec2; 2], f64) {
        let c = &self.problem.contacts[contact];
        let (minus, plus) = (c.minus.body, c.plus.body);
        let (low, high) = (motion[minus][2], motion[plus][2]);
        let arm = |body: usize, theta: f64| self.turn(theta) * (c.position - self.problem.bodies[body].pole);
        let mean = self.turn((low + high) / 2.0);
        let jump = self.rigid(plus, c.position, motion) - self.rigid(minus, c.position, motion);
        (arm(plus, high), arm(minus, low), jump, [mean * c.normal, mean * c.tangent], high - low)
    }

    /// [n t] r in the undeformed axes, and R(−s φ/2).
    fn carried(&self, side: &Side, force: &[[f64; 2]], motion: &[[f64; 3]]) -> (Vec2, Matrix2<f64>) {
        let c = &self.problem.contacts[side.contact];
        let phi = motion[c.plus.body][2] - motion[c.minus.body][2];
        let [normal, tangent] = force[side.contact];
        (c.normal * normal + c.tangent * tangent, self.turn(-side.sign * phi / 2.0))
    }

    /// Forces on the points of a body in its axes \[N\].
    pub fn body_forces(&self, body: usize, force: &[[f64; 2]], motion: &[[f64; 3]], loads: &Loads) -> Vec<f64> {
        let points = self.problem.bodies[body].flexibility.as_ref().map_or(0, |c| c.nrows());
        let mut f = vec![0.0; points];
        for side in &self.sides[body] {
            let (r, turn) = self.carried(side, force, motion);
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

    /// C of a body: of one that yields, its linearisation's.
    fn flexibility<'b>(&'b self, body: usize, blocks: &'b [Option<Inner>]) -> Option<&'b DMatrix<f64>> {
        match blocks.get(body) {
            Some(Some(inner)) => Some(&inner.linear.flexibility),
            _ => self.problem.bodies[body].flexibility.as_deref(),
        }
    }

    fn times_flexibility(&self, body: usize, f: &[f64], blocks: &[Option<Inner>]) -> Vec<f64> {
        let Some(c) = self.flexibility(body, blocks) else { return Vec::new() };
        let mut v = vec![0.0; f.len()];
        for (j, column) in c.column_iter().enumerate() {
            if f[j] != 0.0 {
                for (v, c) in v.iter_mut().zip(column.iter()) {
                    *v += c * f[j];
                }
            }
        }
        v
    }

    /// Derivatives of w·f, f the forces on a body's points, by contact forces (given to `add` with their
    /// row) and by the factor that grows; the bodies' rotations held.
    pub fn by_forces(
        &self,
        body: usize,
        weight: &[f64],
        (force, motion): (&[[f64; 2]], &[[f64; 3]]),
        loads: &Loads,
        mut add: impl FnMut(usize, f64),
    ) -> f64 {
        let at = |slot: usize| Vec2::new(weight[2 * slot], weight[2 * slot + 1]);
        for side in &self.sides[body] {
            let c = &self.problem.contacts[side.contact];
            let (_, turn) = self.carried(side, force, motion);
            let back = turn.transpose() * at(side.slot) * side.sign;
            add(2 * side.contact, c.normal.dot(&back));
            add(2 * side.contact + 1, c.tangent.dot(&back));
        }
        let back = self.turn(-motion[body][2]);
        let own = loads.growing().forces.iter().filter(|l| l.0 == body);
        own.filter_map(|(_, slot, _, load)| slot.map(|slot| (back * *load).dot(&at(slot)))).sum()
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
            let (arm_plus, arm_minus, jump, e, _) = self.frame(index, motion);
            let r = force[index];
            let mut gap = [c.gap, 0.0];
            for i in 0..2 {
                gap[i] += e[i].dot(&jump) + c.compliance[i] * r[i];
                out.stored += 0.5 * c.compliance[i] * r[i] * r[i];
            }
            out.gap.push(gap);
            let push = e[0] * r[0] + e[1] * r[1];
            let half = if self.finite { 0.5 * turned(push).dot(&jump) } else { 0.0 };
            for (body, sign, arm) in [(c.plus.body, 1.0, arm_plus), (c.minus.body, -1.0, arm_minus)] {
                let balance = &mut out.balance[body];
                balance[0] += sign * push.x;
                balance[1] += sign * push.y;
                balance[2] += sign * push.dot(&turned(arm)) + half;
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

    fn elastic_slopes(
        &self,
        body: usize,
        force: &[[f64; 2]],
        motion: &[[f64; 3]],
        loads: &Loads,
        blocks: &[Option<Inner>],
        out: &mut Slopes,
    ) {
        let f = self.body_forces(body, force, motion, loads);
        let back = self.turn(-motion[body][2]);
        let mut v = self.times_flexibility(body, &f, blocks);
        match blocks.get(body) {
            Some(Some(inner)) => {
                out.stored += inner.linear.stored;
                v.iter_mut().zip(&inner.linear.offset).for_each(|(v, c)| *v += c);
            }
            _ => out.stored += 0.5 * f.iter().zip(&v).map(|(f, v)| f * v).sum::<f64>(),
        }
        for side in &self.sides[body] {
            let c = &self.problem.contacts[side.contact];
            let (r, turn) = self.carried(side, force, motion);
            let here = Vec2::new(v[2 * side.slot], v[2 * side.slot + 1]);
            let gap = turn.transpose() * here * side.sign;
            out.gap[side.contact][0] += c.normal.dot(&gap);
            out.gap[side.contact][1] += c.tangent.dot(&gap);
            if self.finite {
                let moment = -0.5 * turned(turn * r).dot(&here);
                out.balance[c.plus.body][2] += moment;
                out.balance[c.minus.body][2] -= moment;
            }
        }
        if self.finite {
            for (factor, loading) in &loads.parts {
                for (_, slot, _, load) in loading.forces.iter().filter(|l| l.0 == body) {
                    if let Some(slot) = slot {
                        let here = Vec2::new(v[2 * slot], v[2 * slot + 1]);
                        out.balance[body][2] -= turned(back * *load * *factor).dot(&here);
                    }
                }
            }
        }
        out.deformation[body] = v;
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
        let mut out = Curvature { entries: Vec::new(), factor: vec![0.0; size] };
        let both = |entries: &mut Vec<(usize, usize, f64)>, i: usize, j: usize, value: f64| {
            entries.push((i, j, value));
            entries.push((j, i, value));
        };
        for (index, c) in problem.contacts.iter().enumerate() {
            let (arm_plus, arm_minus, jump, e, _) = self.frame(index, motion);
            let (plus, minus) = (base + 3 * c.plus.body, base + 3 * c.minus.body);
            for (i, e) in e.iter().enumerate() {
                let row = 2 * index + i;
                let half = if self.finite { 0.5 * turned(*e).dot(&jump) } else { 0.0 };
                for (at, sign, arm) in [(plus, 1.0, arm_plus), (minus, -1.0, arm_minus)] {
                    both(&mut out.entries, row, at, sign * e.x);
                    both(&mut out.entries, row, at + 1, sign * e.y);
                    both(&mut out.entries, row, at + 2, sign * e.dot(&turned(arm)) + half);
                }
                out.entries.push((row, row, c.compliance[i]));
            }
            if self.finite {
                let push = e[0] * force[index][0] + e[1] * force[index][1];
                let side = turned(push) / 2.0;
                for (at, sign) in [(plus, 1.0), (minus, -1.0)] {
                    for theta in [plus + 2, minus + 2] {
                        both(&mut out.entries, at, theta, sign * side.x);
                        both(&mut out.entries, at + 1, theta, sign * side.y);
                    }
                }
                let quarter = -0.25 * push.dot(&jump);
                out.entries.push((plus + 2, plus + 2, quarter));
                out.entries.push((minus + 2, minus + 2, quarter));
                both(&mut out.entries, plus + 2, minus + 2, 0.5 * push.dot(&(arm_plus - arm_minus)) + quarter);
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

    #[allow(clippy::too_many_arguments)]
    fn elastic_curvature(
        &self,
        body: usize,
        force: &[[f64; 2]],
        motion: &[[f64; 3]],
        loads: &Loads,
        slopes: &Slopes,
        blocks: &[Option<Inner>],
        out: &mut Curvature,
    ) {
        let problem = self.problem;
        let Some(flexibility) = self.flexibility(body, blocks) else { return };
        let base = 2 * problem.contacts.len();
        let theta = |b: usize| base + 3 * b + 2;
        let rows = flexibility.nrows();
        let v = &slopes.deformation[body];
        let at = |v: &[f64], slot: usize| Vec2::new(v[2 * slot], v[2 * slot + 1]);
        let back = self.turn(-motion[body][2]);
        // ∂f/∂r of every side.
        let moved: Vec<(Side, Matrix2<f64>, Matrix2<f64>)> = self.sides[body]
            .iter()
            .map(|side| {
                let c = &problem.contacts[side.contact];
                let (_, turn) = self.carried(side, force, motion);
                let frame = turn * Matrix2::from_columns(&[c.normal, c.tangent]);
                (*side, frame * side.sign, frame)
            })
            .collect();
        for (one, m, _) in &moved {
            for (other, n, _) in &moved {
                let block = flexibility.fixed_view::<2, 2>(2 * one.slot, 2 * other.slot);
                let product = m.transpose() * block * n;
                for i in 0..2 {
                    for j in 0..2 {
                        out.entries.push((2 * one.contact + i, 2 * other.contact + j, product[(i, j)]));
                    }
                }
            }
        }
        // By the factor.
        let growing = loads.growing();
        let mut pushed = vec![0.0; rows];
        for (_, slot, _, load) in growing.forces.iter().filter(|l| l.0 == body) {
            if let Some(slot) = slot {
                let on = back * *load;
                pushed[2 * slot] += on.x;
                pushed[2 * slot + 1] += on.y;
            }
        }
        let by_factor = self.times_flexibility(body, &pushed, blocks);
        for (side, m, _) in &moved {
            let gap = m.transpose() * at(&by_factor, side.slot);
            out.factor[2 * side.contact] += gap.x;
            out.factor[2 * side.contact + 1] += gap.y;
        }
        if !self.finite {
            return;
        }
        // ∂f/∂θ of the body and its neighbours.
        let mut columns: Vec<(usize, Vec<f64>)> = vec![(body, vec![0.0; rows])];
        let mut add = |of: usize, slot: usize, value: Vec2| {
            let place = columns.iter().position(|(b, _)| *b == of).unwrap_or_else(|| {
                columns.push((of, vec![0.0; rows]));
                columns.len() - 1
            });
            columns[place].1[2 * slot] += value.x;
            columns[place].1[2 * slot + 1] += value.y;
        };
        for side in &self.sides[body] {
            let c = &problem.contacts[side.contact];
            let (r, turn) = self.carried(side, force, motion);
            let swing = turned(turn * r) * -0.5;
            add(c.plus.body, side.slot, swing);
            add(c.minus.body, side.slot, -swing);
            let bend = -0.25 * side.sign * (turn * r).dot(&at(v, side.slot));
            let (plus, minus) = (theta(c.plus.body), theta(c.minus.body));
            out.entries.extend([(plus, plus, bend), (minus, minus, bend), (plus, minus, -bend), (minus, plus, -bend)]);
        }
        for (factor, loading) in &loads.parts {
            for (_, slot, _, load) in loading.forces.iter().filter(|l| l.0 == body) {
                if let Some(slot) = slot {
                    let on = back * *load * *factor;
                    add(body, *slot, -turned(on));
                    out.entries.push((theta(body), theta(body), -on.dot(&at(v, *slot))));
                }
            }
        }
        let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
        let products: Vec<Vec<f64>> =
            columns.iter().map(|(_, column)| self.times_flexibility(body, column, blocks)).collect();
        // Where a block yields, C need not be symmetric: gaps by rotations take C, moments by forces Cᵀ.
        let yields = matches!(blocks.get(body), Some(Some(inner)) if inner.linear.yielding > 0);
        let across: Option<Vec<Vec<f64>>> = yields.then(|| {
            let times = |column: &[f64]| flexibility.column_iter().map(|c| dot(c.as_slice(), column)).collect();
            columns.iter().map(|(_, column)| times(column)).collect()
        });
        for (k, (of, column)) in columns.iter().enumerate() {
            for (side, m, frame) in &moved {
                let product = m.transpose() * at(&products[k], side.slot);
                let transposed = across.as_ref().map_or(product, |all| m.transpose() * at(&all[k], side.slot));
                let mut block = Vec2::zeros();
                let c = &problem.contacts[side.contact];
                let chain = f64::from(c.plus.body == *of) - f64::from(c.minus.body == *of);
                // ∂M/∂φ = −½ J R(−s φ/2) [n t]
                let here = at(v, side.slot);
                block.x += chain * -0.5 * turned(frame.column(0).into()).dot(&here);
                block.y += chain * -0.5 * turned(frame.column(1).into()).dot(&here);
                for i in 0..2 {
                    out.entries.push((2 * side.contact + i, theta(*of), product[i] + block[i]));
                    out.entries.push((theta(*of), 2 * side.contact + i, transposed[i] + block[i]));
                }
            }
            for (l, (other, _)) in columns.iter().enumerate() {
                out.entries.push((theta(*of), theta(*other), dot(column, &products[l])));
            }
            out.factor[theta(*of)] += dot(column, &by_factor);
        }
        for (_, slot, _, load) in growing.forces.iter().filter(|l| l.0 == body) {
            if let Some(slot) = slot {
                out.factor[theta(body)] -= turned(back * *load).dot(&at(v, *slot));
            }
        }
    }
}
