//! Rows of gaps and balance in units, and of them the rows of contact points by mode.

use super::derivatives::Hessian;
use crate::contact::mode::ContactMode;
use crate::contact::yield_polygon::YieldPolygon;
use crate::linear::blocks::{BlockMatrix, GapRows, Pattern};
use crate::linear::chain::PointRows;
use crate::linear::csr::CsrMatrix;
use crate::path::system::{Load, System};
use std::rc::Rc;
use std::sync::Arc;
use voussoir_core::linear::Entries;

/// What is added to the factorised matrix, relative to its units: refinement takes it out again.
pub(super) const REGULARISATION: f64 = 1e-9;

/// Combinations of two forces or gaps, one a row.
type Combined = [[f64; 2]; 2];

fn diagonal(value: f64) -> Combined {
    [[value, 0.0], [0.0, value]]
}

/// Gaps and balance by all unknowns.
#[derive(Debug)]
pub(super) struct Equations {
    /// Two rows per contact point: normal and tangential gap.
    pub gaps: Rc<GapRows>,
    /// Three rows per free body.
    pub bodies: Rc<CsrMatrix>,
    /// The column of the factor, which the rows hold too.
    pub factor: Vec<f64>,
}

/// Entries of a row that is open, of the equations or of what is added to them.
type Open<'r> = &'r mut Vec<(usize, f64)>;

impl Equations {
    /// Of linear blocks with small displacements, whose `load` grows; `pattern` of the joints.
    pub fn linear(system: &System, load: &Load, pattern: Arc<Pattern>) -> Self {
        let (points, last, unit) = (2 * system.contacts, system.size(), system.units.factor);
        let driven = load.gap.as_flattened().iter().chain(load.wrench.as_flattened());
        let factor: Vec<f64> = driven.map(|v| v * unit).collect();
        let mut forces = BlockMatrix::zeros(pattern);
        let mut others = CsrMatrix::with_capacity(system.kinematics.entries() + points);
        let mut bodies: Entries = Vec::with_capacity(system.kinematics.entries());
        for (i, factor) in factor[..points].iter().enumerate() {
            system.flexibility.row(i).iter().for_each(|&(j, v)| forces.add_entry(i, j, v));
            let row = others.open_row();
            row.extend(system.kinematics.row(i).iter().map(|&(j, v)| (points + j, v)));
            row.extend(Some((last, *factor)).filter(|e| e.1 != 0.0));
            others.end_row();
            bodies.extend(system.kinematics.row(i).iter().map(|&(j, v)| (j, i, v)));
        }
        let by_factor = factor[points..].iter().enumerate().filter(|(_, v)| **v != 0.0);
        bodies.extend(by_factor.map(|(row, value)| (row, last, *value)));
        let bodies = Rc::new(CsrMatrix::new(last - points, &bodies));
        Equations { gaps: Rc::new(GapRows { forces, others }), bodies, factor }
    }

    /// From second derivatives of Π.
    pub fn new(system: &System, hessian: Hessian) -> Self {
        let (u, base, last) = (system.units, 2 * system.contacts, system.size());
        let of_gaps = hessian.entries.iter().filter(|e| e.0 < base).count();
        let of_bodies = hessian.entries.len() - of_gaps;
        let (mut gaps, mut bodies): (Entries, Entries) =
            (Vec::with_capacity(of_gaps + base), Vec::with_capacity(of_bodies + last - base));
        let row_of = |i: usize| match i < base {
            true => Some((i, u.displacement)),
            false if (i - base) % 3 == 2 => Some((system.column(i)?.0, u.force * u.length)),
            false => Some((system.column(i)?.0, u.force)),
        };
        let mut place = |row: usize, column: usize, value: f64| match row < base {
            true => gaps.push((row, column, value)),
            false => bodies.push((row - base, column, value)),
        };
        for &(i, j, value) in &hessian.entries {
            if let (Some((row, by)), Some((column, unit))) = (row_of(i), system.column(j)) {
                place(row, column, value * unit / by);
            }
        }
        let mut factor = vec![0.0; last];
        for (i, value) in hessian.factor.iter().enumerate().filter(|(_, v)| **v != 0.0) {
            if let Some((row, by)) = row_of(i) {
                factor[row] = value * u.factor / by;
                place(row, last, factor[row]);
            }
        }
        let mut forces = hessian.forces;
        forces.scale(u.force / u.displacement);
        let others = CsrMatrix::new(base, &gaps);
        let bodies = Rc::new(CsrMatrix::new(last - base, &bodies));
        Equations { gaps: Rc::new(GapRows { forces, others }), bodies, factor }
    }

    /// The rows of a contact point in a mode, with what is added to them.
    pub fn point_rows(law: Option<&YieldPolygon>, mode: ContactMode) -> PointRows {
        let (mut force, mut gap): (Combined, Combined) = Default::default();
        let (mut force_shift, mut gap_shift): (Combined, Combined) = Default::default();
        match (mode, law) {
            (ContactMode::Facet(i), Some(law)) => {
                let (a, d) = (law.facets[i as usize].normal, law.facets[i as usize].flow);
                let square = d[0] * d[0] + d[1] * d[1];
                (force[0], gap[1]) = (a, [d[1], -d[0]]);
                gap_shift[0] = d.map(|d| REGULARISATION * d / square);
            }
            (ContactMode::Corner(..) | ContactMode::Open, Some(_)) => {
                (force, gap_shift) = (diagonal(1.0), diagonal(REGULARISATION));
            }
            _ => (gap, force_shift) = (diagonal(1.0), diagonal(REGULARISATION)),
        }
        PointRows { force, gap, force_shift, gap_shift }
    }

    /// The rows of a contact point whose law gives tractions from gaps: own and stiffness as in `response`.
    pub fn response_rows(own: [f64; 2], stiffness: [[f64; 2]; 2]) -> PointRows {
        PointRows {
            force: [[own[0], 0.0], [0.0, own[1]]],
            gap: stiffness,
            force_shift: diagonal(REGULARISATION),
            gap_shift: diagonal(REGULARISATION),
        }
    }

    /// Adds row k of a contact point in a mode to open rows: its equation, and what is added. The latter
    /// keeps the equations monotone where it is `whole`; where the forces of other points are left out of
    /// it, those of open points have equations of their own, which can be condensed out.
    pub fn point(
        &self,
        law: Option<&YieldPolygon>,
        (c, k): (usize, usize),
        mode: ContactMode,
        whole: bool,
        equation: Open,
        shift: Open,
    ) {
        let forces = self.gaps.len();
        let gap = |k: usize, by: f64| self.gaps.row(2 * c + k).map(move |(j, v)| (j, by * v));
        match (mode, law) {
            (ContactMode::Facet(i), Some(law)) => {
                let (a, d) = (law.facets[i as usize].normal, law.facets[i as usize].flow);
                let square = d[0] * d[0] + d[1] * d[1];
                if k == 0 {
                    equation.extend([(2 * c, a[0]), (2 * c + 1, a[1])]);
                    (0..2).for_each(|k| shift.extend(gap(k, REGULARISATION * d[k] / square)));
                } else {
                    equation.extend(gap(0, d[1]));
                    equation.extend(gap(1, -d[0]));
                }
            }
            (ContactMode::Corner(..) | ContactMode::Open, Some(_)) => {
                equation.push((2 * c + k, 1.0));
                shift.extend(gap(k, REGULARISATION).filter(|&(j, _)| whole || j >= forces || j / 2 == c));
            }
            _ => {
                equation.extend(self.gaps.row(2 * c + k));
                shift.push((2 * c + k, REGULARISATION));
            }
        }
    }

    /// Adds row k of a contact point whose law gives tractions from gaps: own and stiffness as in `response`.
    pub fn response(&self, c: usize, k: usize, own: f64, stiffness: [f64; 2], equation: Open, shift: Open) {
        for (gap, s) in stiffness.into_iter().enumerate().filter(|(_, s)| *s != 0.0) {
            equation.extend(self.gaps.row(2 * c + gap).map(|(j, v)| (j, s * v)));
        }
        equation.push((2 * c + k, own));
        shift.extend(self.gaps.row(2 * c + k).map(|(j, v)| (j, REGULARISATION * v)));
        shift.push((2 * c + k, REGULARISATION));
    }

    /// Adds the rows of the bodies, with viscous wrenches of this rate.
    pub fn bodies(&self, equations: &mut CsrMatrix, shifts: &mut CsrMatrix, damping: f64) {
        let base = self.gaps.len();
        for row in 0..self.bodies.len() {
            equations.open_row().extend_from_slice(self.bodies.row(row));
            if damping != 0.0 {
                equations.open_row().push((base + row, -damping));
            }
            equations.end_row();
            shifts.open_row().push((base + row, -REGULARISATION));
            shifts.end_row();
        }
    }
}
