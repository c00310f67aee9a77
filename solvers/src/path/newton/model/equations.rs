//! Rows of gaps and balance in units, and the rows of contact points by mode.

use super::derivatives::Hessian;
use crate::contact::mode::ContactMode;
use crate::contact::yield_polygon::YieldPolygon;
use crate::linear::blocks::{BlockMatrix, GapRows, Pattern};
use crate::linear::chain::PointRows;
use crate::linear::csr::CsrMatrix;
use crate::path::system::{Load, System};
use crate::settings::SETTINGS;
use std::rc::Rc;
use std::sync::Arc;
use voussoir_core::linear::Entries;

/// Combinations of two forces or gaps, one per row.
type Combined = [[f64; 2]; 2];

fn diagonal(value: f64) -> Combined {
    [[value, 0.0], [0.0, value]]
}

/// Gaps and balance as functions of all unknowns.
#[derive(Debug)]
pub struct Equations {
    /// Two rows per contact point: normal and tangential gap.
    pub gaps: Rc<GapRows>,
    /// Three rows per free body.
    pub bodies: Rc<CsrMatrix>,
    /// The column of the factor, which is also in the rows.
    pub factor: Vec<f64>,
}

/// Entries of an open row, of the equations or of the added terms.
type Open<'r> = &'r mut Vec<(usize, f64)>;

impl Equations {
    /// Creates the equations of linear blocks with small displacements under the growing `load`.
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

    /// Creates the equations from second derivatives of Π.
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
        let unknowns = 0..hessian.factor.len();
        let rows: Vec<Option<(usize, f64)>> = unknowns.clone().map(row_of).collect();
        let columns: Vec<Option<(usize, f64)>> = unknowns.map(|j| system.column(j)).collect();
        let mut place = |row: usize, column: usize, value: f64| match row < base {
            true => gaps.push((row, column, value)),
            false => bodies.push((row - base, column, value)),
        };
        for &(i, j, value) in &hessian.entries {
            if let (Some((row, by)), Some((column, unit))) = (rows[i], columns[j]) {
                place(row, column, value * unit / by);
            }
        }
        let mut factor = vec![0.0; last];
        for (i, value) in hessian.factor.iter().enumerate().filter(|(_, v)| **v != 0.0) {
            if let Some((row, by)) = rows[i] {
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

    /// Returns the rows of a contact point in a mode, with the added terms.
    pub fn point_rows(law: Option<&YieldPolygon>, mode: ContactMode) -> PointRows {
        let (mut force, mut gap): (Combined, Combined) = Default::default();
        let (mut force_shift, mut gap_shift): (Combined, Combined) = Default::default();
        match (mode, law) {
            (ContactMode::Facet(i), Some(law)) => {
                let (a, d) = (law.facets[i as usize].normal, law.facets[i as usize].flow);
                let square = d[0] * d[0] + d[1] * d[1];
                (force[0], gap[1]) = (a, [d[1], -d[0]]);
                gap_shift[0] = d.map(|d| SETTINGS.admissible * d / square);
            }
            (ContactMode::Corner(..) | ContactMode::Open, Some(_)) => {
                (force, gap_shift) = (diagonal(1.0), diagonal(SETTINGS.admissible));
            }
            _ => (gap, force_shift) = (diagonal(1.0), diagonal(SETTINGS.admissible)),
        }
        PointRows { force, gap, force_shift, gap_shift }
    }

    /// Returns the rows of a contact point whose law gives tractions from gaps; `own` and `stiffness` as from
    /// `traction_row`.
    pub fn response_rows(own: [f64; 2], stiffness: [[f64; 2]; 2]) -> PointRows {
        PointRows {
            force: [[own[0], 0.0], [0.0, own[1]]],
            gap: stiffness,
            force_shift: diagonal(SETTINGS.admissible),
            gap_shift: diagonal(SETTINGS.admissible),
        }
    }

    /// Adds row k of a contact point to open rows: its equation and its added term. If the term is `whole`, it keeps
    /// the equations monotone. Otherwise the forces of other points are left out of it, so that open points have
    /// separate equations and can be condensed out.
    pub fn add_row(&self, rows: &PointRows, (c, k): (usize, usize), whole: bool, equation: Open, shift: Open) {
        let forces = self.gaps.len();
        let open = rows.gap == [[0.0; 2]; 2];
        let own = |j: usize| whole || !open || j >= forces || j / 2 == c;
        let gaps = |weights: [f64; 2]| {
            let taken = weights.into_iter().enumerate().filter(|(_, by)| *by != 0.0);
            taken.flat_map(|(l, by)| self.gaps.row(2 * c + l).map(move |(j, v)| (j, by * v)))
        };
        let of_point = |weights: [f64; 2]| {
            weights.into_iter().enumerate().filter(|(_, by)| *by != 0.0).map(move |(l, by)| (2 * c + l, by))
        };
        equation.extend(gaps(rows.gap[k]));
        equation.extend(of_point(rows.force[k]));
        shift.extend(gaps(rows.gap_shift[k]).filter(|e| own(e.0)));
        shift.extend(of_point(rows.force_shift[k]));
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
            shifts.open_row().push((base + row, -SETTINGS.admissible));
            shifts.end_row();
        }
    }
}
