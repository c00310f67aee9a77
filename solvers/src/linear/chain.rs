//! Equations of contact points and bodies along a chain of elastic bodies, factorised by fronts.
//!
//! The two rows of a contact point are combinations of its forces and its gaps, and are not stored:
//!
//! ```text
//! P r_c + S g_c = f_c        g = C r + G q + g_λ λ
//! ```
//!
//! The rows of the bodies and one more row follow. Blocks of C are added to fronts column by column; residuals use
//! products with C. Points without gaps in their rows (open points, S = 0) are condensed out: r_c = P⁻¹ f_c. The soft
//! spring that is added to them between two bodies is added to the rows of the bodies. Residuals do not contain the
//! added terms.

use super::blocks::GapRows;
use super::condensed::inverse;
use super::csr::CsrMatrix;
use super::factorised::{Factorised, row_error};
use std::rc::Rc;
use voussoir_core::linear::{FrontRows, FrontalLu};

/// Coefficients of the two rows of a contact point for its forces and gaps, and the added terms.
#[derive(Debug, Clone, Copy, Default)]
pub struct PointRows {
    /// P.
    pub force: [[f64; 2]; 2],
    /// S.
    pub gap: [[f64; 2]; 2],
    /// Added to P.
    pub force_shift: [[f64; 2]; 2],
    /// Added to S.
    pub gap_shift: [[f64; 2]; 2],
}

/// Rows of the bodies, with the terms added to their diagonal.
#[derive(Debug, Clone)]
pub struct BodyRows {
    /// Over all unknowns.
    pub rows: Rc<CsrMatrix>,
    /// Term added to the diagonal; it is part of the equations.
    pub diagonal: f64,
    /// Term added to the diagonal; refinement removes it.
    pub shift: f64,
}

/// Rows of contact points and of bodies: all equations but the last one.
pub struct ChainRows {
    /// Gaps as functions of all unknowns.
    pub gaps: Rc<GapRows>,
    /// Rows of the bodies.
    pub bodies: BodyRows,
    /// Rows of every contact point.
    pub points: Vec<PointRows>,
}

struct Equations {
    above: ChainRows,
    /// The last row.
    last: Vec<(usize, f64)>,
    /// P⁻¹ of points that are condensed out.
    inverse: Vec<Option<[[f64; 2]; 2]>>,
    /// Rows of the bodies and the last row, over the places of kept unknowns, with the added terms.
    reduced: CsrMatrix,
    /// Places of the kept forces of every group of points.
    forces_of: Vec<std::ops::Range<usize>>,
    /// Unknowns that are not condensed out.
    kept: Vec<usize>,
    /// Place of every unknown; `usize::MAX` if it is condensed out.
    place: Vec<usize>,
}

/// Factorised equations along a chain.
pub struct ChainFactors {
    equations: Equations,
    factors: FrontalLu,
}

/// Returns P⁻¹ of a point without gaps in its rows.
fn own_inverse(rows: &PointRows) -> Option<[[f64; 2]; 2]> {
    if rows.gap == [[0.0; 2]; 2] { inverse(rows.force) } else { None }
}

impl ChainRows {
    fn forces(&self) -> usize {
        2 * self.points.len()
    }

    /// Returns the products of the two rows of a contact point with all unknowns, with the added terms if `shifted`.
    pub fn point(&self, contact: usize, x: &[f64], shifted: bool) -> [f64; 2] {
        let rows = &self.points[contact];
        let gap = [0, 1].map(|l| self.gaps.row_dot(2 * contact + l, x));
        let added = f64::from(u8::from(shifted));
        [0, 1].map(|k| {
            let term = |l: usize| {
                let [force, gap_weight] =
                    [rows.force[k][l] + added * rows.force_shift[k][l], rows.gap[k][l] + added * rows.gap_shift[k][l]];
                force * x[2 * contact + l] + gap_weight * gap[l]
            };
            term(0) + term(1)
        })
    }

    /// Returns the residual of the rows for a right-hand side.
    pub fn left(&self, right: &[f64], x: &[f64]) -> Vec<f64> {
        let gap = self.gaps.product(x);
        let mut left = Vec::with_capacity(right.len());
        for (c, rows) in self.points.iter().enumerate() {
            let [force, gap] = [&x[2 * c..2 * c + 2], &gap[2 * c..2 * c + 2]];
            left.extend([0, 1].map(|k| {
                let [p, s] = [rows.force[k], rows.gap[k]];
                right[2 * c + k] - p[0] * force[0] - p[1] * force[1] - s[0] * gap[0] - s[1] * gap[1]
            }));
        }
        let forces = self.forces();
        left.extend(
            (0..self.bodies.rows.len())
                .map(|i| right[forces + i] - self.bodies.diagonal * x[forces + i] - self.bodies.rows.row_dot(i, x)),
        );
        left
    }

    /// Returns the residual and the greatest backward error of a row.
    pub fn errors(&self, right: &[f64], x: &[f64]) -> (Vec<f64>, f64) {
        let (gap, gap_sizes) = self.gaps.product_and_sizes(x);
        let mut left = Vec::with_capacity(right.len());
        let mut worst = 0.0f64;
        let mut take = |rest: f64, size: f64| {
            worst = worst.max(row_error(rest, size));
            left.push(rest);
        };
        for (c, rows) in self.points.iter().enumerate() {
            for k in 0..2 {
                let (mut rest, mut size) = (right[2 * c + k], right[2 * c + k].abs());
                for l in 0..2 {
                    let (own, of_gap) = (rows.force[k][l] * x[2 * c + l], rows.gap[k][l]);
                    rest -= own + of_gap * gap[2 * c + l];
                    size += own.abs() + of_gap.abs() * gap_sizes[2 * c + l];
                }
                take(rest, size);
            }
        }
        let forces = self.forces();
        for i in 0..self.bodies.rows.len() {
            let damped = self.bodies.diagonal * x[forces + i];
            let (rest, size) = self.bodies.rows.left_of_row(i, right[forces + i] - damped, x);
            take(rest, size + damped.abs());
        }
        (left, worst)
    }
}

impl Equations {
    fn forces(&self) -> usize {
        self.above.forces()
    }

    /// Visits the entries of a weighted sum of both rows of a contact point for unknowns that are not forces.
    fn others(&self, contact: usize, weights: [f64; 2], mut each: impl FnMut(usize, f64)) {
        for (k, weight) in weights.into_iter().enumerate().filter(|(_, weight)| *weight != 0.0) {
            for &(j, v) in self.above.gaps.others.row(2 * contact + k) {
                let value = weight * v;
                if value != 0.0 {
                    each(j, value);
                }
            }
        }
    }

    /// Returns the weights of the gaps in a row of a point, with the added terms.
    fn gap_weights(&self, i: usize) -> [f64; 2] {
        let (rows, k) = (&self.above.points[i / 2], i % 2);
        [rows.gap[k][0] + rows.gap_shift[k][0], rows.gap[k][1] + rows.gap_shift[k][1]]
    }

    /// Returns the weights of the gaps of a condensed point that its added spring gives in a row of a body. `factors`
    /// are the coefficients of the point's forces in that row.
    fn condensed(&self, contact: usize, factors: [f64; 2]) -> Option<[f64; 2]> {
        let (inverse, rows) = (self.inverse[contact]?, &self.above.points[contact]);
        let by = [0, 1].map(|i| factors[0] * inverse[0][i] + factors[1] * inverse[1][i]);
        Some([0, 1].map(|k| -(by[0] * rows.gap_shift[0][k] + by[1] * rows.gap_shift[1][k])))
    }

    /// Returns the rows of the bodies and the last row over kept unknowns.
    fn reduced_rows(&self) -> CsrMatrix {
        let forces = self.forces();
        let mut rows = CsrMatrix::with_capacity(self.above.bodies.rows.entries());
        let mut sum = vec![0.0; self.kept.len()];
        let mut met = vec![usize::MAX; self.kept.len()];
        for i in 0..self.above.bodies.rows.len() {
            let row = rows.open_row();
            let begin = row.len();
            let mut add = |j: usize, v: f64| {
                let at = self.place[j];
                if met[at] != i {
                    (met[at], sum[at]) = (i, 0.0);
                    row.push((at, 0.0));
                }
                sum[at] += v;
            };
            for &(j, v) in self.above.bodies.rows.row(i) {
                if self.place[j] != usize::MAX {
                    add(j, v);
                } else if let Some(weights) = self.condensed(j / 2, if j % 2 == 0 { [v, 0.0] } else { [0.0, v] }) {
                    self.others(j / 2, weights, &mut add);
                }
            }
            add(forces + i, self.above.bodies.diagonal + self.above.bodies.shift);
            row[begin..].iter_mut().for_each(|entry| entry.1 = sum[entry.0]);
            rows.end_row();
        }
        let last = self.last.iter().map(|&(j, v)| (self.place[j], v));
        rows.open_row().extend(last.filter(|e| e.0 != usize::MAX));
        rows.end_row();
        rows
    }

    /// Returns a row of the bodies, or the last row, over kept unknowns by its place.
    fn row(&self, place: usize) -> &[(usize, f64)] {
        self.reduced.row(self.kept[place] - self.forces())
    }

    /// Returns the places of the forces of the point of a row.
    fn own_places(&self, i: usize) -> impl Iterator<Item = usize> {
        let own = i - i % 2;
        [self.place[own], self.place[own + 1]].into_iter().filter(|j| *j != usize::MAX)
    }

    /// Returns the sequences of rows that belong to points of one group: start and rows.
    fn runs<'r>(&'r self, rows: &'r [usize]) -> impl Iterator<Item = (usize, &'r [usize])> {
        let pattern = self.above.gaps.forces.pattern();
        let group = |k: &usize| Some(self.kept[*k]).filter(|i| *i < self.forces()).map(|i| pattern.group(i / 2));
        let mut first = 0;
        rows.chunk_by(move |a, b| group(a).is_some() && group(a) == group(b)).map(move |run| {
            first += run.len();
            (first - run.len(), run)
        })
    }
}

impl FrontRows for Equations {
    fn candidates(&self, row: usize, each: &mut dyn FnMut(usize)) {
        let i = self.kept[row];
        if i >= self.forces() {
            return self.row(row).iter().for_each(|entry| each(entry.0));
        }
        self.own_places(i).for_each(&mut *each);
        let weights = self.gap_weights(i);
        if weights == [0.0; 2] {
            return;
        }
        // All unknowns of a group have the same rank.
        let pattern = self.above.gaps.forces.pattern();
        pattern
            .beside(pattern.group(i / 2))
            .filter_map(|group| self.forces_of[group].clone().next())
            .for_each(&mut *each);
        self.others(i / 2, weights, |j, _| each(self.place[j]));
    }

    fn unknowns(&self, rows: &[usize], each: &mut dyn FnMut(usize)) {
        let pattern = self.above.gaps.forces.pattern();
        for (_, run) in self.runs(rows) {
            let first = self.kept[run[0]];
            if first >= self.forces() {
                run.iter().for_each(|row| self.row(*row).iter().for_each(|entry| each(entry.0)));
                continue;
            }
            if run.iter().any(|k| self.gap_weights(self.kept[*k]) != [0.0; 2]) {
                pattern
                    .beside(pattern.group(first / 2))
                    .flat_map(|group| self.forces_of[group].clone())
                    .for_each(&mut *each);
            }
            for i in run.iter().map(|k| self.kept[*k]) {
                self.own_places(i).for_each(&mut *each);
                self.others(i / 2, self.gap_weights(i), |j, _| each(self.place[j]));
            }
        }
    }

    fn add(&self, rows: &[usize], place: &[usize], values: &mut [f64], height: usize, first: usize) {
        for (begin, run) in self.runs(rows) {
            let (top, lead) = (first + begin, self.kept[run[0]]);
            if lead >= self.forces() {
                for (k, row) in run.iter().enumerate() {
                    self.row(*row).iter().for_each(|&(j, v)| values[place[j] * height + top + k] += v);
                }
                continue;
            }
            let group = self.above.gaps.forces.pattern().group(lead / 2);
            let start = self.above.gaps.forces.pattern().contacts(group).start;
            let combined: Vec<(usize, [f64; 2])> =
                run.iter().map(|row| (2 * (self.kept[*row] / 2 - start), self.gap_weights(self.kept[*row]))).collect();
            for (j, column) in self.above.gaps.forces.columns(group).filter(|(j, _)| self.place[*j] != usize::MAX) {
                let target = &mut values[place[self.place[j]] * height + top..][..run.len()];
                for (target, (row, [a, b])) in target.iter_mut().zip(&combined) {
                    *target += a * column[*row] + b * column[row + 1];
                }
            }
            for (k, row) in run.iter().enumerate() {
                let (i, mut add) = (self.kept[*row], |j: usize, v: f64| values[place[j] * height + top + k] += v);
                let (c, weights, rows) = (i / 2, self.gap_weights(i), &self.above.points[i / 2]);
                for (l, weight) in weights.into_iter().enumerate().filter(|(l, _)| self.place[2 * c + l] != usize::MAX)
                {
                    let own = rows.force[i % 2][l] + rows.force_shift[i % 2][l];
                    add(self.place[2 * c + l], own + weight * self.above.gaps.forces.diagonal(2 * c + l));
                }
                self.others(c, weights, |j, v| add(self.place[j], v));
            }
        }
    }
}

impl ChainFactors {
    /// Factorises the rows of contact points, the rows of bodies and the `last` row. `chain` has the rank of every
    /// unknown except the last one, which is eliminated at the end. `None` if the pattern is singular.
    pub fn new(above: ChainRows, last: Vec<(usize, f64)>, chain: &[usize]) -> Option<Self> {
        let forces = above.forces();
        let size = forces + above.bodies.rows.len() + 1;
        let inverse: Vec<_> = above.points.iter().map(own_inverse).collect();
        let kept: Vec<usize> = (0..size).filter(|i| *i >= forces || inverse[i / 2].is_none()).collect();
        let mut place = vec![usize::MAX; size];
        kept.iter().enumerate().for_each(|(k, i)| place[*i] = k);
        let end = chain.iter().copied().max().unwrap_or(0);
        let rank: Vec<usize> = kept.iter().map(|i| chain.get(*i).copied().unwrap_or(end)).collect();
        let pattern = above.gaps.forces.pattern();
        let mut of = 0;
        let forces_of = (0..pattern.groups()).map(|group| {
            let kept = pattern.contacts(group).filter(|c| inverse[*c].is_none()).count();
            of += 2 * kept;
            of - 2 * kept..of
        });
        let forces_of = forces_of.collect();
        let reduced = CsrMatrix::empty(0);
        let mut equations = Equations { above, last, inverse, reduced, forces_of, kept, place };
        equations.reduced = equations.reduced_rows();
        let factors = FrontalLu::of(equations.kept.len(), &equations, &rank)?;
        Some(ChainFactors { equations, factors })
    }

    /// Returns the products of the factorised rows of a contact point with all unknowns.
    pub fn point(&self, contact: usize, x: &[f64]) -> [f64; 2] {
        let own = &self.equations;
        own.above.point(contact, x, own.inverse[contact].is_none())
    }

    /// Subtracts the effect of condensed forces from a right-hand side and returns its kept rows.
    fn without(&self, right: &[f64], x: &[f64]) -> Vec<f64> {
        let own = &self.equations;
        let (above, forces) = (&own.above, own.forces());
        let mut gap = vec![0.0; forces];
        above.gaps.forces.add_product(&x[..forces], &mut gap);
        let left = |i: &usize| match *i {
            i if i < forces => {
                let row = above.points[i / 2].gap[i % 2];
                right[i] - row[0] * gap[i - i % 2] - row[1] * gap[i - i % 2 + 1]
            }
            i if i + 1 < x.len() => right[i] - above.bodies.rows.row_dot(i - forces, x),
            i => right[i] - self.last_row_dot(x),
        };
        own.kept.iter().map(left).collect()
    }

    /// Returns the unknowns after the contact forces, for right-hand sides that are zero in the rows of contact points.
    pub fn motions(&self, rights: &[Vec<f64>]) -> Option<Vec<Vec<f64>>> {
        let own = &self.equations;
        let of_kept = |right: &Vec<f64>| own.kept.iter().map(|i| right[*i]).collect();
        let solved = self.factors.solve(&rights.iter().map(of_kept).collect::<Vec<_>>())?;
        let motions = own.forces()..own.place.len();
        Some(solved.iter().map(|y| motions.clone().map(|j| y[own.place[j]]).collect()).collect())
    }
}

impl Factorised for ChainFactors {
    fn apply(&self, right: &[f64]) -> Option<Vec<f64>> {
        let own = &self.equations;
        let mut x = vec![0.0; right.len()];
        for (c, inverse) in own.inverse.iter().enumerate() {
            if let Some(a) = inverse {
                let f = [right[2 * c], right[2 * c + 1]];
                (0..2).for_each(|k| x[2 * c + k] = a[k][0] * f[0] + a[k][1] * f[1]);
            }
        }
        let reduced: Vec<f64> = match x.iter().any(|v| *v != 0.0) {
            true => self.without(right, &x),
            false => own.kept.iter().map(|i| right[*i]).collect(),
        };
        let y = self.factors.solve(&[reduced])?.swap_remove(0);
        own.kept.iter().zip(&y).for_each(|(i, y)| x[*i] = *y);
        Some(x)
    }

    fn errors(&self, right: &[f64], x: &[f64]) -> (Vec<f64>, f64) {
        let own = &self.equations;
        let (mut left, worst) = own.above.errors(right, x);
        let products = || own.last.iter().map(|&(j, v)| v * x[j]);
        let last = right[right.len() - 1];
        let (rest, size) = (last - products().sum::<f64>(), last.abs() + products().map(f64::abs).sum::<f64>());
        left.push(rest);
        (left, worst.max(row_error(rest, size)))
    }

    fn last_row_dot(&self, x: &[f64]) -> f64 {
        self.equations.last.iter().map(|&(j, v)| v * x[j]).sum()
    }
}
