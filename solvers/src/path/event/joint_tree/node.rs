//! A node of the tree: a joint with what lies on both sides of it, up to the next joints outside, condensed.
//!
//! Local unknowns z are the forces f of the joint's points, in axes of their own (along and across the facet that flows),
//! and the joint's twist ξ; beside them stand γ, the gaps and what is left of the resultants. From outside come
//! y = (r_a, r_b, X, s, ξ̂): forces of the joints on both sides, redundants and load, twists of weak joints below. With
//! K = [D H; Hᵀ −κ], D all that gives way at the joint,
//!
//! ```text
//! γ = K z + O y        o = Oᵀ z + F y
//! ```
//!
//! and o the gaps at the outer joints and what the cycles are left open by. Unknowns that are free (γ = 0) are exchanged
//! for their γ: then (z_free, γ_held) = V (γ_free, z_held) + Q y and o = … + F̂ y. A direction that becomes free or
//! held is one exchange step, of rank one; so is, in every node above, what it changes of F̂.

use super::super::elastic_chain::Joint;
use crate::contact::facet::across;
use crate::contact::mode::ContactMode;
use crate::linear::dense::{add_outer, add_product, product, row_product};
use crate::path::system::System;
use nalgebra::{DMatrix, Matrix3xX};
use voussoir_core::law::Facet;

/// Pivots below this share of the greatest entry of their kind: the exchange loses too many digits.
const PIVOT: f64 = 1e-9;
/// The same of 1 + c u·V u in a change from below.
const DETERMINANT: f64 = 1e-6;
/// Greatest error of an inverse.
const INVERSE: f64 = 1e-8;

/// A change c u uᵀ of what a node hands on, over its outer unknowns.
pub struct Change {
    /// c.
    pub factor: f64,
    /// u.
    pub along: Vec<f64>,
}

/// The equations of a node in the present modes.
pub struct Table {
    /// Which local unknowns are free: both directions of every point, then the twist.
    pub free: Vec<bool>,
    /// First axis of every point, over (n, t).
    pub axes: Vec<[f64; 2]>,
    /// 1 for what is free of both directions of every point, else 0.
    forces: Vec<f64>,
    /// Whether any axes are others than (n, t).
    turned: bool,
    /// V.
    pub local: DMatrix<f64>,
    /// Q.
    pub by_outer: DMatrix<f64>,
    /// F̂.
    pub handed: DMatrix<f64>,
    /// Changes since it was condensed.
    pub changes: usize,
    /// Changes since the beginning.
    pub version: u64,
}

/// What a table is condensed from.
pub struct Parts<'a> {
    /// The joint.
    pub joint: &'a Joint,
    /// Resultant from (X, s).
    pub statics: &'a Matrix3xX<f64>,
    /// Gaps that the load opens.
    pub opened: &'a [f64],
    /// What the nodes on both sides hand on, and how many twists of weak joints lie there.
    pub sides: [Option<&'a DMatrix<f64>>; 2],
    /// Twists of weak joints on each side.
    pub below: [usize; 2],
    /// Number of forces of the outer joints.
    pub outer: [usize; 2],
    /// Whether its twist is an outer unknown too.
    pub weak: bool,
}

/// Components in axes that begin with this one.
pub fn into_axes([c, s]: [f64; 2], [n, t]: [f64; 2]) -> [f64; 2] {
    [c * n + s * t, c * t - s * n]
}

/// Components over (n, t) from those in axes.
pub fn out_of_axes([c, s]: [f64; 2], [u, v]: [f64; 2]) -> [f64; 2] {
    [c * u - s * v, s * u + c * v]
}

/// Turns pairs of rows into axes.
fn turn_rows(matrix: &mut DMatrix<f64>, axes: &[[f64; 2]]) {
    for mut column in matrix.column_iter_mut() {
        for (k, axis) in axes.iter().enumerate().filter(|a| *a.1 != [1.0, 0.0]) {
            [column[2 * k], column[2 * k + 1]] = into_axes(*axis, [column[2 * k], column[2 * k + 1]]);
        }
    }
}

/// Axis and free directions of a mode. `None` where there is no such facet.
fn held_by(mode: ContactMode, facets: Option<&[Facet]>, axis: [f64; 2]) -> Option<([f64; 2], [bool; 2])> {
    Some(match mode {
        ContactMode::Stick => (axis, [true, true]),
        ContactMode::Open | ContactMode::Corner(..) => ([1.0, 0.0], [false, false]),
        ContactMode::Facet(f) => {
            let [c, s] = across(facets?.get(f as usize)?.normal);
            // Across what is across.
            ([s, -c], [false, true])
        }
    })
}

impl Parts<'_> {
    fn columns(&self) -> usize {
        self.outer[0]
            + self.outer[1]
            + self.statics.ncols()
            + 3 * (self.below[0] + self.below[1] + usize::from(self.weak))
    }

    /// For a side: where forces of its outer joint, those of this joint, (X, s) and its twists stand in what it hands
    /// on, and the same of the first, third and fourth among the columns here.
    fn places(&self, side: usize, own: usize) -> [(usize, usize, usize); 3] {
        let (outer, [a, b]) = (self.outer[side], self.outer);
        let after = outer + own;
        let base = self.statics.ncols();
        let first = if side == 0 { (0, 0, a) } else { (own, a, b) };
        let twists = a + b + base + if side == 0 { 0 } else { 3 * self.below[0] };
        [first, (after, a + b, base), (after + base, twists, 3 * self.below[side])]
    }

    /// D with H and κ, O, and F without the joint.
    fn equations(&self) -> [DMatrix<f64>; 3] {
        let (m, base) = (2 * self.joint.contacts.len(), self.statics.ncols());
        let [a, b] = self.outer;
        let mut own = DMatrix::zeros(m + 3, m + 3);
        let mut outer = DMatrix::zeros(m + 3, self.columns());
        let mut beyond = DMatrix::zeros(self.columns(), self.columns());
        own.view_mut((0, 0), (m, m)).copy_from(&*self.joint.own);
        own.view_mut((0, m), (m, 3)).copy_from(&self.joint.by_twist);
        own.view_mut((m, 0), (3, m)).copy_from(&self.joint.by_twist.transpose());
        for side in [0, 1] {
            let at = self.places(side, m);
            let Some(handed) = self.sides[side] else {
                let block = if side == 0 { &self.joint.before } else { &self.joint.after };
                if let Some(block) = block {
                    outer.view_mut((0, at[0].1), (m, at[0].2)).copy_from(&**block);
                }
                continue;
            };
            let here = if side == 0 { a } else { 0 };
            let mut sum = own.view_mut((0, 0), (m, m));
            sum += handed.view((here, here), (m, m));
            for (from, to, count) in at {
                let mut block = outer.view_mut((0, to), (m, count));
                block += handed.view((here, from), (m, count));
                for (other, across, width) in at {
                    let mut block = beyond.view_mut((to, across), (count, width));
                    block += handed.view((from, other), (count, width));
                }
            }
        }
        let mut statics = outer.view_mut((m, a + b), (3, base));
        statics -= self.statics;
        for (i, gap) in self.opened.iter().enumerate() {
            outer[(i, a + b + base - 1)] += gap;
        }
        if self.weak {
            let last = self.columns() - 3;
            for i in 0..3 {
                let spring = self.joint.spring[i];
                own[(m + i, m + i)] = -spring;
                outer[(m + i, last + i)] = spring;
                beyond[(last + i, last + i)] = -spring;
            }
        }
        [own, outer, beyond]
    }
}

/// The rows of a matrix that are asked for.
fn rows_of(matrix: &DMatrix<f64>, rows: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), matrix.ncols(), |i, j| matrix[(rows[i], j)])
}

impl Table {
    /// Of points that are to be given modes.
    pub fn new(points: usize) -> Self {
        let empty = || DMatrix::zeros(0, 0);
        Table {
            free: vec![true; 2 * points + 3],
            axes: vec![[1.0, 0.0]; points],
            forces: vec![1.0; 2 * points],
            turned: false,
            local: empty(),
            by_outer: empty(),
            handed: empty(),
            changes: 0,
            version: 0,
        }
    }

    /// Gives a point its directions without changing anything else, before it is condensed.
    pub fn prepare(&mut self, k: usize, mode: ContactMode, facets: Option<&[Facet]>) -> Option<()> {
        let (axis, free) = held_by(mode, facets, self.axes[k])?;
        self.set_axis(k, axis);
        (0..2).for_each(|i| self.set_free(2 * k + i, free[i]));
        Some(())
    }

    fn set_axis(&mut self, k: usize, axis: [f64; 2]) {
        self.axes[k] = axis;
        self.turned = self.axes.iter().any(|axis| *axis != [1.0, 0.0]);
    }

    fn set_free(&mut self, i: usize, free: bool) {
        self.free[i] = free;
        if let Some(force) = self.forces.get_mut(i) {
            *force = f64::from(u8::from(free));
        }
    }

    /// Condenses everything anew. `None` where that is singular.
    pub fn condense(&mut self, parts: &Parts) -> Option<()> {
        let [mut own, mut outer, beyond] = parts.equations();
        turn_rows(&mut own, &self.axes);
        own.transpose_mut();
        turn_rows(&mut own, &self.axes);
        turn_rows(&mut outer, &self.axes);
        let (free, held): (Vec<usize>, Vec<usize>) = (0..self.free.len()).partition(|i| self.free[*i]);
        let matrix = DMatrix::from_fn(free.len(), free.len(), |i, j| own[(free[i], free[j])]);
        let inverse = matrix.clone().try_inverse()?;
        let error = (product(&matrix, &inverse) - DMatrix::identity(free.len(), free.len())).amax();
        if error.is_nan() || error > INVERSE {
            return None;
        }
        let (n, own_held) = (self.free.len(), rows_of(&own, &held));
        let (by_free, by_held) = (rows_of(&outer, &free), rows_of(&outer, &held));
        let (crossing, square) = (
            DMatrix::from_fn(held.len(), free.len(), |i, j| own_held[(i, free[j])]),
            DMatrix::from_fn(held.len(), held.len(), |i, j| own_held[(i, held[j])]),
        );
        let forces = product(&inverse, &crossing.transpose());
        let solved = product(&inverse, &by_free);
        let gaps = &by_held - product(&crossing, &solved);
        let schur = square - product(&crossing, &forces);
        self.handed = beyond - row_product(&solved, &by_free);
        self.local = DMatrix::zeros(n, n);
        self.by_outer = DMatrix::zeros(n, outer.ncols());
        for (i, row) in free.iter().enumerate() {
            free.iter().enumerate().for_each(|(j, column)| self.local[(*row, *column)] = inverse[(i, j)]);
            held.iter().enumerate().for_each(|(j, column)| {
                self.local[(*row, *column)] = -forces[(i, j)];
                self.local[(*column, *row)] = forces[(i, j)];
            });
            (0..outer.ncols()).for_each(|j| self.by_outer[(*row, j)] = -solved[(i, j)]);
        }
        for (i, row) in held.iter().enumerate() {
            held.iter().enumerate().for_each(|(j, column)| self.local[(*row, *column)] = schur[(i, j)]);
            (0..outer.ncols()).for_each(|j| self.by_outer[(*row, j)] = gaps[(i, j)]);
        }
        self.changes = 0;
        self.version += 1;
        Some(())
    }

    /// The changes of what is handed on that bring a point from its mode to another, each of which is to be taken to the
    /// nodes above before the next. `None` where one loses too many digits.
    pub fn set_mode(
        &mut self,
        (system, c): (&System, usize),
        k: usize,
        mode: ContactMode,
        above: &mut dyn FnMut(Change) -> Option<()>,
    ) -> Option<()> {
        let (axis, free) = held_by(mode, system.facets[c].as_deref(), self.axes[k])?;
        let now = |table: &Table| [table.free[2 * k], table.free[2 * k + 1]];
        // Axes of a point that slides turn when both of its directions are free.
        if now(self) == [false, true] && free != now(self) {
            let direction = if free[0] { 0 } else { 1 };
            above(self.exchange(2 * k + direction)?)?;
        } else if now(self) == [false, true] && axis != self.axes[k] {
            above(self.exchange(2 * k)?)?;
        }
        if now(self)[0] == now(self)[1] {
            self.turn(k, axis);
        }
        for i in [0, 1] {
            if now(self)[i] != free[i] {
                above(self.exchange(2 * k + i)?)?;
            }
        }
        Some(())
    }

    /// Turns the axes of a point of which both directions are free, or both held.
    fn turn(&mut self, k: usize, axis: [f64; 2]) {
        let by = into_axes(self.axes[k], axis);
        if by == [1.0, 0.0] {
            return;
        }
        self.set_axis(k, axis);
        for matrix in [&mut self.local, &mut self.by_outer] {
            for mut column in matrix.column_iter_mut() {
                [column[2 * k], column[2 * k + 1]] = into_axes(by, [column[2 * k], column[2 * k + 1]]);
            }
        }
        for i in 0..self.local.nrows() {
            let turned = into_axes(by, [self.local[(i, 2 * k)], self.local[(i, 2 * k + 1)]]);
            (self.local[(i, 2 * k)], self.local[(i, 2 * k + 1)]) = (turned[0], turned[1]);
        }
    }

    /// Frees a direction that is held, or holds one that is free.
    fn exchange(&mut self, i: usize) -> Option<Change> {
        let (n, pivot) = (self.free.len(), self.local[(i, i)]);
        let kind = |j: &usize| self.free[*j] == self.free[i] && *j + 3 < n;
        let size = (0..n).filter(kind).map(|j| self.local[(j, j)]).fold(0.0, f64::max);
        if pivot.is_nan() || pivot <= PIVOT * size {
            return None;
        }
        let row = DMatrix::from_fn(n, 1, |j, _| self.local[(i, j)]);
        let mut column = self.local.columns(i, 1).clone_owned();
        let outer = self.by_outer.row(i).transpose();
        let along: Vec<f64> = outer.iter().copied().collect();
        let outer = DMatrix::from_vec(along.len(), 1, along.clone());
        column[i] = 0.0;
        let scaled = &column * (-1.0 / pivot);
        add_outer(&mut self.local, &scaled, &row);
        add_outer(&mut self.by_outer, &scaled, &outer);
        for j in 0..n {
            (self.local[(i, j)], self.local[(j, i)]) = (-row[j] / pivot, column[j] / pivot);
        }
        self.local[(i, i)] = 1.0 / pivot;
        for (j, q) in along.iter().enumerate() {
            self.by_outer[(i, j)] = -q / pivot;
        }
        let factor = if self.free[i] { 1.0 / pivot } else { -1.0 / pivot };
        add_outer(&mut self.handed, &(&outer * factor), &outer);
        self.set_free(i, !self.free[i]);
        self.changes += 1;
        self.version += 1;
        Some(Change { factor, along })
    }

    /// Takes a change of what a side hands on: over this joint's forces, in (n, t), and over the outer unknowns. Returns
    /// the change of what this node hands on.
    pub fn update(&mut self, factor: f64, own: &[f64], mut outer: Vec<f64>) -> Option<Change> {
        let n = self.free.len();
        let mut all = DMatrix::zeros(n, 1);
        for (k, axis) in self.axes.iter().enumerate() {
            [all[2 * k], all[2 * k + 1]] = into_axes(*axis, [own[2 * k], own[2 * k + 1]]);
        }
        let asked = DMatrix::from_fn(n, 1, |i, _| if self.free[i] { all[i] } else { 0.0 });
        let mut answer = DMatrix::zeros(n, 1);
        add_product(answer.as_mut_slice(), &self.local, asked.as_slice());
        let determinant = 1.0 + factor * asked.dot(&answer);
        if determinant.is_nan() || determinant.abs() < DETERMINANT {
            return None;
        }
        let factor = factor / determinant;
        let seen = row_product(&asked, &self.by_outer);
        outer.iter_mut().zip(seen.iter()).for_each(|(u, s)| *u += s);
        let along = DMatrix::from_vec(outer.len(), 1, outer);
        let gain = |i: usize| if self.free[i] { -answer[i] } else { all[i] - answer[i] };
        let left = DMatrix::from_fn(n, 1, |i, _| factor * gain(i));
        let right = DMatrix::from_fn(n, 1, |i, _| if self.free[i] { answer[i] } else { gain(i) });
        add_outer(&mut self.local, &left, &right);
        add_outer(&mut self.by_outer, &left, &along);
        add_outer(&mut self.handed, &(&along * factor), &along);
        self.changes += 1;
        self.version += 1;
        Some(Change { factor, along: along.as_slice().to_vec() })
    }

    /// What the joint does for outer unknowns.
    pub fn answer(&self, outer: &[f64], out: &mut Vec<f64>) {
        out.clear();
        out.resize(self.free.len(), 0.0);
        add_product(out, &self.by_outer, outer);
    }

    /// Force and gap of a point from what the joint does.
    pub fn point(&self, k: usize, out: &[f64]) -> [[f64; 2]; 2] {
        let (u, v, axis) = (out[2 * k], out[2 * k + 1], self.axes[k]);
        match (self.free[2 * k], self.free[2 * k + 1]) {
            (true, true) => [out_of_axes(axis, [u, v]), [0.0; 2]],
            (true, false) => [out_of_axes(axis, [u, 0.0]), out_of_axes(axis, [0.0, v])],
            (false, true) => [out_of_axes(axis, [0.0, v]), out_of_axes(axis, [u, 0.0])],
            (false, false) => [[0.0; 2], out_of_axes(axis, [u, v])],
        }
    }

    /// Forces of all points over (n, t).
    pub fn forces(&self, out: &[f64], forces: &mut Vec<f64>) {
        forces.clear();
        forces.extend(out.iter().zip(&self.forces).map(|(value, free)| value * free));
        if !self.turned {
            return;
        }
        for (axis, force) in self.axes.iter().zip(forces.chunks_exact_mut(2)).filter(|(axis, _)| **axis != [1.0, 0.0]) {
            let turned = out_of_axes(*axis, [force[0], force[1]]);
            force.copy_from_slice(&turned);
        }
    }
}
