//! The rate problem reduced to some points on a factorisation: ṙ = S ġ + s λ̇ over those whose piece
//! is open, while all others keep theirs, whichever the factorised matrix has for them.

use super::base::Base;
use super::point::Point;
use super::rate::{Piece, Rate, RateProblem};
use super::system::{Load, System};
use super::trace::Tracer;
use nalgebra::{DMatrix, DVector};

/// A rate problem over points with the way back to all unknowns.
pub struct Local<'a> {
    /// Over the points whose piece is open.
    pub rate: RateProblem<'a>,
    /// Those points, then others whose piece is not the factorised one.
    points: Vec<usize>,
    /// ε of all of them per ġ of the open points and, last, λ̇.
    epsilon: DMatrix<f64>,
}

impl<'a> Local<'a> {
    /// Reduces to the `open` points; all others keep their `pieces`. `None` where linear algebra fails.
    pub fn new(
        (system, all): (&'a System, &[Point]),
        base: &mut Base,
        (drive, load): (usize, &Load),
        open: &[usize],
        pieces: &[Piece],
        solves: &mut u64,
    ) -> Option<Self> {
        let mut points = open.to_vec();
        let mut is_open = vec![false; pieces.len()];
        open.iter().for_each(|c| is_open[*c] = true);
        points.extend((0..pieces.len()).filter(|c| !is_open[*c] && pieces[*c] != base.pieces[*c]));
        let (n, m) = (points.len(), open.len());
        base.respond(system, &points, solves)?;
        base.drive(system, drive, load)?;
        let response = base.local(system, &points, load);
        // Rows that fix ε: ġ of the open points, the piece of the others.
        let mut rows = DMatrix::zeros(2 * n, 2 * n);
        let mut driven = DVector::zeros(2 * n);
        for (k, &c) in points.iter().enumerate() {
            let pick: [[f64; 4]; 2] = match pieces[c] {
                _ if k < m => [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]],
                Piece::Stick => [[0.0, 0.0, 1.0, 0.0], [0.0, 0.0, 0.0, 1.0]],
                Piece::Facet(f) => {
                    let facet = &system.facets[c].as_ref()?[f];
                    [[facet.normal[0], facet.normal[1], 0.0, 0.0], [0.0, 0.0, -facet.flow[1], facet.flow[0]]]
                }
                Piece::Free | Piece::Corner(..) => [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0]],
            };
            for (i, pick) in pick.iter().enumerate() {
                for (j, p) in pick.iter().enumerate().filter(|(_, p)| **p != 0.0) {
                    for column in 0..2 * n {
                        rows[(2 * k + i, column)] += p * response[(4 * k + j, column)];
                    }
                    driven[2 * k + i] += p * response[(4 * k + j, 2 * n)];
                }
            }
        }
        let mut right = DMatrix::zeros(2 * n, 2 * m + 1);
        (0..2 * m).for_each(|i| right[(i, i)] = 1.0);
        right.set_column(2 * m, &-driven);
        let epsilon = if n == 0 { right } else { rows.lu().solve(&right)? };
        if epsilon.iter().any(|v| !v.is_finite()) {
            return None;
        }
        let responses = response.columns(0, 2 * n) * &epsilon;
        let row = |i: usize| 4 * (i / 2) + i % 2;
        let rate = RateProblem {
            points: Tracer::verges(system, all, open),
            s: DMatrix::from_fn(2 * m, 2 * m, |i, j| responses[(row(i), j)]),
            drive: DVector::from_fn(2 * m, |i, _| responses[(row(i), 2 * m)] + response[(row(i), 2 * n)]),
            from_nothing: false,
        };
        Some(Local { rate, points, epsilon })
    }

    /// All unknowns of a solution.
    pub fn combine(&self, base: &Base, rate: &Rate) -> Vec<f64> {
        let mut gaps: Vec<f64> = rate.gaps.iter().flatten().copied().collect();
        gaps.push(rate.factor);
        let epsilon = &self.epsilon * DVector::from_vec(gaps);
        base.combine(&self.points, epsilon.as_slice(), rate.factor)
    }
}
