//! The rate problem with many points at the verge of a change: a piecewise linear path from a guess.
//!
//! In scaled forces and gaps the rate problem is ṙ = S ġ + s with every (ṙ, ġ) in a cell of its point's
//! law (cones, since rates have no bounds). From any combination of cells with some (ṙ*, ġ*) in them
//! the error e = ṙ* − S ġ* − s is taken away in proportion,
//!
//! ```text
//! ṙ = (S − ε) ġ + s + (1 − t) e,   t from 0 to 1,
//! ```
//!
//! and the path is followed from cell to cell; t may turn back. The guesses are random inside the
//! present pieces, later anywhere, so that walls are met one at a time; other guesses may find other
//! solutions. ε makes mechanisms large rates instead of none; whatever comes out is only read for its
//! pieces, and those are solved and checked exactly. Sources: Ralph (1994, Math. Operations Research
//! 19); Dirkse & Ferris (1995, Optim. Methods Software 5).

use super::rate::{Piece, RateProblem, Verge};
use crate::path::cells::{Cell, Cells};
use crate::path::newton::law::Polygon;
use crate::path::shuffle::Shuffle;
use crate::path::walk::{Met, Standing, Walk};
use nalgebra::{DMatrix, DVector};
use voussoir_core::law::Facet;

/// ε, relative to the points' own stiffness.
const SHIFT: f64 = 1e-9;
/// Rows changed after which the inverse is computed anew.
const FRESH: usize = 60;
/// Residual of a direction above which it is.
const RESIDUAL: f64 = 1e-7;
/// The cells of a point.
pub(super) struct Law {
    polygon: Polygon,
    cells: Cells,
    /// Facets of the polygon in the point's own numbering.
    active: Vec<usize>,
    /// The opening facet in the polygon's numbering, where the point is open.
    open: Option<usize>,
    apex: bool,
}

impl Law {
    pub fn new(point: &Verge<'_>) -> Law {
        let facet = |f: &usize| {
            let p = &point.facets[*f];
            Facet { mode: p.mode, normal: p.normal, bound: 0.0, flow: p.flow }
        };
        let facets: Vec<Facet> = point.active.iter().map(facet).collect();
        let polygon = Polygon::new(&facets);
        let open = point.open.and_then(|o| point.active.iter().position(|f| *f == o));
        let mut cells = polygon.cells.clone();
        if let Some(o) = open {
            cells.free(o);
        }
        Law { polygon, cells, active: point.active.clone(), open, apex: point.apex }
    }

    fn piece(&self, cell: usize) -> Piece {
        match self.cells.cells[cell].0 {
            Cell::Inside => Piece::Stick,
            Cell::Facet(i) => Piece::Facet(self.active[i]),
            Cell::Pair(..) if self.apex => Piece::Free,
            Cell::Pair(_, [i, j]) => match self.open {
                Some(open) if open == j => Piece::Corner(self.active[j], self.active[i]),
                _ => Piece::Corner(self.active[i], self.active[j]),
            },
        }
    }

    /// The piece of z = ṙ − ρ ġ, with ρ the same in both directions, and its return.
    pub fn returned(&self, z: [f64; 2]) -> (Piece, [f64; 2]) {
        let (cell, r) = self.polygon.returned(z, [1.0; 2], 1.0);
        (self.piece(cell), r)
    }

    /// A random place: cell, force and gap.
    fn placed(&self, random: &mut Shuffle) -> (usize, [f64; 2], [f64; 2]) {
        let z = [random.next(), random.next()];
        if let Some(open) = self.open {
            // On the opening facet, its multiplier of any sign.
            let f = &self.polygon.facets[open];
            let along = [f.normal[1], -f.normal[0]];
            let inside = |r: [f64; 2]| {
                self.polygon
                    .facets
                    .iter()
                    .enumerate()
                    .all(|(k, g)| k == open || g.normal[0] * r[0] + g.normal[1] * r[1] < 0.0)
            };
            let r = along.map(|a| a * z[0]);
            let back = along.map(|a| -a * z[0]);
            let r = if inside(r) {
                r
            } else if inside(back) {
                back
            } else {
                [0.0; 2]
            };
            return (1 + open, r, f.flow.map(|d| -d * z[1]));
        }
        let (cell, r) = self.polygon.returned(z, [1.0; 2], 1.0);
        (cell, r, [r[0] - z[0], r[1] - z[1]])
    }
}

impl RateProblem<'_> {
    /// Pieces near a solution with the sense `factor` of λ, and its ġ, by the path from the guess of a
    /// number.
    pub(super) fn followed(&self, factor: f64, number: u64, counters: &mut u64) -> Option<(Vec<Piece>, Vec<[f64; 2]>)> {
        let n = 2 * self.points.len();
        let laws: Vec<Law> = self.points.iter().map(Law::new).collect();
        let unit: Vec<f64> = (0..n).map(|i| self.points[i / 2].stiffness.sqrt()).collect();
        let s = DMatrix::from_fn(n, n, |i, j| self.s[(i, j)] / (unit[i] * unit[j]) - if i == j { SHIFT } else { 0.0 });
        let load_rate = DVector::from_fn(n, |i, _| self.load_rate[i] * factor / unit[i]);
        let size = load_rate.amax().max(1e-300);
        let mut random = Shuffle::new(0x51_7CC1 + 7919 * number);
        let (mut force, mut gap) = (DVector::zeros(n), DVector::zeros(n));
        let mut cells = Vec::with_capacity(laws.len());
        for (k, law) in laws.iter().enumerate() {
            let mut place = law.placed(&mut random);
            for _ in 0..if number == 0 { 60 } else { 0 } {
                if law.piece(place.0) == self.points[k].guess {
                    break;
                }
                place = law.placed(&mut random);
            }
            cells.push(place.0);
            (0..2).for_each(|i| {
                force[2 * k + i] = place.1[i] * size;
                gap[2 * k + i] = place.2[i] * size;
            });
        }
        let error = &force - &s * &gap - &load_rate;
        let rows_of = |k: usize, cell: usize| -> [DVector<f64>; 2] {
            let e = |i: usize| DVector::from_fn(n, |j, _| f64::from(u8::from(j == 2 * k + i)));
            match laws[k].cells.cells[cell].0 {
                Cell::Inside => [e(0), e(1)],
                Cell::Facet(i) => {
                    let f = &laws[k].polygon.facets[i];
                    let a = DVector::from_fn(n, |j, _| f.normal[0] * s[(2 * k, j)] + f.normal[1] * s[(2 * k + 1, j)]);
                    [a, e(0) * f.flow[1] - e(1) * f.flow[0]]
                }
                Cell::Pair(..) => [s.row(2 * k).transpose(), s.row(2 * k + 1).transpose()],
            }
        };
        // ġ moves by rows · ġ' = right with ṙ' = S ġ' − e for t' = 1.
        let right_of = |k: usize, cell: usize| -> [f64; 2] {
            let e = [error[2 * k], error[2 * k + 1]];
            match laws[k].cells.cells[cell].0 {
                Cell::Inside => [0.0; 2],
                Cell::Facet(i) => {
                    let f = &laws[k].polygon.facets[i];
                    [f.normal[0] * e[0] + f.normal[1] * e[1], 0.0]
                }
                Cell::Pair(..) => e,
            }
        };
        let mut matrix = DMatrix::zeros(n, n);
        let mut right = DVector::zeros(n);
        for (k, cell) in cells.iter().enumerate() {
            let (rows, r) = (rows_of(k, *cell), right_of(k, *cell));
            for i in 0..2 {
                matrix.set_row(2 * k + i, &rows[i].transpose());
                right[2 * k + i] = r[i];
            }
        }
        let mut inverse: Option<DMatrix<f64>> = None;
        let mut updates = 0;
        let mut walk = Walk::new();
        for _ in 0..200 + 4 * n {
            *counters += 1;
            let mut by = inverse.as_ref().filter(|_| updates <= FRESH).map(|inverse| inverse * &right);
            let wrong = |x: &DVector<f64>| {
                let left = (&matrix * x - &right).amax();
                left.is_nan() || left > RESIDUAL * right.amax()
            };
            if by.as_ref().is_none_or(wrong) {
                inverse = Some(matrix.clone().try_inverse()?);
                updates = 0;
                by = inverse.as_ref().map(|inverse| inverse * &right);
            }
            let gap_rate = by?;
            if gap_rate.iter().any(|v| !v.is_finite()) {
                return None;
            }
            let force_rate = &s * &gap_rate - &error;
            let pair = |v: &DVector<f64>, k: usize| [v[2 * k], v[2 * k + 1]];
            let changed = loop {
                let (along, met) = walk.on(laws.len(), |k| {
                    Some(Standing {
                        walls: &laws[k].cells.cells[cells[k]].1,
                        force: pair(&force, k),
                        gap: pair(&gap, k),
                        area: 1.0,
                        force_rate: pair(&force_rate, k),
                        gap_rate: pair(&gap_rate, k),
                    })
                });
                let read = |gap: &DVector<f64>, by: f64| {
                    let pieces = laws.iter().zip(&cells).map(|(law, cell)| law.piece(*cell)).collect();
                    let gaps = (0..laws.len()).map(|k| [0, 1].map(|i| by * gap[2 * k + i] / unit[2 * k + i]));
                    Some((pieces, gaps.collect()))
                };
                if matches!(met, Met::Ray) {
                    // Where forces stand still on a ray, it is a mechanism.
                    return read(&gap_rate, walk.sense);
                }
                force += &force_rate * along;
                gap += &gap_rate * along;
                let Met::Wall(k, index) = met else { return read(&gap, 1.0) };
                if walk.is_lost() {
                    return None;
                }
                let (to, wall) = laws[k].cells.cells[cells[k]].1[index].behind;
                let before = laws[k].cells.cells[cells[k]].0;
                cells[k] = to;
                walk.enters(k, wall);
                let same = matches!((before, laws[k].cells.cells[to].0), (Cell::Pair(..), Cell::Pair(..)));
                if !same {
                    break k;
                }
            };
            let (rows, r) = (rows_of(changed, cells[changed]), right_of(changed, cells[changed]));
            // A' = A + E D: A'⁻¹ = A⁻¹ − A⁻¹E (1 + D A⁻¹E)⁻¹ D A⁻¹.
            let d = DMatrix::from_fn(2, n, |i, j| rows[i][j] - matrix[(2 * changed + i, j)]);
            for i in 0..2 {
                matrix.set_row(2 * changed + i, &rows[i].transpose());
                right[2 * changed + i] = r[i];
            }
            if let Some(old) = &mut inverse {
                let columns = old.columns(2 * changed, 2).clone_owned();
                let small = DMatrix::identity(2, 2) + &d * &columns;
                match small.try_inverse() {
                    Some(small) => {
                        let by = columns * small;
                        let rows = d * &*old;
                        old.gemm(-1.0, &by, &rows, 1.0);
                        updates += 1;
                    }
                    None => inverse = None,
                }
            }
        }
        None
    }
}
