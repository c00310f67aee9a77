//! The block tridiagonal equations of the joints: each joint stores the inverse P_e of its equations with all joints
//! before it condensed out.
//!
//! ```text
//! [M_e Ĉ_e + A_e   M_e H_e]        Ĉ_e = C_ee − C_e,e−1 [P_e−1 M_e−1] C_e−1,e
//! [H_eᵀ             −κ_e  ]  = P_e⁻¹
//! ```
//!
//! M and A: the coefficients of gaps and forces in the modes of the points. A change of a few rows of one joint changes
//! the condensed flexibility of the next one by the same rank, and so on (Sherman, Morrison & Woodbury in every joint).

use super::joint::{Joint, ModeRows};
use crate::linear::dense::{add_outer, columns_of, dot, product, row_product};
use crate::settings::SETTINGS;
use nalgebra::DMatrix;
use std::rc::Rc;

/// A joint with its equations in the present modes.
pub struct Factor {
    /// The joint, which does not depend on modes.
    pub joint: Joint,
    /// Rows of its points.
    pub rows: ModeRows,
    /// True if it has a spring.
    pub weak: bool,
    /// P.
    inverse: DMatrix<f64>,
}

/// Multiplies columns by M, in place.
pub fn ask_gaps(rows: &ModeRows, columns: &mut DMatrix<f64>) {
    for column in columns.as_mut_slice().chunks_exact_mut(2 * rows.len()) {
        for (gap, [first, second]) in column.chunks_exact_mut(2).zip(rows) {
            let [n, t] = [gap[0], gap[1]];
            (gap[0], gap[1]) = (first[2] * n + first[3] * t, second[2] * n + second[3] * t);
        }
    }
}

/// Multiplies rows, given as columns whose first entries count, by M.
fn by_gaps(rows: &ModeRows, columns: &DMatrix<f64>) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(2 * rows.len(), columns.ncols());
    for i in 0..columns.ncols() {
        for (p, [first, second]) in rows.iter().enumerate() {
            let [a, b] = [columns[(2 * p, i)], columns[(2 * p + 1, i)]];
            out[(2 * p, i)] = a * first[2] + b * second[2];
            out[(2 * p + 1, i)] = a * first[3] + b * second[3];
        }
    }
    out
}

/// Returns the inverse of a small matrix if it loses few digits.
fn small_inverse(small: DMatrix<f64>) -> Option<DMatrix<f64>> {
    small.try_inverse().filter(|inverse| inverse.amax() < SETTINGS.largest_inverse())
}

impl Factor {
    /// Creates a joint without factorisation.
    pub fn new(joint: Joint) -> Self {
        let n = joint.size();
        Factor { joint, rows: Vec::new(), weak: false, inverse: DMatrix::zeros(n, n) }
    }

    fn forces(&self) -> usize {
        2 * self.rows.len()
    }

    /// Returns Ĉ.
    fn flexibility(&self, before: Option<&Factor>) -> DMatrix<f64> {
        let own: &DMatrix<f64> = &self.joint.own;
        let beside = before.and_then(|b| Some((b, self.joint.before.as_deref()?, b.joint.after.as_deref()?)));
        let Some((before, block, back)) = beside else { return own.clone() };
        let mut asked = back.clone();
        ask_gaps(&before.rows, &mut asked);
        let m = before.forces();
        own - block * (before.inverse.view((0, 0), (m, m)) * asked)
    }

    /// Returns two rows of Ĉ and H, as columns.
    fn flexibility_of(&self, point: usize, before: Option<&Factor>) -> DMatrix<f64> {
        let m = self.forces();
        let mut own = columns_of(&self.joint.rows, 2 * point, 2);
        let beside = before.and_then(|b| Some((b, self.joint.before.as_ref()?, b.joint.after.as_ref()?)));
        if let Some((before, block, back)) = beside {
            let rows = DMatrix::from_fn(before.forces(), 2, |j, i| block[(2 * point + i, j)]);
            let handed = by_gaps(&before.rows, &row_product(&rows, &before.inverse));
            let seen = row_product(&handed, back);
            (0..2).for_each(|i| (0..m).for_each(|j| own[(j, i)] -= seen[(j, i)]));
        }
        own
    }

    /// Factorises with the joint before it. `None` if the matrix is singular.
    fn factorise(&mut self, before: Option<&Factor>) -> Option<()> {
        // Without coupling, the equations of congruent joints are the same.
        let equations =
            |f: &Factor| (f.weak, Rc::as_ptr(&f.joint.own), Rc::as_ptr(&f.joint.by_twist), f.joint.before.is_some());
        let same = |other: &&Factor| equations(other) == equations(self) && other.rows == self.rows;
        if let Some(other) = before.filter(same).filter(|other| other.joint.before.is_none()) {
            self.inverse.clone_from(&other.inverse);
            return Some(());
        }
        let (m, n) = (self.forces(), self.joint.size());
        let flexibility = self.flexibility(before);
        let mut matrix = DMatrix::zeros(n, n);
        for (p, rows) in self.rows.iter().enumerate() {
            for (i, row) in rows.iter().enumerate() {
                for j in 0..n {
                    let gap = |k: usize| match j < m {
                        true => flexibility[(2 * p + k, j)],
                        false => self.joint.by_twist[(2 * p + k, j - m)],
                    };
                    matrix[(2 * p + i, j)] = row[2] * gap(0) + row[3] * gap(1);
                }
                (0..2).for_each(|t| matrix[(2 * p + i, 2 * p + t)] += row[t]);
            }
        }
        for k in 0..3 {
            (0..m).for_each(|j| matrix[(m + k, j)] = self.joint.by_twist[(j, k)]);
            matrix[(m + k, m + k)] = if self.weak { -self.joint.spring[k] } else { 0.0 };
        }
        let inverse = matrix.clone().try_inverse()?;
        let error = (matrix * &inverse - DMatrix::identity(n, n)).amax();
        self.inverse = inverse;
        (0..self.rows.len()).for_each(|point| self.clear(point));
        (error < SETTINGS.active).then_some(())
    }

    /// Sets the rows of a point without force to exact zeros, so that products skip them.
    fn clear(&mut self, point: usize) {
        if self.rows[point] == [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]] {
            for j in 0..self.inverse.ncols() {
                (0..2).for_each(|i| self.inverse[(2 * point + i, j)] = f64::from(u8::from(j == 2 * point + i)));
            }
        }
    }

    /// Returns P M y for y at the points.
    fn solve_gaps(&self, mut gaps: DMatrix<f64>) -> DMatrix<f64> {
        ask_gaps(&self.rows, &mut gaps);
        product(&self.inverse, &gaps)
    }
}

/// A change of rows of a joint: first row and number, the change, and the change of M at a point.
struct RowChange {
    first: usize,
    /// The change, as columns.
    by: DMatrix<f64>,
    gaps: Option<[[f64; 4]; 2]>,
}

/// All joints.
pub struct Factors {
    /// Joints in their order.
    pub all: Vec<Factor>,
}

/// Columns over a range of joints.
pub struct Window {
    /// The first joint.
    pub first: usize,
    /// Columns of this joint and the following ones.
    pub columns: Vec<DMatrix<f64>>,
}

impl Factors {
    /// Factorises all joints. `None` if one is singular.
    pub fn factorise(&mut self) -> Option<()> {
        for e in 0..self.all.len() {
            let (done, rest) = self.all.split_at_mut(e);
            rest[0].factorise(done.last())?;
        }
        Some(())
    }

    fn before(&self, e: usize) -> Option<&Factor> {
        e.checked_sub(1).map(|b| &self.all[b])
    }

    /// Replaces the rows of a point of a joint. `None` if that loses too many digits.
    pub fn set_rows(&mut self, e: usize, point: usize, rows: [[f64; 4]; 2]) -> Option<()> {
        let factor = &self.all[e];
        let difference = [0, 1].map(|i| [0, 1, 2, 3].map(|t| rows[i][t] - factor.rows[point][i][t]));
        let gaps = factor.flexibility_of(point, self.before(e));
        let mut by = DMatrix::zeros(factor.joint.size(), 2);
        for (i, row) in difference.iter().enumerate() {
            (0..by.nrows()).for_each(|j| by[(j, i)] = row[2] * gaps[(j, 0)] + row[3] * gaps[(j, 1)]);
            (0..2).for_each(|t| by[(2 * point + t, i)] += row[t]);
        }
        self.update(e, &RowChange { first: 2 * point, by, gaps: Some(difference) })?;
        self.all[e].rows[point] = rows;
        self.all[e].clear(point);
        Some(())
    }

    /// Adds a spring to a joint.
    pub fn set_weak(&mut self, e: usize) -> Option<()> {
        let (m, n) = (self.all[e].forces(), self.all[e].joint.size());
        let mut by = DMatrix::zeros(n, 3);
        (0..3).for_each(|k| by[(m + k, k)] = -self.all[e].joint.spring[k]);
        self.update(e, &RowChange { first: m, by, gaps: None })?;
        self.all[e].weak = true;
        Some(())
    }

    fn update(&mut self, e: usize, change: &RowChange) -> Option<()> {
        let factor = &mut self.all[e];
        let (m, q) = (factor.forces(), change.by.ncols());
        let columns = columns_of(&factor.inverse, change.first, q);
        let small = DMatrix::identity(q, q) + change.by.transpose() * &columns;
        let by = row_product(&change.by, &factor.inverse);
        let left = columns * small_inverse(small)?;
        add_outer(&mut factor.inverse, &-&left, &by);
        if factor.joint.after.is_none() {
            return Some(());
        }
        let mut right = -by_gaps(&factor.rows, &by);
        if let Some(gaps) = &change.gaps {
            for (i, row) in gaps.iter().enumerate() {
                (0..2).for_each(|t| right[(change.first + t, i)] += row[2 + t]);
            }
        }
        self.hand_on(e, left.rows(0, m).clone_owned(), right)
    }

    /// Passes a change a bᵀ of P M at the points of a joint to the following joints.
    fn hand_on(&mut self, e: usize, mut left: DMatrix<f64>, mut right: DMatrix<f64>) -> Option<()> {
        let least = SETTINGS.negligible() * left.amax() * right.amax();
        let q = left.ncols();
        for j in e + 1..self.all.len() {
            let (done, rest) = self.all.split_at_mut(j);
            let factor = &mut rest[0];
            let Some((block, back)) = factor.joint.before.as_ref().zip(done[j - 1].joint.after.as_ref()) else { break };
            let m = 2 * factor.rows.len();
            let columns = factor.solve_gaps(product(block, &left));
            let rows = row_product(&right, back);
            let by = row_product(&rows, &factor.inverse);
            let small = DMatrix::from_fn(q, q, |a, b| {
                f64::from(u8::from(a == b)) - dot(rows.column(a).as_slice(), &columns.column(b).as_slice()[..m])
            });
            let columns = columns * small_inverse(small)?;
            add_outer(&mut factor.inverse, &columns, &by);
            left = columns.rows(0, m).clone_owned();
            right = by_gaps(&factor.rows, &by);
            if left.amax() * right.amax() <= least {
                break;
            }
        }
        Some(())
    }

    /// Returns the response to unit right-hand sides of some rows of a joint, up to the joint where it becomes
    /// negligible.
    pub fn respond(&self, e: usize, first: usize, count: usize) -> Window {
        let mut ahead = vec![columns_of(&self.all[e].inverse, first, count)];
        let least = SETTINGS.negligible() * ahead[0].amax();
        for j in e + 1..self.all.len() {
            let Some(block) = &self.all[j].joint.before else { break };
            let columns = -self.all[j].solve_gaps(product(block, &ahead[j - 1 - e]));
            let dies = columns.amax() <= least;
            ahead.push(columns);
            if dies {
                break;
            }
        }
        for i in (0..ahead.len() - 1).rev() {
            if let Some(own) = self.by_next(e + i, &ahead[i + 1]) {
                ahead[i] -= own;
            }
        }
        let mut behind: Vec<DMatrix<f64>> = Vec::new();
        for j in (0..e).rev() {
            let Some(columns) = self.by_next(j, behind.last().unwrap_or(&ahead[0])) else { break };
            let columns = -columns;
            let dies = columns.amax() <= least;
            behind.push(columns);
            if dies {
                break;
            }
        }
        let start = e - behind.len();
        behind.reverse();
        behind.append(&mut ahead);
        Window { first: start, columns: behind }
    }

    /// Returns P M C x for x of the next joint.
    fn by_next(&self, e: usize, next: &DMatrix<f64>) -> Option<DMatrix<f64>> {
        let block = self.all[e].joint.after.as_ref()?;
        Some(self.all[e].solve_gaps(product(block, next)))
    }

    /// Solves for several right-hand sides of all rows, joint by joint.
    pub fn solve(&self, right: Vec<DMatrix<f64>>) -> Vec<DMatrix<f64>> {
        let mut all: Vec<DMatrix<f64>> = Vec::with_capacity(right.len());
        for (e, mut right) in right.into_iter().enumerate() {
            let factor = &self.all[e];
            if let (Some(block), Some(before)) = (&factor.joint.before, all.last()) {
                let mut gaps = product(block, before);
                ask_gaps(&factor.rows, &mut gaps);
                let mut points = right.rows_mut(0, factor.forces());
                points -= gaps;
            }
            all.push(product(&factor.inverse, &right));
        }
        for e in (0..all.len().saturating_sub(1)).rev() {
            if let Some(own) = self.by_next(e, &all[e + 1]) {
                all[e] -= own;
            }
        }
        all
    }
}
