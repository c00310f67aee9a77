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
//! Π is then no potential, its gradient and their derivatives stay as they are with this u, and C need not be
//! symmetric. Small displacements are the same potential to
//! second order at the undeformed place: R = 1 and no second derivatives of rotations.
//! Source: the mixed form of Hellinger and Reissner with corotational frames (Wriggers 2006,
//! Computational Contact Mechanics; Crisfield 1997, Non-linear Finite Element Analysis 2, ch. 17).

use super::deformation::{add_elastic_gradient, add_elastic_hessian};
use super::derivatives::{Gradient, Hessian};
use super::geometry::{Geometry, Place};
use voussoir_core::model::geometry::turned;

/// First derivatives of Π at contact forces and motions; `blocks` are the bodies that yield.
pub(super) fn gradient(geometry: &Geometry, place: &Place) -> Gradient {
    let Place { force, motion, loads, .. } = *place;
    let problem = geometry.problem;
    let mut out = Gradient {
        gap: Vec::with_capacity(problem.contacts.len()),
        balance: vec![[0.0; 3]; problem.bodies.len()],
        deformation: vec![Vec::new(); problem.bodies.len()],
        stored: 0.0,
    };
    for (index, c) in problem.contacts.iter().enumerate() {
        let (arm_plus, arm_minus, jump, e) = geometry.frame(index, motion);
        let r = force[index];
        let mut gap = [c.gap, 0.0];
        for i in 0..2 {
            gap[i] += e[i].dot(&jump) + c.compliance[i] * r[i];
            out.stored += 0.5 * c.compliance[i] * r[i] * r[i];
        }
        out.gap.push(gap);
        let push = e[0] * r[0] + e[1] * r[1];
        let turning = if geometry.finite { turned(push).dot(&jump) } else { 0.0 };
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
                let (load, arm) = (load * *factor, geometry.turn(motion[body][2]) * (point - b.pole));
                out.balance[body][0] += load.x;
                out.balance[body][1] += load.y;
                out.balance[body][2] += load.dot(&turned(arm));
            }
        }
        if b.flexibility.is_some() {
            add_elastic_gradient(geometry, body, place, &mut out);
        }
    }
    out
}

/// Second derivatives of Π.
pub(super) fn hessian(geometry: &Geometry, place: &Place, gradient: &Gradient) -> Hessian {
    let Place { force, motion, loads, .. } = *place;
    let problem = geometry.problem;
    let base = 2 * problem.contacts.len();
    let size = base + 3 * problem.bodies.len();
    let by_rotations = 12 * geometry.sides.iter().map(Vec::len).sum::<usize>();
    let mut out = Hessian::zeros(geometry.pattern.clone(), size, 40 * problem.contacts.len() + by_rotations);
    let both = |entries: &mut Vec<(usize, usize, f64)>, i: usize, j: usize, value: f64| {
        entries.push((i, j, value));
        entries.push((j, i, value));
    };
    for (index, c) in problem.contacts.iter().enumerate() {
        let (arm_plus, arm_minus, jump, e) = geometry.frame(index, motion);
        let (plus, minus) = (base + 3 * c.plus.body, base + 3 * c.minus.body);
        let sides = [(plus, 1.0, arm_plus, c.sliding.share), (minus, -1.0, arm_minus, 1.0 - c.sliding.share)];
        for (i, e) in e.iter().enumerate() {
            let row = 2 * index + i;
            let turning = if geometry.finite { turned(*e).dot(&jump) } else { 0.0 };
            for (at, sign, arm, share) in sides {
                both(&mut out.entries, row, at, sign * e.x);
                both(&mut out.entries, row, at + 1, sign * e.y);
                both(&mut out.entries, row, at + 2, sign * e.dot(&turned(arm)) + share * turning);
            }
        }
        out.forces.add(index, index, [[c.compliance[0], 0.0], [0.0, c.compliance[1]]]);
        if geometry.finite {
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
        let turn = geometry.turn(motion[body][2]);
        for (_, _, point, load) in growing.forces.iter().filter(|l| l.0 == body) {
            out.factor[at] += load.x;
            out.factor[at + 1] += load.y;
            out.factor[at + 2] += load.dot(&turned(turn * (point - b.pole)));
        }
        if geometry.finite {
            for (factor, loading) in &loads.parts {
                for (_, _, point, load) in loading.forces.iter().filter(|l| l.0 == body) {
                    out.entries.push((at + 2, at + 2, -factor * load.dot(&(turn * (point - b.pole)))));
                }
            }
        }
        if b.flexibility.is_some() {
            add_elastic_hessian(geometry, body, place, gradient, &mut out);
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
