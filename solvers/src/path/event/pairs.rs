//! The rate problem as a linear complementarity problem over all facets without slack, with a
//! multiplier each: pivoting, and a search that proves what there is not.
//!
//! ```text
//! ġ = −Σ z_i d_i,   w_i = −a_i·ṙ = q_i λ̇ + Σ M_ij z_j,   0 ≤ z_i ⟂ w_i ≥ 0,   M_ij = a_i·S d_j
//! ```
//!
//! Rates with λ̇ ≥ 0 are found together by one more unknown t = λ̇ ≥ 0 and the row Σ z + t ≥ 1, which
//! leaves out the rate that is nothing (each solution can be scaled; `counted`); those with λ̇ < 0 on which a point
//! that has just arrived flows with t = −λ̇ and Σ z ≥ 1 over these points.

use super::lcp::{Lemke, lemke};
use super::rate::{Piece, Rate, RateProblem, Verdict};
use super::system::PointFacet;
use crate::path::complementarity::{Complementarity, Known};
use nalgebra::{DMatrix, DVector};
use voussoir_core::law::FacetMode;

/// Relative tolerance of what pivoting finds.
const PIVOTING: f64 = 1e-7;
/// Facets above which it is not pivoted, and not searched.
const PIVOTED: usize = 900;
const SEARCHED: usize = 160;
/// Linear programs of a search.
const PROGRAMS: u64 = 4000;

/// What pivoting found.
pub(super) enum Pivoted {
    /// Pieces close to a solution.
    Guess(Vec<Piece>),
    /// A mechanism.
    Ray(Rate),
}

/// The complementarity problem, each facet in its own scale.
struct Pairs {
    /// (point, facet).
    facets: Vec<(usize, usize)>,
    /// Scale of each.
    unit: Vec<f64>,
    /// M.
    m: DMatrix<f64>,
    /// q.
    q: DVector<f64>,
}

/// What is known of a complementarity problem; `counters` counts linear programs.
fn asked(matrix: DMatrix<f64>, constant: DVector<f64>, counters: &mut u64) -> Known {
    let (known, programs) = Complementarity { matrix, constant }.search(PROGRAMS);
    *counters += programs;
    known
}

impl RateProblem<'_> {
    /// With the laws' own flow or an associated one. `None` where points are open with a strength: their
    /// multipliers have any sign.
    fn pairs(&self, associated: bool) -> Option<Pairs> {
        if self.points.iter().any(|p| p.open.is_some()) {
            return None;
        }
        let facets: Vec<(usize, usize)> =
            self.points.iter().enumerate().flat_map(|(k, p)| p.active.iter().map(move |f| (k, *f))).collect();
        let n = facets.len();
        let m = DMatrix::from_fn(n, n, |i, j| {
            let (k, l) = (facets[i].0, facets[j].0);
            let (a, d) = (self.facet(facets[i]).normal, self.flow(facets[j], associated));
            a[0] * (self.s[(2 * k, 2 * l)] * d[0] + self.s[(2 * k, 2 * l + 1)] * d[1])
                + a[1] * (self.s[(2 * k + 1, 2 * l)] * d[0] + self.s[(2 * k + 1, 2 * l + 1)] * d[1])
        });
        let largest = m.diagonal().amax();
        let unit: Vec<f64> = m.diagonal().iter().map(|d| d.abs().max(1e-12 * largest).sqrt()).collect();
        let m = DMatrix::from_fn(n, n, |i, j| m[(i, j)] / (unit[i] * unit[j]));
        let q = DVector::from_fn(n, |i, _| {
            let (k, a) = (facets[i].0, self.facet(facets[i]).normal);
            -(a[0] * self.load_rate[2 * k] + a[1] * self.load_rate[2 * k + 1]) / unit[i]
        });
        Some(Pairs { facets, unit, m, q })
    }

    fn facet(&self, (k, f): (usize, usize)) -> &PointFacet {
        &self.points[k].facets[f]
    }

    fn flow(&self, at: (usize, usize), associated: bool) -> [f64; 2] {
        let facet = self.facet(at);
        if associated { facet.normal } else { facet.flow }
    }

    /// ġ of multipliers.
    fn gaps_of(&self, pairs: &Pairs, z: &[f64], associated: bool) -> Vec<[f64; 2]> {
        let mut gaps = vec![[0.0; 2]; self.points.len()];
        for ((at, unit), z) in pairs.facets.iter().zip(&pairs.unit).zip(z) {
            let d = self.flow(*at, associated);
            (0..2).for_each(|i| gaps[at.0][i] -= z / unit * d[i]);
        }
        gaps
    }

    /// Lemke's pivoting over all active facets, with their own flow or an associated one: pieces to
    /// correct, or the ray of a mechanism.
    pub(super) fn pivoted(&self, associated: bool, counters: &mut u64) -> Option<Pivoted> {
        let pairs = self.pairs(associated).filter(|pairs| pairs.facets.len() <= PIVOTED)?;
        let Pairs { facets, unit, m, q } = &pairs;
        let (z, ray) = match lemke(m, q, counters) {
            Lemke::Solution(z) => (z, false),
            Lemke::Ray(z) => (z, true),
            Lemke::Unfinished => return None,
        };
        let mut gaps = self.gaps_of(&pairs, &z, associated);
        let z_size = z.iter().copied().fold(1e-300, f64::max);
        if ray {
            let w = m * DVector::from_vec(z.clone());
            let moves = gaps.iter().flatten().fold(0.0, |a: f64, g| a.max(g.abs()));
            let largest = unit.iter().copied().fold(0.0, f64::max);
            let still = w.amax() <= PIVOTING * z_size && z.iter().all(|z| *z >= -PIVOTING * z_size);
            if !still
                || moves * largest <= PIVOTING * z_size
                || (!associated && q.dot(&DVector::from_vec(z.clone())) > 0.0)
            {
                return None;
            }
            let pieces = self.read(facets, |i| z[i] > 1e-8 * z_size);
            // What does not flow does not move, not even by rounding.
            for (gap, _) in gaps.iter_mut().zip(&pieces).filter(|(_, piece)| **piece == Piece::Stick) {
                *gap = [0.0; 2];
            }
            return Some(Pivoted::Ray(Rate { factor: 0.0, pieces, gaps }));
        }
        let w = q + m * DVector::from_vec(z.clone());
        let w_size = w.amax().max(1e-300);
        let pieces = self.read(facets, |i| z[i] / z_size > (w[i] / w_size).max(1e-12));
        Some(Pivoted::Guess(pieces))
    }

    /// Pieces and ġ of multipliers that solve the problem.
    fn moving(&self, pairs: &Pairs, z: &[f64]) -> (Vec<Piece>, Vec<[f64; 2]>) {
        let most = z.iter().copied().fold(1e-300, f64::max);
        let w = &pairs.m * DVector::from_column_slice(z);
        let pieces = self.read(&pairs.facets, |i| z[i] > 1e-9 * most && z[i] > 1e-9 * w[i]);
        (pieces, self.gaps_of(pairs, z, false))
    }

    /// Searches for a rate with λ growing, else for one with λ standing still, else for one with λ falling.
    /// `None` where that is not decided.
    pub(super) fn searched(&self, counters: &mut u64) -> Option<Verdict> {
        let pairs = self.pairs(false).filter(|pairs| pairs.facets.len() <= SEARCHED)?;
        let size = pairs.q.amax();
        if size == 0.0 {
            return None;
        }
        let q = &pairs.q / size;
        match asked(pairs.m.clone(), q.clone(), counters) {
            Known::Solution(z) => {
                return self.corrected(self.moving(&pairs, &z).0, counters).map(|rate| Verdict::Found(rate, None));
            }
            Known::Undecided(_) => return None,
            Known::None => {}
        }
        Some(self.standing_or_falling(&pairs, &q, counters).unwrap_or(Verdict::NoneRises))
    }

    /// The search where no rate has λ growing, for `q` of size one.
    fn standing_or_falling(&self, pairs: &Pairs, q: &DVector<f64>, counters: &mut u64) -> Option<Verdict> {
        let n = pairs.facets.len();
        // t in column n; its row and the column of the last row's partner are empty.
        let cone = |sense: f64, counted: &[f64]| {
            DMatrix::from_fn(n + 2, n + 2, |i, j| match (i < n, j < n) {
                (true, true) => pairs.m[(i, j)],
                (true, false) if j == n => sense * q[i],
                (false, _) if i == n + 1 && j <= n => counted[j],
                _ => 0.0,
            })
        };
        let least = DVector::from_fn(n + 2, |i, _| if i == n + 1 { -1.0 } else { 0.0 });
        for counted in self.counted(pairs, true, |_| true) {
            match asked(cone(1.0, &counted), least.clone(), counters) {
                Known::Solution(z) => {
                    let (pieces, gaps) = self.moving(pairs, &z[..n]);
                    let rate = self.mechanism(&pieces, &gaps).filter(|_| z[n] <= PIVOTING)?;
                    return self.proves(counters).then_some(Verdict::Found(rate, None));
                }
                Known::Undecided(_) => return None,
                Known::None => {}
            }
        }
        // Mere unloading is none: a point that has just arrived must flow.
        for counted in self.counted(pairs, false, |k| self.points[k].hit) {
            match asked(cone(-1.0, &counted), least.clone(), counters) {
                Known::Solution(z) => {
                    let rate = self.exactly(self.moving(pairs, &z[..n]).0, -1.0)?;
                    return self.goes_on(&rate).then_some(Verdict::Falling(rate));
                }
                Known::Undecided(_) => return None,
                Known::None => {}
            }
        }
        Some(Verdict::Nothing)
    }

    /// Sums of multipliers (and, last, of t) at some points, one of which is positive wherever something
    /// moves there. At an apex both senses of slip together are no motion: openings are counted with all
    /// else, and each sense of slip in a sum of its own.
    fn counted(&self, pairs: &Pairs, with_t: bool, at: impl Fn(usize) -> bool) -> Vec<Vec<f64>> {
        let n = pairs.facets.len();
        let slips = |i: usize| {
            let (k, f) = pairs.facets[i];
            self.points[k].apex && self.points[k].facets[f].mode == FacetMode::Sliding
        };
        let counts = |i: usize| f64::from(at(pairs.facets[i].0) && !slips(i));
        let mut sums = vec![(0..n).map(counts).chain([f64::from(with_t)]).collect::<Vec<f64>>()];
        for i in (0..n).filter(|i| at(pairs.facets[*i].0) && slips(*i)) {
            let share = |j: usize| match (j == i, j < n && pairs.facets[j].0 == pairs.facets[i].0 && slips(j)) {
                (true, _) => 1.0,
                (false, true) => -pairs.unit[i] / pairs.unit[j],
                _ => 0.0,
            };
            sums.push((0..=n).map(share).collect());
        }
        sums
    }

    /// Pieces from which facets (point, index) flow.
    fn read(&self, facets: &[(usize, usize)], flows: impl Fn(usize) -> bool) -> Vec<Piece> {
        let mut pieces = vec![Piece::Stick; self.points.len()];
        for i in (0..facets.len()).filter(|i| flows(*i)) {
            let (k, f) = facets[i];
            let point = &self.points[k];
            let opens = point.facets[f].mode == FacetMode::Opening;
            pieces[k] = match pieces[k] {
                Piece::Stick if point.apex && opens => Piece::Free,
                Piece::Stick => Piece::Facet(f),
                _ if point.apex => Piece::Free,
                Piece::Facet(other) => Piece::Corner(other, f),
                kept => kept,
            };
        }
        pieces
    }
}

#[cfg(test)]
mod tests {
    use super::super::rate::Verge;
    use super::super::system::PointFacet;
    use super::*;
    use crate::path::shuffle::Shuffle;

    /// Dry friction without dilatancy at its apex.
    fn facets(friction: f64) -> Vec<PointFacet> {
        let slide = |sense: f64| PointFacet {
            normal: [-friction, sense],
            bound: 0.0,
            flow: [0.0, sense],
            mode: FacetMode::Sliding,
        };
        let open = PointFacet { normal: [-1.0, 0.0], bound: 0.0, flow: [-1.0, 0.0], mode: FacetMode::Opening };
        vec![open, slide(1.0), slide(-1.0)]
    }

    /// The search and every combination of pieces find the same kind of rate.
    #[test]
    fn the_search_agrees_with_every_combination() {
        let mut shuffle = Shuffle::new(11);
        let mut kinds = [0; 4];
        for number in 0..300 {
            let count = 1 + number % 3;
            let laws = facets(0.3 + 1.2 * (number % 5) as f64);
            let root = DMatrix::from_fn(2 * count, 2 * count, |_, _| shuffle.next());
            // At the apex, or pressed and slipping one way.
            let point = |k: usize| Verge {
                facets: &laws,
                active: if (number + k).is_multiple_of(4) { vec![0, 1, 2] } else { vec![1 + k % 2] },
                open: None,
                apex: (number + k).is_multiple_of(4),
                guess: Piece::Stick,
                hit: true,
                stiffness: 1.0,
            };
            let problem = RateProblem {
                points: (0..count).map(point).collect(),
                s: &root * root.transpose() + DMatrix::identity(2 * count, 2 * count) * 0.01,
                load_rate: DVector::from_fn(2 * count, |_, _| shuffle.next()),
                from_nothing: false,
            };
            let all = problem.enumerated(&mut 0);
            let known = if all.iter().any(|r| r.factor > 0.0) {
                0
            } else if all.iter().any(|r| r.factor == 0.0) {
                1
            } else if all.iter().any(|r| problem.goes_on(r)) {
                2
            } else {
                3
            };
            let found = match problem.searched(&mut 0).expect("decided") {
                Verdict::Found(rate, _) if rate.factor > 0.0 => 0,
                Verdict::Found(..) => 1,
                Verdict::Falling(_) => 2,
                _ => 3,
            };
            assert_eq!(known, found, "{number}: {all:?}");
            kinds[known] += 1;
        }
        assert!(kinds[0] > 100 && kinds[2] + kinds[3] > 10, "{kinds:?}");
    }
}
