//! The part of the bodies' deformation in gaps and equilibrium (see `kinematics`), with its derivatives.

use super::blocks::YieldingBlock;
use super::derivatives::{Gradient, Hessian, OfPair};
use super::geometry::{Geometry, Place, Side};
use super::loads::Loads;
use crate::linear::dense::add_product;
use crate::linear::inner;
use nalgebra::{DMatrix, Matrix2};
use voussoir_core::model::geometry::{Vec2, turned};

/// Returns the flexibility C of a body; for a yielding body that of its linearisation.
fn flexibility<'b>(
    geometry: &Geometry<'b>,
    body: usize,
    blocks: &'b [Option<YieldingBlock>],
) -> Option<&'b DMatrix<f64>> {
    match blocks.get(body) {
        Some(Some(inner)) => Some(&inner.linear.flexibility),
        _ => geometry.problem.bodies[body].flexibility.as_deref(),
    }
}

fn times_flexibility(geometry: &Geometry, body: usize, f: &[f64], blocks: &[Option<YieldingBlock>]) -> Vec<f64> {
    let Some(c) = flexibility(geometry, body, blocks) else { return Vec::new() };
    let mut v = vec![0.0; f.len()];
    add_product(&mut v, c, f);
    v
}

/// Computes derivatives of w·f, with f the forces on a body's points, by contact forces (passed to `add` with their
/// row) and by the growing factor; the bodies' rotations are held.
pub fn by_forces(
    geometry: &Geometry,
    body: usize,
    weight: &[f64],
    (force, motion): (&[[f64; 2]], &[[f64; 3]]),
    loads: &Loads,
    mut add: impl FnMut(usize, f64),
) -> f64 {
    let at = |slot: usize| Vec2::new(weight[2 * slot], weight[2 * slot + 1]);
    for side in &geometry.sides[body] {
        let c = &geometry.problem.contacts[side.contact];
        let (_, turn) = geometry.carried(side, force, motion);
        let back = turn.transpose() * at(side.slot) * side.sign;
        add(2 * side.contact, c.normal.dot(&back));
        add(2 * side.contact + 1, c.tangent.dot(&back));
    }
    let back = geometry.turn(-motion[body][2]);
    let own = loads.growing().forces.iter().filter(|l| l.0 == body);
    own.filter_map(|(_, slot, _, load)| slot.map(|slot| (back * *load).dot(&at(slot)))).sum()
}

/// Adds the part of a body's deformation to the gradient.
pub fn add_elastic_gradient(geometry: &Geometry, body: usize, place: &Place, out: &mut Gradient) {
    let Place { force, motion, loads, blocks } = *place;
    let f = geometry.body_forces(body, force, motion, loads);
    let back = geometry.turn(-motion[body][2]);
    let mut v = times_flexibility(geometry, body, &f, blocks);
    match blocks.get(body) {
        Some(Some(inner)) => {
            out.stored += inner.linear.stored;
            v.iter_mut().zip(&inner.linear.offset).for_each(|(v, c)| *v += c);
        }
        _ => out.stored += 0.5 * f.iter().zip(&v).map(|(f, v)| f * v).sum::<f64>(),
    }
    for (side, r, turn) in geometry.all_carried(body, force, motion) {
        let c = &geometry.problem.contacts[side.contact];
        let here = Vec2::new(v[2 * side.slot], v[2 * side.slot + 1]);
        let gap = turn.transpose() * here * side.sign;
        out.gap[side.contact][0] += c.normal.dot(&gap);
        out.gap[side.contact][1] += c.tangent.dot(&gap);
        if geometry.finite {
            let moment = -0.5 * turned(turn * r).dot(&here);
            out.balance[c.plus.body][2] += moment;
            out.balance[c.minus.body][2] -= moment;
        }
    }
    if geometry.finite {
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

/// A side of an elastic body with ∂f/∂r and its frame.
type MovedSide = (Side, Matrix2<f64>, Matrix2<f64>);

fn at(v: &[f64], slot: usize) -> Vec2 {
    Vec2::new(v[2 * slot], v[2 * slot + 1])
}

/// Adds the part of a body's deformation to the second derivatives.
pub fn add_elastic_hessian(geometry: &Geometry, body: usize, place: &Place, gradient: &Gradient, out: &mut Hessian) {
    let Some(flexibility) = flexibility(geometry, body, place.blocks) else { return };
    let moved: Vec<MovedSide> = geometry
        .all_carried(body, place.force, place.motion)
        .map(|(side, _, turn)| {
            let c = &geometry.problem.contacts[side.contact];
            let frame = turn * Matrix2::from_columns(&[c.normal, c.tangent]);
            (*side, frame * side.sign, frame)
        })
        .collect();
    let turned: Vec<_> = moved.iter().map(|(side, m, _)| (side.contact, side.slot, *m)).collect();
    let by_joints = || turned.chunk_by(|a, b| geometry.pattern.group(a.0) == geometry.pattern.group(b.0));
    for columns in by_joints() {
        by_joints().for_each(|rows| out.forces.add_turned(rows, columns, flexibility));
    }
    // Derivative by the factor.
    let back = geometry.turn(-place.motion[body][2]);
    let mut pushed = vec![0.0; flexibility.nrows()];
    for (_, slot, _, load) in place.loads.growing().forces.iter().filter(|l| l.0 == body) {
        if let Some(slot) = slot {
            let on = back * *load;
            pushed[2 * slot] += on.x;
            pushed[2 * slot + 1] += on.y;
        }
    }
    let by_factor = times_flexibility(geometry, body, &pushed, place.blocks);
    for (side, m, _) in &moved {
        let gap = m.transpose() * at(&by_factor, side.slot);
        out.factor[2 * side.contact] += gap.x;
        out.factor[2 * side.contact + 1] += gap.y;
    }
    if geometry.finite {
        add_rotations(geometry, body, place, &gradient.deformation[body], (&moved, &by_factor), out);
    }
}

/// Returns ∂f/∂θ of a body and its neighbours, and adds the second derivatives that are diagonal in the rotations.
fn forces_by_rotations(
    geometry: &Geometry,
    body: usize,
    place: &Place,
    v: &[f64],
    out: &mut Hessian,
) -> Vec<(usize, Vec<f64>)> {
    let problem = geometry.problem;
    let base = 2 * problem.contacts.len();
    let theta = |b: usize| base + 3 * b + 2;
    let mut bends = OfPair::default();
    let rows = v.len();
    let mut columns: Vec<(usize, Vec<f64>)> = vec![(body, vec![0.0; rows])];
    let mut add = |of: usize, slot: usize, value: Vec2| {
        let place = columns.iter().position(|(b, _)| *b == of).unwrap_or_else(|| {
            columns.push((of, vec![0.0; rows]));
            columns.len() - 1
        });
        columns[place].1[2 * slot] += value.x;
        columns[place].1[2 * slot + 1] += value.y;
    };
    for (side, r, turn) in geometry.all_carried(body, place.force, place.motion) {
        let c = &problem.contacts[side.contact];
        let swing = turned(turn * r) * -0.5;
        add(c.plus.body, side.slot, swing);
        add(c.minus.body, side.slot, -swing);
        let bend = -0.25 * side.sign * (turn * r).dot(&at(v, side.slot));
        bends.begin([3 * c.plus.body, 3 * c.minus.body].map(|own| base + own), &mut out.entries);
        let (plus, minus) = (theta(c.plus.body), theta(c.minus.body));
        [(plus, plus, bend), (minus, minus, bend), (plus, minus, -bend), (minus, plus, -bend)]
            .into_iter()
            .for_each(|(i, j, value)| bends.add(i, j, value));
    }
    bends.end(&mut out.entries);
    let back = geometry.turn(-place.motion[body][2]);
    for (factor, loading) in &place.loads.parts {
        for (_, slot, _, load) in loading.forces.iter().filter(|l| l.0 == body) {
            if let Some(slot) = slot {
                let on = back * *load * *factor;
                add(body, *slot, -turned(on));
                out.entries.push((theta(body), theta(body), -on.dot(&at(v, *slot))));
            }
        }
    }
    columns
}

/// Adds the derivatives by rotations with finite displacements.
fn add_rotations(
    geometry: &Geometry,
    body: usize,
    place: &Place,
    v: &[f64],
    (moved, by_factor): (&[MovedSide], &[f64]),
    out: &mut Hessian,
) {
    let Some(flexibility) = flexibility(geometry, body, place.blocks) else { return };
    let theta = |b: usize| 2 * geometry.problem.contacts.len() + 3 * b + 2;
    let columns = forces_by_rotations(geometry, body, place, v, out);
    let products: Vec<Vec<f64>> =
        columns.iter().map(|(_, column)| times_flexibility(geometry, body, column, place.blocks)).collect();
    // The tangent of a law need not be symmetric: gaps by rotations use C, moments by forces use Cᵀ.
    let changed = matches!(place.blocks.get(body), Some(Some(inner)) if inner.linear.changed);
    let across: Option<Vec<Vec<f64>>> = changed.then(|| {
        let times = |column: &[f64]| flexibility.column_iter().map(|c| inner(c.as_slice(), column)).collect();
        columns.iter().map(|(_, column)| times(column)).collect()
    });
    for (k, (of, column)) in columns.iter().enumerate() {
        for (side, m, frame) in moved {
            let product = m.transpose() * at(&products[k], side.slot);
            let transposed = across.as_ref().map_or(product, |all| m.transpose() * at(&all[k], side.slot));
            let mut block = Vec2::zeros();
            let c = &geometry.problem.contacts[side.contact];
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
            out.entries.push((theta(*of), theta(*other), inner(column, &products[l])));
        }
        out.factor[theta(*of)] += inner(column, by_factor);
    }
    let back = geometry.turn(-place.motion[body][2]);
    for (_, slot, _, load) in place.loads.growing().forces.iter().filter(|l| l.0 == body) {
        if let Some(slot) = slot {
            out.factor[theta(body)] -= turned(back * *load).dot(&at(v, *slot));
        }
    }
}
