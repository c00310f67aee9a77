//! Piecewise linear homotopy for the rate problem: a path from a guess of the cells to a solution.
//!
//! In scaled forces and gaps the rate problem is ṙ = S ġ + s with every (ṙ, ġ) in a cell of its point's
//! normal fan (cones, since rates have no bounds). From any combination of cells with some (ṙ*, ġ*) in them
//! the error e = ṙ* − S ġ* − s is taken away in proportion,
//!
//! ```text
//! ṙ = (S − ε) ġ + s + (1 − t) e,   t from 0 to 1,
//! ```
//!
//! and the path is followed from cell to cell; t may turn back. The guesses are random places: first inside the
//! present modes, then anywhere. ε makes mechanisms large rates. The
//! end of the path gives modes only: an active set begins with them, and its rate is checked. Sources: Ralph (1994, Math.
//! Operations Research 19); Dirkse & Ferris (1995, Optim. Methods Software 5).

use super::cone::Cone;
use super::neighbours::rising_from;
use super::problem::{Rate, RateProblem};
use crate::contact::active_point::ActivePoint;
use crate::contact::facet::dot;
use crate::contact::mode::ContactMode;
use crate::contact::normal_fan::Cell;
use crate::contact::piecewise_path::{PiecewiseLinear, PointInCell, follow};
use crate::linear::updated_inverse::UpdatedInverse;
use crate::optimise::lcg::Lcg;
use nalgebra::{DMatrix, DVector};

/// ε, relative to the points' own stiffness.
const REGULARISATION: f64 = 1e-9;
/// Number of guesses.
const GUESSES: u64 = 8;
/// Random places that are tried to begin inside the present mode of a point.
const PLACES: usize = 60;

/// The path: forces and gaps of all points in their units, and their rates.
struct RatePath<'p> {
    cones: &'p [Cone],
    cells: Vec<usize>,
    s: DMatrix<f64>,
    /// e.
    error: DVector<f64>,
    force: DVector<f64>,
    gap: DVector<f64>,
    force_rate: DVector<f64>,
    gap_rate: DVector<f64>,
    equations: UpdatedInverse,
    trials: &'p mut u64,
}

fn pair(v: &DVector<f64>, k: usize) -> [f64; 2] {
    [v[2 * k], v[2 * k + 1]]
}

impl RatePath<'_> {
    /// Rows over ġ of a point in its cell, and their right-hand sides: ġ moves with ṙ' = S ġ' − e for t' = 1.
    fn set_rows(&mut self, k: usize) {
        let n = self.gap.len();
        let unit = |i: usize| DVector::from_fn(n, |j, _| f64::from(u8::from(j == 2 * k + i)));
        let s = &self.s;
        let (rows, right) = match self.cones[k].fan.cells[self.cells[k]].0 {
            Cell::Inside => ([unit(0), unit(1)], [0.0; 2]),
            Cell::Facet(i) => {
                let f = &self.cones[k].polygon.facets[i];
                let a = DVector::from_fn(n, |j, _| f.normal[0] * s[(2 * k, j)] + f.normal[1] * s[(2 * k + 1, j)]);
                let across = unit(0) * f.flow[1] - unit(1) * f.flow[0];
                ([a, across], [dot(f.normal, pair(&self.error, k)), 0.0])
            }
            Cell::Pair(..) => ([s.row(2 * k).transpose(), s.row(2 * k + 1).transpose()], pair(&self.error, k)),
        };
        self.equations.set_rows(2 * k, &rows, right);
    }
}

impl PiecewiseLinear for RatePath<'_> {
    fn points(&self) -> usize {
        self.cones.len()
    }

    fn point(&self, k: usize) -> Option<PointInCell<'_>> {
        Some(PointInCell {
            boundaries: &self.cones[k].fan.cells[self.cells[k]].1,
            force: pair(&self.force, k),
            gap: pair(&self.gap, k),
            area: 1.0,
            force_rate: pair(&self.force_rate, k),
            gap_rate: pair(&self.gap_rate, k),
        })
    }

    fn solve_rates(&mut self) -> Result<(), String> {
        *self.trials += 1;
        self.gap_rate = self.equations.solve().ok_or("a combination of cells has no direction")?;
        self.force_rate = &self.s * &self.gap_rate - &self.error;
        Ok(())
    }

    fn advance(&mut self, by: f64) {
        self.force += &self.force_rate * by;
        self.gap += &self.gap_rate * by;
    }

    fn cross(&mut self, k: usize, boundary: usize) -> (usize, bool) {
        let cells = &self.cones[k].fan.cells;
        let (before, boundaries) = &cells[self.cells[k]];
        let (to, entered) = boundaries[boundary].neighbour;
        self.cells[k] = to;
        let changed = !matches!((before, cells[to].0), (Cell::Pair(..), Cell::Pair(..)));
        if changed {
            self.set_rows(k);
        }
        (entered, changed)
    }
}

/// A rate with λ̇ = 1. `None` if no path from the guesses leads to one.
pub fn rate_by_homotopy(problem: &RateProblem, trials: &mut u64) -> Option<Rate> {
    (0..GUESSES).find_map(|number| {
        let modes = modes_at_end(problem, number, trials)?;
        rising_from(problem, modes, trials)
    })
}

/// The places of a guess. Those of the first guess are inside the present modes, so that a path begins with few motions.
fn places(problem: &RateProblem, cones: &[Cone], number: u64) -> Vec<(usize, [f64; 2], [f64; 2])> {
    let mut random = Lcg::new(0x51_7CC1 + 7919 * number);
    let mut place = |(cone, point): (&Cone, &ActivePoint)| {
        let mut place = cone.place([random.next(), random.next()]);
        for _ in 0..if number == 0 { PLACES } else { 0 } {
            if cone.mode(place.0) == point.guess {
                break;
            }
            place = cone.place([random.next(), random.next()]);
        }
        place
    };
    cones.iter().zip(&problem.points).map(&mut place).collect()
}

/// Modes near a solution with λ̇ = 1 by the path from the guess of a number.
fn modes_at_end(problem: &RateProblem, number: u64, trials: &mut u64) -> Option<Vec<ContactMode>> {
    let n = 2 * problem.points.len();
    let cones: Vec<Cone> = problem.points.iter().map(Cone::new).collect();
    let unit: Vec<f64> = (0..n).map(|i| problem.points[i / 2].stiffness.sqrt()).collect();
    let shift = |i: usize, j: usize| if i == j { REGULARISATION } else { 0.0 };
    let s = DMatrix::from_fn(n, n, |i, j| problem.s[(i, j)] / (unit[i] * unit[j]) - shift(i, j));
    let load_rate = DVector::from_fn(n, |i, _| problem.load_rate[i] / unit[i]);
    let size = load_rate.amax().max(1e-300);
    let places = places(problem, &cones, number);
    let force = DVector::from_fn(n, |i, _| places[i / 2].1[i % 2] * size);
    let gap = DVector::from_fn(n, |i, _| places[i / 2].2[i % 2] * size);
    let cells = places.iter().map(|place| place.0).collect();
    let error = &force - &s * &gap - &load_rate;
    let (force_rate, gap_rate) = (DVector::zeros(n), DVector::zeros(n));
    let equations = UpdatedInverse::zeros(n);
    let mut path = RatePath { cones: &cones, cells, s, error, force, gap, force_rate, gap_rate, equations, trials };
    (0..cones.len()).for_each(|k| path.set_rows(k));
    follow(&mut path, 200 + 4 * n).ok()?;
    Some(cones.iter().zip(&path.cells).map(|(cone, cell)| cone.mode(*cell)).collect())
}
