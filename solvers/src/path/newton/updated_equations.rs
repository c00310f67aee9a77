//! One factorisation for many pivots: contact points whose mode has changed since enter by their
//! two rows (Sherman, Morrison & Woodbury), and where many have, or where that leaves residuals, the
//! matrix is factorised anew.
//!
//! ```text
//! B x_0 = f     B Y = [e_i]     (1 + D Y) w = D x_0     x = x_0 − Y w
//! ```
//!
//! B: rows of the modes that were factorised, D: what the rows i of changed points are more than
//! those of B. x_0 and the columns of Y are kept without the forces that [`condensed`](crate::linear::condensed)
//! takes out, and x_0 follows every change of f by Y: a pivot solves for two columns at most, all else
//! are products. CsrMatrix that have not changed hold as exactly as B is solved; those that have are checked.
//!
//! The matrix is the shifted one of [`super::system`]: strictly monotone where flow is associated, so
//! that no combination of modes is without a direction.

use super::equations::Equations;
use super::system::StepSystem;
use crate::contact::mode::ContactMode;
use crate::linear::bordered::{BorderedFactors, BorderedSystem};
use crate::linear::condensed::{Condensed, Elimination, pair};
use crate::linear::csr::CsrMatrix;
use crate::linear::updated::UpdatedFactorisation;
use nalgebra::{DMatrix, DVector};
use std::rc::Rc;
use std::sync::Arc;

/// Changed points above which the matrix is factorised anew.
const FRESH: usize = 24;
/// Relative residual above which it is.
const RESIDUAL: f64 = 1e-9;

/// A sparse row.
type Row = Vec<(usize, f64)>;

/// A contact point whose rows are no longer those of B.
struct Change {
    contact: usize,
    /// Its present rows and those of B.
    rows: [[Row; 2]; 2],
}

/// A factorisation with what has changed since.
struct Base {
    updated: UpdatedFactorisation<BorderedSystem<Condensed>>,
    /// x_0: right-hand sides, kept unknowns.
    from: Vec<f64>,
    changes: Vec<Change>,
}

/// Equations of all points and bodies, in units, with a right-hand side and a factorisation.
pub(super) struct UpdatedEquations {
    points: usize,
    equations: Rc<Equations>,
    control: Vec<f64>,
    modes: Vec<ContactMode>,
    right: Vec<f64>,
    base: Option<Base>,
    elimination: Elimination,
}

fn norm(v: &[f64]) -> f64 {
    v.iter().fold(0.0, |a: f64, b| if b.is_nan() { f64::NAN } else { a.max(b.abs()) })
}

impl UpdatedEquations {
    /// Equations with a control, all points stuck, nothing on the right-hand side.
    pub fn new(
        equations: Rc<Equations>,
        chain: Option<Arc<[usize]>>,
        points: usize,
        control: Vec<f64>,
    ) -> UpdatedEquations {
        let right = vec![0.0; control.len()];
        let modes = vec![ContactMode::Stick; points];
        let elimination = Elimination::along(chain);
        UpdatedEquations { points, equations, control, modes, right, base: None, elimination }
    }

    /// Right-hand sides of the rows that belong to no contact point.
    pub fn load_rate(&mut self, right: &[f64]) {
        self.right[2 * self.points..].copy_from_slice(&right[2 * self.points..]);
        self.base = None;
    }

    /// A contact point's mode and the right-hand sides of its rows.
    pub fn set(&mut self, system: &StepSystem, contact: usize, mode: ContactMode, right: [f64; 2]) {
        let old = self.modes[contact];
        self.modes[contact] = mode;
        let before = [0, 1].map(|k| std::mem::replace(&mut self.right[2 * contact + k], right[k]));
        let Some(mut base) = self.base.take() else { return };
        if !base.changes.iter().any(|change| change.contact == contact) {
            if base.changes.len() >= FRESH {
                return;
            }
            if base.updated.respond(contact, 0).is_none() {
                return;
            }
            let rows = self.rows_of(system, contact, old);
            base.changes.push(Change { contact, rows: [rows.clone(), rows] });
        }
        base.updated.add(contact, [right[0] - before[0], right[1] - before[1]], &mut base.from);
        for change in base.changes.iter_mut().filter(|change| change.contact == contact) {
            change.rows[0] = self.rows_of(system, contact, mode);
        }
        self.base = Some(base);
    }

    /// The two rows of a contact point in a mode.
    fn rows_of(&self, system: &StepSystem, c: usize, mode: ContactMode) -> [Row; 2] {
        let point = Equations::point_rows(system.law(c), mode);
        [0, 1].map(|k| {
            let (mut row, mut shift) = (Row::new(), Row::new());
            self.equations.add_row(&point, (c, k), true, &mut row, &mut shift);
            row.append(&mut shift);
            row
        })
    }

    /// All unknowns; how many factorisations that took. `None` where the equations are singular.
    pub fn solve(&mut self, system: &StepSystem) -> Option<(Vec<f64>, u64)> {
        if let Some(x) = self.updated() {
            return Some((x, 0));
        }
        let (mut rows, mut shifts) = (CsrMatrix::with_capacity(0), CsrMatrix::with_capacity(0));
        for c in 0..self.points {
            let point = Equations::point_rows(system.law(c), self.modes[c]);
            for k in 0..2 {
                self.equations.add_row(&point, (c, k), true, rows.open_row(), shifts.open_row());
                rows.end_row();
                shifts.end_row();
            }
        }
        self.equations.bodies(&mut rows, &mut shifts, 0.0);
        let (all, nothing) = (rows.with(&shifts), CsrMatrix::empty(self.control.len()));
        let held = BorderedFactors::new(self.points, &self.control, |last| {
            let mut all = all.clone();
            all.open_row().extend(last);
            all.end_row();
            Condensed::of(all, &nothing, self.points, &mut self.elimination)
        })?;
        let factors = BorderedSystem::new(Rc::new(held), &self.control)?;
        let mut x = factors.apply(&self.right)?;
        let step = factors.apply(&factors.left(&self.right, &x).0)?;
        x.iter_mut().zip(&step).for_each(|(x, s)| *x += s);
        let from = factors.equations().kept_of(&x);
        self.base = Some(Base { updated: UpdatedFactorisation::new(factors), from, changes: Vec::new() });
        Some((x, 1))
    }

    /// By the changed rows; `None` where there is no factorisation, or that leaves residuals.
    fn updated(&self) -> Option<Vec<f64>> {
        let Base { updated, from, changes } = self.base.as_ref()?;
        let equations = updated.factors.equations();
        let n = 2 * changes.len();
        let present = |c: usize| [self.right[2 * c], self.right[2 * c + 1]];
        let row = |i: usize, which: usize, y: &[f64], right: &dyn Fn(usize) -> [f64; 2]| {
            let (contact, row) = (changes[i / 2].contact, &changes[i / 2].rows[which][i % 2]);
            let own = (contact, equations.force(contact, right(contact), y));
            updated.row_dot(row.iter().copied(), own, &right, y)
        };
        let difference =
            |i: usize, y: &[f64], right: &dyn Fn(usize) -> [f64; 2]| row(i, 0, y, right) - row(i, 1, y, right);
        let columns: Vec<_> = changes.iter().map(|change| updated.columns(change.contact)).collect::<Option<_>>()?;
        let small = DMatrix::from_fn(n, n, |i, j| {
            let unit = |c: usize| if c == changes[j / 2].contact { pair(j % 2, 1.0) } else { [0.0; 2] };
            f64::from(u8::from(i == j)) + difference(i, &columns[j / 2][j % 2].y, &unit)
        });
        let by = small.lu().solve(&DVector::from_fn(n, |i, _| difference(i, from, &present)))?;
        let (mut y, mut right) = (from.clone(), self.right.clone());
        for (change, w) in changes.iter().zip(by.as_slice().chunks_exact(2)) {
            (0..2).for_each(|k| right[2 * change.contact + k] -= w[k]);
            updated.add(change.contact, [-w[0], -w[1]], &mut y);
        }
        let changed = |c: usize| [right[2 * c], right[2 * c + 1]];
        let bound = RESIDUAL * norm(&self.right);
        let holds = |i: usize| {
            let at = 2 * changes[i / 2].contact + i % 2;
            (row(i, 0, &y, &changed) - self.right[at]).abs() <= bound
        };
        ((0..n).all(holds) && norm(&y).is_finite()).then(|| equations.expand(&right, &y))
    }

    /// Rate of a contact point's gap in a solution, in units.
    pub fn gap(&self, contact: usize, x: &[f64]) -> [f64; 2] {
        [0, 1].map(|k| self.equations.gaps.row_dot(2 * contact + k, x))
    }
}
