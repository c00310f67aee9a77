//! One factorisation for many pivots: contact points whose regime has changed since enter by their
//! two rows (Sherman, Morrison & Woodbury), and where that leaves residuals the matrix is factorised
//! anew. The matrix is the shifted one of [`super::system`]: strictly monotone where flow is
//! associated, so that no combination of regimes is without a direction.

use super::kinematics::Curvature;
use super::law::Regime;
use super::model::Model;
use super::system::SHIFT;
use crate::lu::SparseLu;
use nalgebra::{DMatrix, DVector};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// Changed points above which the matrix is factorised anew.
const FRESH: usize = 24;
/// Relative residual above which it is.
const RESIDUAL: f64 = 1e-9;

/// A sparse row.
type Row = Vec<(usize, f64)>;

/// Rows of the equations, in units, and a factorisation.
pub(super) struct Frame {
    size: usize,
    /// Rows of the gaps, two per contact point.
    gaps: Vec<Row>,
    /// Rows of the bodies and of the control.
    rest: Vec<Row>,
    regimes: Vec<Regime>,
    rows: Vec<[Row; 2]>,
    factors: Option<SparseLu>,
    columns: BTreeMap<usize, [Vec<f64>; 2]>,
}

fn along(row: &Row, x: &[f64]) -> f64 {
    row.iter().map(|&(j, v)| v * x[j]).sum()
}

impl Frame {
    /// Rows of the equations with a control.
    pub fn new(model: &Model, curvature: &Curvature, control: &[f64]) -> Frame {
        let (points, size) = (model.problem.contacts.len(), model.size());
        let (u, last) = (model.units, size - 1);
        let mut gaps = vec![Row::new(); 2 * points];
        let mut rest = vec![Row::new(); size - 2 * points];
        let row_unit = |i: usize| if (i - 2 * points) % 3 == 2 { u.force * u.length } else { u.force };
        let mut place = |i: usize, column: usize, value: f64| {
            if i < 2 * points {
                gaps[i].push((column, value / u.displacement));
            } else if let Some((row, _)) = model.column(i) {
                rest[row - 2 * points].push((column, value / row_unit(i)));
            }
        };
        for &(i, j, value) in &curvature.entries {
            if let Some((column, unit)) = model.column(j) {
                place(i, column, value * unit);
            }
        }
        for (i, value) in curvature.factor.iter().enumerate().filter(|(_, v)| **v != 0.0) {
            place(i, last, value * u.factor);
        }
        for (k, row) in rest.iter_mut().enumerate().take(last - 2 * points) {
            row.push((2 * points + k, -SHIFT));
        }
        rest[last - 2 * points] = control.iter().copied().enumerate().filter(|(_, v)| *v != 0.0).collect();
        let merged = |row: &mut Row| {
            row.sort_by_key(|e| e.0);
            row.dedup_by(|b, a| {
                let same = a.0 == b.0;
                if same {
                    a.1 += b.1;
                }
                same
            });
        };
        gaps.iter_mut().chain(rest.iter_mut()).for_each(merged);
        let rows = vec![[Row::new(), Row::new()]; points];
        Frame { size, gaps, rest, regimes: vec![Regime::Stuck; points], rows, factors: None, columns: BTreeMap::new() }
    }

    /// The two rows of a contact point in a regime.
    fn rows_of(&self, model: &Model, c: usize, regime: Regime) -> [Row; 2] {
        let gap = [&self.gaps[2 * c], &self.gaps[2 * c + 1]];
        match (regime, model.law(c)) {
            (Regime::Facet(i), Some(law)) => {
                let f = &law.facets[i as usize];
                let d = f.flow;
                let square = d[0] * d[0] + d[1] * d[1];
                let mut yields: Row = vec![(2 * c, f.normal[0]), (2 * c + 1, f.normal[1])];
                let mut across = Row::new();
                for k in 0..2 {
                    yields.extend(gap[k].iter().map(|&(j, v)| (j, SHIFT * d[k] / square * v)));
                    let weight = if k == 0 { d[1] } else { -d[0] };
                    across.extend(gap[k].iter().map(|&(j, v)| (j, weight * v)));
                }
                [yields, across]
            }
            (Regime::Corner(_), Some(_)) => [0, 1].map(|k| {
                let mut row: Row = vec![(2 * c + k, 1.0)];
                row.extend(gap[k].iter().map(|&(j, v)| (j, SHIFT * v)));
                row
            }),
            _ => [0, 1].map(|k| {
                let mut row = gap[k].clone();
                row.push((2 * c + k, SHIFT));
                row
            }),
        }
    }

    fn factorise(&mut self, model: &Model, regimes: &[Regime]) -> Option<()> {
        self.regimes = regimes.to_vec();
        self.columns.clear();
        let mut entries = Vec::new();
        for (c, regime) in regimes.iter().enumerate() {
            self.rows[c] = self.rows_of(model, c, *regime);
            for (k, row) in self.rows[c].iter().enumerate() {
                entries.extend(row.iter().map(|&(j, v)| (2 * c + k, j, v)));
            }
        }
        for (k, row) in self.rest.iter().enumerate() {
            entries.extend(row.iter().map(|&(j, v)| (2 * regimes.len() + k, j, v)));
        }
        self.factors = Some(SparseLu::new(self.size, &entries)?);
        Some(())
    }

    /// Solves with regimes; how many factorisations that took.
    pub fn solve(&mut self, model: &Model, regimes: &[Regime], right: &[f64]) -> Option<(Vec<f64>, u64)> {
        let changed: Vec<usize> = (0..regimes.len()).filter(|c| regimes[*c] != self.regimes[*c]).collect();
        if self.factors.is_some()
            && changed.len() <= FRESH
            && let Some(x) = self.updated(model, regimes, &changed, right)
        {
            return Some((x, 0));
        }
        self.factorise(model, regimes)?;
        let x = self.factors.as_ref()?.solve(&[right.to_vec()], 1)?.swap_remove(0);
        Some((x, 1))
    }

    /// By the changed rows; `None` where that leaves residuals.
    fn updated(&mut self, model: &Model, regimes: &[Regime], changed: &[usize], right: &[f64]) -> Option<Vec<f64>> {
        let factors = self.factors.as_ref()?;
        let unit = |row: usize| {
            let mut e = vec![0.0; self.size];
            e[row] = 1.0;
            e
        };
        for &c in changed {
            if let Entry::Vacant(column) = self.columns.entry(c) {
                let mut x = factors.solve(&[unit(2 * c), unit(2 * c + 1)], 0)?.into_iter();
                column.insert([x.next()?, x.next()?]);
            }
        }
        let new: Vec<[Row; 2]> = changed.iter().map(|c| self.rows_of(model, *c, regimes[*c])).collect();
        let columns: Vec<&Vec<f64>> = changed.iter().flat_map(|c| &self.columns[c]).collect();
        let difference =
            |i: usize, x: &[f64]| along(&new[i / 2][i % 2], x) - along(&self.rows[changed[i / 2]][i % 2], x);
        let n = 2 * changed.len();
        let small = DMatrix::from_fn(n, n, |i, j| f64::from(u8::from(i == j)) + difference(i, columns[j])).lu();
        let product = |x: &[f64]| -> Vec<f64> {
            let mut out = vec![0.0; self.size];
            for (c, rows) in self.rows.iter().enumerate() {
                (0..2).for_each(|k| out[2 * c + k] = along(&rows[k], x));
            }
            for (c, rows) in changed.iter().zip(&new) {
                (0..2).for_each(|k| out[2 * c + k] = along(&rows[k], x));
            }
            let base = 2 * self.rows.len();
            for (k, row) in self.rest.iter().enumerate() {
                out[base + k] = along(row, x);
            }
            out
        };
        let apply = |right: &[f64]| -> Option<Vec<f64>> {
            let mut x = factors.solve(&[right.to_vec()], 0)?.swap_remove(0);
            if n > 0 {
                let by = small.solve(&DVector::from_fn(n, |i, _| difference(i, &x)))?;
                for (column, w) in columns.iter().zip(by.iter()) {
                    x.iter_mut().zip(column.iter()).for_each(|(x, y)| *x -= w * y);
                }
            }
            Some(x)
        };
        let left = |x: &[f64]| -> Vec<f64> { right.iter().zip(product(x)).map(|(b, p)| b - p).collect() };
        let norm = |v: &[f64]| v.iter().fold(0.0, |a: f64, b| if b.is_nan() { f64::NAN } else { a.max(b.abs()) });
        let mut x = apply(right)?;
        let rest = left(&x);
        let bound = RESIDUAL * norm(right);
        if norm(&rest) <= bound {
            return Some(x);
        }
        let step = apply(&rest)?;
        x.iter_mut().zip(&step).for_each(|(x, s)| *x += s);
        (norm(&left(&x)) <= bound).then_some(x)
    }
}
