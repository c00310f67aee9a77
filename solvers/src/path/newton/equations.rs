//! Rows of gaps and balance in units, and of them the rows of contact points by mode.

use super::unknowns::Unknowns;
use crate::contact::mode::ContactMode;
use crate::contact::yield_polygon::YieldPolygon;
use crate::linear::csr::CsrMatrix;
use voussoir_core::linear::Entries;

/// What is added to the factorised matrix, relative to its units: refinement takes it out again.
pub(super) const REGULARISATION: f64 = 1e-9;

/// Gaps and balance by all unknowns.
#[derive(Debug)]
pub(super) struct Equations {
    /// Two rows per contact point: normal and tangential gap.
    pub gaps: CsrMatrix,
    /// Three rows per free body.
    pub bodies: CsrMatrix,
}

/// Entries of a row that is open, of the equations or of what is added to them.
type Open<'r> = &'r mut Vec<(usize, f64)>;

impl Equations {
    /// From second derivatives of Π.
    pub fn new(unknowns: &Unknowns, entries: &Entries, factor: &[f64]) -> Self {
        let (u, points, last) = (unknowns.units, unknowns.contacts, unknowns.size() - 1);
        let base = 2 * points;
        let of_gaps = entries.iter().filter(|e| e.0 < base).count();
        let (mut gaps, mut bodies): (Entries, Entries) = (Vec::with_capacity(of_gaps + points), Vec::new());
        let mut place = |i: usize, column: usize, value: f64| {
            if i < base {
                gaps.push((i, column, value / u.displacement));
            } else if let Some((row, _)) = unknowns.column(i) {
                let unit = if (i - base) % 3 == 2 { u.force * u.length } else { u.force };
                bodies.push((row - base, column, value / unit));
            }
        };
        for &(i, j, value) in entries {
            if let Some((column, unit)) = unknowns.column(j) {
                place(i, column, value * unit);
            }
        }
        for (i, value) in factor.iter().enumerate().filter(|(_, v)| **v != 0.0) {
            place(i, last, value * u.factor);
        }
        Equations { gaps: CsrMatrix::new(base, &gaps), bodies: CsrMatrix::new(last - base, &bodies) }
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
        let gap = |k: usize, by: f64| self.gaps.row(2 * c + k).iter().map(move |&(j, v)| (j, by * v));
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
                equation.extend_from_slice(self.gaps.row(2 * c + k));
                shift.push((2 * c + k, REGULARISATION));
            }
        }
    }

    /// Adds row k of a contact point whose law gives tractions from gaps: own and stiffness as in `response`.
    pub fn response(&self, c: usize, k: usize, own: f64, stiffness: [f64; 2], equation: Open, shift: Open) {
        for (gap, s) in stiffness.into_iter().enumerate().filter(|(_, s)| *s != 0.0) {
            equation.extend(self.gaps.row(2 * c + gap).iter().map(|&(j, v)| (j, s * v)));
        }
        equation.push((2 * c + k, own));
        shift.extend(self.gaps.row(2 * c + k).iter().map(|&(j, v)| (j, REGULARISATION * v)));
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
