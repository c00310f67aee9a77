//! Gaps, equilibrium and their exact derivatives, from one potential.
//!
//! With x± = X_b + u_b + R(θ_b)(ξ + v_b) for the two sides of a contact point, θ_c = θ⁻ + β (θ⁺ − θ⁻), e_i = R(θ_c) n,
//! R(θ_c) t and the gaps g_i = g_0 + e_i·(x⁺ − x⁻),
//!
//! ```text
//! Π(r, q) = Σ_c r·g_rigid(q) + ½ r·c r + Σ_b ½ fᵀ C f + Σ F·x_rigid(q)
//! f = ±R(θ_c − θ_b) [n t] r at contact points, R(−θ_b) F at loads     (forces in the body's frame)
//! ∂Π/∂r = g,   ∂Π/∂q = Gqᵀ r + w + λ p = 0 (the moments of v_b included)
//! ```
//!
//! β = ½; β = 0 or 1 if the point is a point of one body that slides on the face of the other; between these it is a
//! function of the slip ([`Sliding`](voussoir_core::path::Sliding)). C: flexibility of the body relative to its mean
//! motion, so that the weight is part of w only. For a yielding body, u = C f + c is its linearisation
//! ([`Linearisation`](voussoir_core::elastic::Linearisation)): Π is then not a potential, its gradient and their
//! derivatives keep their form with this u, and C need not be symmetric. Small displacements use the same potential to
//! second order at the undeformed position: R = 1 and no second derivatives of rotations. Source: the mixed form of
//! Hellinger and Reissner with corotational frames (Wriggers 2006, Computational Contact Mechanics; Crisfield 1997,
//! Non-linear Finite Element Analysis 2, ch. 17).

use super::deformation::{add_elastic_gradient, add_elastic_hessian};
use super::derivatives::{Gradient, Hessian, OfPair};
use super::geometry::{Frame, Geometry, Place};
use voussoir_core::model::geometry::{Vec2, turned};

/// Computes the first derivatives of Π at contact forces and motions; `blocks` are the yielding bodies.
pub fn gradient(geometry: &Geometry, place: &Place) -> Gradient {
    let Place { force, motion, loads, .. } = *place;
    let problem = geometry.problem;
    let mut out = Gradient {
        gap: Vec::with_capacity(problem.contacts.len()),
        balance: vec![[0.0; 3]; problem.bodies.len()],
        deformation: vec![Vec::new(); problem.bodies.len()],
        stored: 0.0,
    };
    let mut frames = geometry.frames(motion);
    for (index, c) in problem.contacts.iter().enumerate() {
        let frame = frames.of(index);
        let (r, e) = (force[index], frame.axes);
        let mut gap = [c.gap, 0.0];
        for i in 0..2 {
            gap[i] += e[i].dot(&frame.jump) + c.compliance[i] * r[i];
            out.stored += 0.5 * c.compliance[i] * r[i] * r[i];
        }
        out.gap.push(gap);
        let bodies = [c.plus.body, c.minus.body];
        let push = e[0] * r[0] + e[1] * r[1];
        add_force(&mut out.balance, bodies, &frame, push, frame.share[0], geometry.finite);
        if frame.share[1] != 0.0 {
            let along = frame.mean()[1] * passing_force(&frame, push);
            add_force(&mut out.balance, bodies, &frame, along, 0.5, true);
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

/// Adds a force of plus on minus that acts at (1 − share) x⁺ + share x⁻.
fn add_force(balance: &mut [[f64; 3]], bodies: [usize; 2], frame: &Frame, push: Vec2, share: f64, finite: bool) {
    let turning = if finite { turned(push).dot(&frame.jump) } else { 0.0 };
    let sides = [(1.0, share), (-1.0, 1.0 - share)];
    for ((body, arm), (sign, share)) in bodies.into_iter().zip(frame.arms).zip(sides) {
        balance[body][0] += sign * push.x;
        balance[body][1] += sign * push.y;
        balance[body][2] += sign * push.dot(&turned(arm)) + share * turning;
    }
}

/// Returns the force along the mean tangent from the change of β with the slip: ∂(r·g)/∂β β'.
fn passing_force(frame: &Frame, push: Vec2) -> f64 {
    turned(push).dot(&frame.jump) * frame.share[1] * frame.turn
}

/// Adds an entry and its mirror image.
fn both(add: &mut impl FnMut(usize, usize, f64), i: usize, j: usize, value: f64) {
    add(i, j, value);
    add(j, i, value);
}

/// Returns the derivatives of e·(x⁺ − x⁻) by both motions, whose columns begin `at`; e turns with a share β.
fn by_motion(frame: &Frame, at: [usize; 2], e: Vec2, share: f64, finite: bool) -> [(usize, f64); 6] {
    let turning = if finite { turned(e).dot(&frame.jump) } else { 0.0 };
    let [plus, minus] = [(1.0, share), (-1.0, 1.0 - share)];
    let of = |at: usize, arm: Vec2, (sign, share): (f64, f64)| {
        [(at, sign * e.x), (at + 1, sign * e.y), (at + 2, sign * e.dot(&turned(arm)) + share * turning)]
    };
    let [a, b, c] = of(at[0], frame.arms[0], plus);
    let [d, e, f] = of(at[1], frame.arms[1], minus);
    [a, b, c, d, e, f]
}

/// Adds the second derivatives of P·(x⁺ − x⁻) by the motions; P turns with a share β.
fn add_turning(add: &mut impl FnMut(usize, usize, f64), frame: &Frame, at: [usize; 2], push: Vec2, share: f64) {
    let (across, jump) = (turned(push), &frame.jump);
    let [high, low] = [share, 1.0 - share];
    let sides = [(at[0], 1.0, frame.arms[0], high), (at[1], -1.0, frame.arms[1], low)];
    for (at, sign, arm, share) in sides {
        for (theta, _, _, share) in sides {
            both(add, at, theta + 2, sign * share * across.x);
            both(add, at + 1, theta + 2, sign * share * across.y);
        }
        let own = sign * (2.0 * share - 1.0) * push.dot(&arm) - share * share * push.dot(jump);
        add(at + 2, at + 2, own);
    }
    let mixed = push.dot(&(frame.arms[0] * low - frame.arms[1] * high)) - high * low * push.dot(jump);
    both(add, at[0] + 2, at[1] + 2, mixed);
}

/// Adds the second derivatives of r·g from the change of β with the slip s. With a and s the gaps in the mean axes, D =
/// θ⁺ − θ⁻, φ = (β(s) − ½) D, ρ = (P·n_m, P·t_m), W = P·(x⁺ − x⁻) and M = ∂W/∂φ = s ρ_n − a ρ_t, ∂M/∂φ = −W:
///
/// ```text
/// ∂g/∂s    (e_t, −e_n)·(x⁺ − x⁻) φ_s          W_s    M φ_s
/// W_as     −ρ_t φ_s         W_ss    2 ρ_n φ_s − W φ_s² + M φ_ss         W_sD    M φ_sD − W φ_s φ_D
/// ```
fn add_passing(add: &mut impl FnMut(usize, usize, f64), frame: &Frame, (row, at): (usize, [usize; 2]), push: Vec2) {
    let [beta, first, second] = frame.share;
    let [n, t] = frame.mean();
    let (work, moment) = (push.dot(&frame.jump), turned(push).dot(&frame.jump));
    let (by_slip, by_turn) = (first * frame.turn, beta - 0.5);
    let [of_a, of_s] = [n, t].map(|e| by_motion(frame, at, e, 0.5, true));
    let rotates = [0.0, 0.0, 1.0, 0.0, 0.0, -1.0];
    let [e_n, e_t] = frame.axes.map(|e| e.dot(&frame.jump));
    for (i, turned) in [e_t, -e_n].into_iter().enumerate() {
        for (column, ds) in of_s {
            both(add, row + i, column, turned * by_slip * ds);
        }
    }
    add_turning(add, frame, at, t * (moment * by_slip), 0.5);
    let in_a = -push.dot(&t) * by_slip;
    let in_s = 2.0 * push.dot(&n) * by_slip - work * by_slip * by_slip + moment * second * frame.turn;
    let in_turn = moment * first - work * by_slip * by_turn;
    for k in 0..6 {
        let along = in_a * of_a[k].1 + 0.5 * in_s * of_s[k].1 + in_turn * rotates[k];
        for (column, ds) in of_s {
            both(add, of_a[k].0, column, along * ds);
        }
    }
}

/// Computes the second derivatives of Π.
pub fn hessian(geometry: &Geometry, place: &Place, gradient: &Gradient) -> Hessian {
    let Place { force, motion, loads, .. } = *place;
    let problem = geometry.problem;
    let base = 2 * problem.contacts.len();
    let size = base + 3 * problem.bodies.len();
    let by_rotations = 12 * geometry.sides.iter().map(Vec::len).sum::<usize>();
    let mut out = Hessian::zeros(geometry.pattern.clone(), size, 40 * problem.contacts.len() + by_rotations);
    let mut frames = geometry.frames(motion);
    let mut of_pair = OfPair::default();
    for (index, c) in problem.contacts.iter().enumerate() {
        let frame = frames.of(index);
        let at = [base + 3 * c.plus.body, base + 3 * c.minus.body];
        for (i, e) in frame.axes.iter().enumerate() {
            let row = 2 * index + i;
            for (column, value) in by_motion(&frame, at, *e, frame.share[0], geometry.finite) {
                both(&mut |i, j, value| out.entries.push((i, j, value)), row, column, value);
            }
        }
        out.forces.add(index, index, [[c.compliance[0], 0.0], [0.0, c.compliance[1]]]);
        if geometry.finite {
            let push = frame.axes[0] * force[index][0] + frame.axes[1] * force[index][1];
            of_pair.begin(at, &mut out.entries);
            let mut add = |i: usize, j: usize, value: f64| match i.min(j) < base {
                true => out.entries.push((i, j, value)),
                false => of_pair.add(i, j, value),
            };
            add_turning(&mut add, &frame, at, push, frame.share[0]);
            if frame.share[1] != 0.0 {
                add_passing(&mut add, &frame, (2 * index, at), push);
            }
        }
    }
    of_pair.end(&mut out.entries);
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
