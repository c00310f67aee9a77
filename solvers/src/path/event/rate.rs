//! The rate problem over the contact points at the verge of a change.
//!
//! Everything else keeps its piece (stuck, flowing, free), so that forces and gaps of those points
//! are linear: ṙ = S ġ + s λ̇. Each of them must find a piece of its law:
//!
//! - stuck: ġ = 0 and no active facet is left (ṡ ≥ 0);
//! - flowing on facet i: ṡ_i = 0, ġ = −γ d_i, γ ≥ 0 (either sign for an opening facet that is open);
//! - at a corner of facets i and j: ṙ = 0, ġ = −γ_i d_i − γ_j d_j;
//! - free (the apex of dry friction): ṙ = 0, ġ_n ≥ tan ψ |ġ_t|.
//!
//! Found by guess and correction (a primal–dual active set); where that fails, every combination of
//! pieces is tried, which also finds rays (λ̇ = 0) and falling branches (λ̇ < 0) and proves that
//! there is no other; where there are too many combinations, by Lemke's pivoting, piecewise linear
//! paths, or at last a search.
//! Sources: Klarbring (1990), Ing.-Arch. 60; Björkman (1992) on rate problems with friction; the
//! pieces are those of Alart and Curnier (1991).

use super::pairs::Pivoted;
use super::system::{PointFacet, dot};
use nalgebra::{DMatrix, DVector};
use voussoir_core::law::FacetMode;

/// What a contact point does in a rate.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Piece {
    /// ġ = 0.
    Stick,
    /// Flow on one facet.
    Facet(usize),
    /// Flow on two facets.
    Corner(usize, usize),
    /// ṙ = 0 at the apex, ġ as it comes.
    Free,
}

/// A contact point at the verge of a change.
#[derive(Debug, Clone)]
pub struct Verge<'a> {
    /// Its facets.
    pub facets: &'a [PointFacet],
    /// Which of them have no slack.
    pub active: Vec<usize>,
    /// The opening facet, where the point is open without being free.
    pub open: Option<usize>,
    /// Whether it is at the apex, where it may be free.
    pub apex: bool,
    /// Its present piece, or where it has just arrived.
    pub guess: Piece,
    /// Whether it has just arrived.
    pub hit: bool,
    /// Unit of its stiffness.
    pub stiffness: f64,
}

/// tan ψ of the dilatant slip of a point: how much it opens per unit of slip.
pub fn dilatancy(facets: &[PointFacet]) -> f64 {
    facets
        .iter()
        .filter(|f| f.mode == FacetMode::Sliding && f.flow[1] != 0.0)
        .map(|f| -f.flow[0] / f.flow[1].abs())
        .fold(0.0, f64::max)
}

impl Verge<'_> {
    /// The pieces it may take.
    pub fn candidates(&self) -> Vec<Piece> {
        if let Some(open) = self.open {
            let corners = self.active.iter().filter(|f| **f != open).map(|f| Piece::Corner(open, *f));
            return std::iter::once(Piece::Facet(open)).chain(corners).collect();
        }
        let sliding = |f: &&usize| !self.apex || self.facets[**f].mode != FacetMode::Opening;
        let mut pieces = vec![Piece::Stick];
        pieces.extend(self.active.iter().filter(sliding).map(|f| Piece::Facet(*f)));
        if self.apex {
            pieces.push(Piece::Free);
        } else {
            for (k, i) in self.active.iter().enumerate() {
                pieces.extend(
                    self.active[k + 1..].iter().filter(|j| self.independent(*i, **j)).map(|j| Piece::Corner(*i, *j)),
                );
            }
        }
        pieces
    }

    fn independent(&self, i: usize, j: usize) -> bool {
        let (a, b) = (self.facets[i].normal, self.facets[j].normal);
        (a[0] * b[1] - a[1] * b[0]).abs() > 1e-9 * (a[0].hypot(a[1]) * b[0].hypot(b[1]))
    }

    /// The unknowns of a piece from the rate of the gap.
    pub fn unknowns(&self, piece: Piece, gap: [f64; 2]) -> Vec<f64> {
        match piece {
            Piece::Stick => Vec::new(),
            Piece::Facet(f) => {
                let d = self.facets[f].flow;
                vec![-dot(gap, d) / dot(d, d)]
            }
            Piece::Corner(i, j) => corner(self.facets[i].flow, self.facets[j].flow, gap).to_vec(),
            Piece::Free => gap.to_vec(),
        }
    }

    /// Directions of ġ per unknown of a piece.
    fn flows(&self, piece: Piece) -> Vec<[f64; 2]> {
        let minus = |f: usize| self.facets[f].flow.map(|d| -d);
        match piece {
            Piece::Stick => Vec::new(),
            Piece::Facet(f) => vec![minus(f)],
            Piece::Corner(i, j) => vec![minus(i), minus(j)],
            Piece::Free => vec![[1.0, 0.0], [0.0, 1.0]],
        }
    }

    /// Functionals of ṙ that vanish in a piece.
    fn rows(&self, piece: Piece) -> Vec<[f64; 2]> {
        let minus = |f: usize| self.facets[f].normal.map(|a| -a);
        match piece {
            Piece::Stick => Vec::new(),
            Piece::Facet(f) => vec![minus(f)],
            Piece::Corner(i, j) => vec![minus(i), minus(j)],
            Piece::Free => vec![[1.0, 0.0], [0.0, 1.0]],
        }
    }

    /// How far a rate leaves its piece: the worst violation, relative to the given sizes of force
    /// and gap rates, and the piece that mends it.
    pub fn violation(&self, piece: Piece, v: &[f64], force: [f64; 2], sizes: [f64; 2]) -> Option<(f64, Piece)> {
        let [force_size, gap_size] = sizes;
        let mut worst: Option<(f64, Piece)> = None;
        let mut note = |size: f64, to: Piece| {
            if size > 0.0 && worst.is_none_or(|w| size > w.0) {
                worst = Some((size, to));
            }
        };
        let flowing = |f: usize| match piece {
            Piece::Facet(i) => i == f,
            Piece::Corner(i, j) => i == f || j == f,
            _ => false,
        };
        match piece {
            Piece::Stick => {}
            Piece::Facet(f) if Some(f) == self.open => {}
            Piece::Facet(_) => note(-v[0] / gap_size, Piece::Stick),
            Piece::Corner(i, j) => {
                for (k, (own, other)) in [(i, j), (j, i)].into_iter().enumerate() {
                    if Some(own) != self.open {
                        note(-v[k] / gap_size, Piece::Facet(other));
                    }
                }
            }
            Piece::Free => {
                let closing = dilatancy(self.facets) * v[1].abs() - v[0];
                let slide = self.active.iter().copied().find(|f| {
                    let facet = &self.facets[*f];
                    facet.mode == FacetMode::Sliding && facet.flow[1] * v[1] < 0.0
                });
                note(closing / gap_size, slide.map_or(Piece::Stick, Piece::Facet));
            }
        }
        if piece != Piece::Free {
            for &f in self.active.iter().filter(|f| !flowing(**f)) {
                let excess = dot(self.facets[f].normal, force) / force_size;
                let to = match piece {
                    _ if self.apex && self.facets[f].mode == FacetMode::Opening => Piece::Free,
                    Piece::Facet(i) if self.apex => {
                        let both =
                            self.facets[i].mode == FacetMode::Sliding && self.facets[f].mode == FacetMode::Sliding;
                        if both { Piece::Free } else { Piece::Facet(f) }
                    }
                    Piece::Facet(i) if self.independent(i, f) => Piece::Corner(i, f),
                    _ => Piece::Facet(f),
                };
                note(excess, to);
            }
        }
        worst
    }
}

/// A solution of the rate problem.
#[derive(Debug, Clone)]
pub struct Rate {
    /// 1, 0 or −1: the sense of λ.
    pub factor: f64,
    /// Piece of each point.
    pub pieces: Vec<Piece>,
    /// ġ of each point.
    pub gaps: Vec<[f64; 2]>,
}

/// What is known of the solutions.
#[derive(Debug, Clone)]
pub enum Verdict {
    /// One was taken; how many others with growing λ there are, where that was examined.
    Found(Rate, Option<usize>),
    /// None with λ̇ ≥ 0 (all combinations were tried); one with λ̇ < 0 that is no mere unloading.
    Falling(Rate),
    /// None at all that goes on: all combinations were tried.
    Nothing,
    /// None with λ̇ > 0; whether there are others is not decided.
    NoneRises,
    /// Not decided: too many combinations.
    Undecided(usize),
}

/// Share of a singular value below which a combination of pieces is a mechanism.
const SINGULAR: f64 = 1e-10;
/// Relative tolerance of inequalities.
const INEQUALITY: f64 = 1e-10;
/// Unknowns above which linear algebra is that of large systems.
const LARGE: usize = 30;
/// Combinations that are tried.
const COMBINATIONS: usize = 140_000;

/// Combinations up to which all are tried at once.
const FEW: usize = 3000;
/// Points up to which a rate problem is searched for other solutions, and guesses for that.
const EXAMINED: usize = 12;
const EXAMINATIONS: u64 = 1;
/// Guesses from which a piecewise linear path is followed.
const STARTS: u64 = 8;

/// The rate problem: ṙ = `s` ġ + `load_rate` λ̇ over the points.
#[derive(Debug)]
pub struct RateProblem<'a> {
    /// Points at the verge of a change.
    pub points: Vec<Verge<'a>>,
    /// S.
    pub s: DMatrix<f64>,
    /// s.
    pub load_rate: DVector<f64>,
    /// Whether nothing is loaded yet: then every sliding motion is without forces, and one that is not
    /// associated does not prove that the load cannot be carried.
    pub from_nothing: bool,
}

pub(super) struct Attempt {
    unknowns: Vec<f64>,
    pub(super) gaps: DVector<f64>,
    forces: DVector<f64>,
    pub(super) singular: bool,
}

impl Attempt {
    fn gaps_of_points(&self) -> Vec<[f64; 2]> {
        self.gaps.as_slice().chunks_exact(2).map(|gap| [gap[0], gap[1]]).collect()
    }
}

/// A direction at a point.
type At = (usize, [f64; 2]);

impl RateProblem<'_> {
    /// Directions of ġ and functionals of ṙ of a combination of pieces, in the points' own units.
    fn flows_and_rows(&self, pieces: &[Piece]) -> (Vec<At>, Vec<At>) {
        let (mut flows, mut rows) = (Vec::new(), Vec::new());
        for (k, (point, piece)) in self.points.iter().zip(pieces).enumerate() {
            let unit = point.stiffness.sqrt();
            flows.extend(point.flows(*piece).into_iter().map(|f| (k, f.map(|x| x / unit))));
            rows.extend(point.rows(*piece).into_iter().map(|r| (k, r.map(|x| x / unit))));
        }
        (flows, rows)
    }

    fn matrix(&self, flows: &[At], rows: &[At]) -> DMatrix<f64> {
        let entry = |(i, a): &At, (j, d): &At| {
            a[0] * (self.s[(2 * i, 2 * j)] * d[0] + self.s[(2 * i, 2 * j + 1)] * d[1])
                + a[1] * (self.s[(2 * i + 1, 2 * j)] * d[0] + self.s[(2 * i + 1, 2 * j + 1)] * d[1])
        };
        DMatrix::from_fn(flows.len(), flows.len(), |i, j| entry(&rows[i], &flows[j]))
    }

    fn system(&self, pieces: &[Piece]) -> (Vec<At>, DMatrix<f64>) {
        let (flows, rows) = self.flows_and_rows(pieces);
        let matrix = self.matrix(&flows, &rows);
        (flows, matrix)
    }

    /// Solves for the unknowns of a combination of pieces with λ̇ = `factor`; where the combination
    /// is singular with one null vector, that vector.
    pub(super) fn attempt(&self, pieces: &[Piece], factor: f64) -> Option<Attempt> {
        let (flows, rows) = self.flows_and_rows(pieces);
        let n = flows.len();
        let mut singular = false;
        let scaled: Vec<f64> = if n == 0 {
            Vec::new()
        } else {
            let matrix = self.matrix(&flows, &rows);
            let right = DVector::from_fn(n, |i, _| {
                let (k, a) = &rows[i];
                -(a[0] * self.load_rate[2 * k] + a[1] * self.load_rate[2 * k + 1]) * factor
            });
            if n > LARGE {
                let lu = matrix.lu();
                let solved: Vec<f64> = lu.solve(&right)?.iter().copied().collect();
                let pivots = lu.u().diagonal().abs();
                if pivots.min() <= SINGULAR * 1e-3 * pivots.max() {
                    return None;
                }
                return self.completed(&flows, &solved, factor, false);
            }
            let svd = matrix.svd(true, true);
            let (u, v_t) = (svd.u.as_ref()?, svd.v_t.as_ref()?);
            let null = svd.singular_values.iter().filter(|s| **s <= SINGULAR).count();
            match null {
                0 => {
                    let projected = u.transpose() * right;
                    let weighted = DVector::from_fn(n, |i, _| projected[i] / svd.singular_values[i]);
                    (v_t.transpose() * weighted).iter().copied().collect()
                }
                1 => {
                    singular = true;
                    let least = svd.singular_values.imin();
                    v_t.row(least).iter().copied().collect()
                }
                _ => return None,
            }
        };
        self.completed(&flows, &scaled, factor, singular)
    }

    /// Gaps, forces and unknowns of an attempt from the scaled unknowns.
    fn completed(&self, flows: &[(usize, [f64; 2])], scaled: &[f64], factor: f64, singular: bool) -> Option<Attempt> {
        let mut gaps = DVector::zeros(2 * self.points.len());
        for ((k, f), c) in flows.iter().zip(scaled) {
            gaps[2 * k] += f[0] * c;
            gaps[2 * k + 1] += f[1] * c;
        }
        let forces = &self.s * &gaps + &self.load_rate * if singular { 0.0 } else { factor };
        let unknowns = scaled.iter().zip(flows).map(|(v, (k, _))| v / self.points[*k].stiffness.sqrt()).collect();
        Some(Attempt { unknowns, gaps, forces, singular })
    }

    /// The worst violation of an attempt, with the point and the piece that mends it; all of them
    /// in `all`.
    fn violations(&self, pieces: &[Piece], attempt: &Attempt, sign: f64) -> Vec<(f64, usize, Piece)> {
        let gap_size = attempt.gaps.amax().max(1e-300);
        let force_size = attempt.forces.amax().max(if attempt.singular {
            // A mechanism moves without forces: their size is that of what stiffness could do.
            gap_size * self.points.iter().map(|p| p.stiffness).fold(0.0, f64::max)
        } else {
            1e-4 * self.load_rate.amax()
        });
        let sizes = [force_size.max(1e-300), gap_size];
        let mut at = 0;
        let mut out = Vec::new();
        for (k, (point, piece)) in self.points.iter().zip(pieces).enumerate() {
            let count = point.flows(*piece).len();
            let v: Vec<f64> = attempt.unknowns[at..at + count].iter().map(|v| v * sign).collect();
            at += count;
            let force = [attempt.forces[2 * k] * sign, attempt.forces[2 * k + 1] * sign];
            if let Some((size, to)) = point.violation(*piece, &v, force, sizes)
                && size > INEQUALITY
            {
                out.push((size, k, to));
            }
        }
        out
    }

    fn rate(&self, pieces: &[Piece], attempt: &Attempt, sign: f64, factor: f64) -> Rate {
        let gaps = attempt.gaps_of_points().into_iter().map(|gap| gap.map(|g| g * sign));
        Rate { factor, pieces: pieces.to_vec(), gaps: gaps.collect() }
    }

    /// Work of the load on a motion without forces, by virtual work with the forces that a growing
    /// load causes at points that do not move (exact where all else sticks or flows associated). At
    /// a constant load a path goes on in the sense in which the load does work, not back.
    fn power(&self, gaps: &[[f64; 2]]) -> f64 {
        -gaps.iter().flatten().zip(&self.load_rate).map(|(gap, force)| gap * force).sum::<f64>()
    }

    /// Whether a rate is one along which a path goes on: λ grows, or the load does work.
    fn leads_on(&self, rate: &Rate) -> bool {
        let gaps = rate.gaps.iter().flatten();
        let size = gaps.zip(&self.load_rate).map(|(gap, force)| (gap * force).abs()).sum::<f64>();
        rate.factor > 0.0 || (rate.factor == 0.0 && self.power(&rate.gaps) > INEQUALITY * size)
    }

    /// Whether a rate with λ falling is more than unloading: a point that has just arrived flows.
    pub(super) fn goes_on(&self, rate: &Rate) -> bool {
        let mut points = self.points.iter().zip(&rate.pieces);
        rate.factor < 0.0 && points.any(|(point, piece)| point.hit && *piece != Piece::Stick)
    }

    /// The rate of some pieces with λ̇ = `factor`, where it fits them.
    pub(super) fn exactly(&self, pieces: Vec<Piece>, factor: f64) -> Option<Rate> {
        let attempt = self.attempt(&pieces, 1.0).filter(|attempt| !attempt.singular)?;
        self.violations(&pieces, &attempt, factor).is_empty().then(|| self.rate(&pieces, &attempt, factor, factor))
    }

    /// Guess and correction with λ̇ = 1.
    pub fn corrected(&self, mut pieces: Vec<Piece>, counters: &mut u64) -> Option<Rate> {
        let mut seen = Vec::new();
        for round in 0..60 + self.points.len() {
            *counters += 1;
            let attempt = self.attempt(&pieces, 1.0)?;
            if attempt.singular {
                return None;
            }
            let mut violations = self.violations(&pieces, &attempt, 1.0);
            if violations.is_empty() {
                return Some(self.rate(&pieces, &attempt, 1.0, 1.0));
            }
            if seen.contains(&pieces) && round > 12 {
                // One at a time, the first by number, cannot jump about.
                violations.sort_by_key(|v| v.1);
                violations.truncate(1);
                if round > 30 && seen.iter().filter(|s| **s == pieces).count() > 2 {
                    return None;
                }
            }
            seen.push(pieces.clone());
            for (_, k, to) in violations {
                pieces[k] = to;
            }
        }
        None
    }

    /// The motion at constant load that some pieces allow, where the load does work on it.
    pub fn at_constant_load(&self, pieces: &[Piece]) -> Option<Rate> {
        let attempt = self.attempt(pieces, 1.0).filter(|attempt| attempt.singular)?;
        let fits = |sign: &f64| {
            self.violations(pieces, &attempt, *sign).is_empty()
                && self.leads_on(&self.rate(pieces, &attempt, *sign, 0.0))
        };
        [1.0, -1.0].into_iter().find(fits).map(|sign| self.rate(pieces, &attempt, sign, 0.0))
    }

    /// Number of combinations of pieces.
    pub fn combinations(&self) -> usize {
        self.points.iter().fold(1usize, |n, p| n.saturating_mul(p.candidates().len()))
    }

    /// Every combination of pieces.
    pub(super) fn enumerated(&self, counters: &mut u64) -> Vec<Rate> {
        let candidates: Vec<Vec<Piece>> = self.points.iter().map(Verge::candidates).collect();
        let mut found: Vec<Rate> = Vec::new();
        let mut index = vec![0; candidates.len()];
        loop {
            *counters += 1;
            let pieces: Vec<Piece> = index.iter().zip(&candidates).map(|(i, c)| c[*i]).collect();
            if let Some(attempt) = self.attempt(&pieces, 1.0) {
                for sign in [1.0, -1.0] {
                    if self.violations(&pieces, &attempt, sign).is_empty() {
                        let factor = if attempt.singular { 0.0 } else { sign };
                        let rate = self.rate(&pieces, &attempt, sign, factor);
                        let size = attempt.gaps.amax().max(1e-300);
                        let same = |other: &Rate| {
                            other.factor == rate.factor
                                && other
                                    .gaps
                                    .iter()
                                    .flatten()
                                    .zip(rate.gaps.iter().flatten())
                                    .all(|(a, b)| (a - b).abs() <= 1e-7 * size)
                        };
                        if !found.iter().any(same) {
                            found.push(rate);
                        }
                    }
                }
            }
            let Some(place) = (0..index.len()).find(|i| index[*i] + 1 < candidates[*i].len()) else {
                return found;
            };
            index[..place].iter_mut().for_each(|i| *i = 0);
            index[place] += 1;
        }
    }

    /// Associated flow makes the problem monotone: from its solution the flow is turned step by step
    /// into the law's own.
    fn turned_from_associated(&self, counters: &mut u64) -> Option<Rate> {
        let Some(Pivoted::Guess(mut pieces)) = self.pivoted(true, counters) else { return None };
        for own in [0.0, 0.25, 0.5, 0.7, 0.85, 0.95, 1.0] {
            let turned =
                |f: &PointFacet| PointFacet { flow: [0, 1].map(|i| (1.0 - own) * f.normal[i] + own * f.flow[i]), ..*f };
            let facets: Vec<Vec<PointFacet>> =
                self.points.iter().map(|p| p.facets.iter().map(turned).collect()).collect();
            let points = self.points.iter().zip(&facets).map(|(p, facets)| Verge { facets, ..p.clone() }).collect();
            let problem =
                RateProblem { points, s: self.s.clone(), load_rate: self.load_rate.clone(), from_nothing: false };
            match problem.corrected(pieces.clone(), counters) {
                Some(rate) if own == 1.0 => return Some(rate),
                Some(rate) => pieces = rate.pieces,
                None => {}
            }
        }
        None
    }

    /// By the piecewise linear path, from several guesses.
    fn by_homotopy(&self, starts: u64, counters: &mut u64) -> Option<Rate> {
        let mut mechanism = None;
        for number in 0..starts {
            let Some((pieces, gaps)) = self.followed(1.0, number, counters) else { continue };
            if let Some(rate) = self.corrected(pieces.clone(), counters) {
                return Some(rate);
            }
            mechanism = mechanism.or_else(|| self.mechanism(&pieces, &gaps));
            // With associated flow a mechanism excludes that the load grows.
            if mechanism.is_some() && self.associated() {
                break;
            }
        }
        mechanism.filter(|_| self.proves(counters))
    }

    fn associated(&self) -> bool {
        self.points.iter().flat_map(|p| p.facets).all(|f| f.flow == f.normal)
    }

    /// Whether a mechanism means that the load does not grow: from nothing only where slip with
    /// associated flow does not carry it either.
    pub(super) fn proves(&self, counters: &mut u64) -> bool {
        !self.from_nothing || self.associated() || matches!(self.pivoted(true, counters), Some(Pivoted::Ray(_)))
    }

    /// How many other solutions paths from random guesses find.
    fn others(&self, rate: &Rate, counters: &mut u64) -> usize {
        let mut found = vec![rate.clone()];
        for number in 1..=EXAMINATIONS {
            let Some((pieces, _)) = self.followed(1.0, number, counters) else { continue };
            let Some(other) = self.corrected(pieces, counters) else { continue };
            let size = other.gaps.iter().flatten().fold(1e-300, |a: f64, g| a.max(g.abs()));
            let same = |known: &Rate| {
                let pairs = known.gaps.iter().flatten().zip(other.gaps.iter().flatten());
                pairs.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) <= 1e-6 * size
            };
            if !found.iter().any(same) {
                found.push(other);
            }
        }
        found.len() - 1
    }

    /// A motion without forces in which every point keeps its piece, close to a given one.
    pub(super) fn mechanism(&self, pieces: &[Piece], gaps: &[[f64; 2]]) -> Option<Rate> {
        let (flows, matrix) = self.system(pieces);
        let n = flows.len();
        if n == 0 {
            return None;
        }
        // Inverse iteration: what the matrix makes nothing of the given motion.
        let shifted = &matrix + DMatrix::identity(n, n) * (1e-12 * matrix.amax().max(1e-300));
        let lu = shifted.lu();
        let points = self.points.iter().zip(pieces).zip(gaps);
        let unknowns = points.flat_map(|((point, piece), gap)| {
            let unit = point.stiffness.sqrt();
            point.unknowns(*piece, *gap).into_iter().map(move |v| v * unit)
        });
        let mut v = DVector::from_vec(unknowns.collect::<Vec<f64>>());
        if v.len() != n || v.amax() == 0.0 {
            return None;
        }
        for _ in 0..4 {
            v = lu.solve(&v)?;
            let size = v.amax();
            if !size.is_finite() || size == 0.0 {
                return None;
            }
            v /= size;
        }
        if (&matrix * &v).amax() > 1e-9 * matrix.amax() {
            return None;
        }
        let v: Vec<f64> = v.iter().copied().collect();
        let attempt = self.completed(&flows, &v, 1.0, true)?;
        let forward = if self.power(&attempt.gaps_of_points()) < 0.0 { -1.0 } else { 1.0 };
        let sign = [forward, -forward].into_iter().find(|sign| self.violations(pieces, &attempt, *sign).is_empty())?;
        Some(self.rate(pieces, &attempt, sign, 0.0))
    }

    /// Solves the rate problem. `examine` asks for the number of other solutions where it is cheap.
    pub fn solve(&self, examine: bool, counters: &mut u64) -> Verdict {
        let combinations = self.combinations();
        let guess = self.points.iter().map(|p| p.guess).collect();
        let corrected = self.corrected(guess, counters);
        if let Some(rate) = corrected {
            let others = match combinations {
                _ if !examine => None,
                0..=super::direction::EXAMINED => {
                    let all = self.enumerated(counters);
                    Some(all.iter().filter(|r| self.leads_on(r)).count().saturating_sub(1))
                }
                _ if self.points.len() <= EXAMINED => Some(self.others(&rate, counters)),
                _ => None,
            };
            return Verdict::Found(rate, others);
        }
        if (FEW..=COMBINATIONS).contains(&combinations)
            && let Some(rate) = self.by_homotopy(2, counters)
        {
            return Verdict::Found(rate, None);
        }
        if combinations > COMBINATIONS {
            match self.pivoted(false, counters) {
                Some(Pivoted::Guess(pieces)) => {
                    let corrected = self.corrected(pieces.clone(), counters);
                    if let Some(rate) = corrected.or_else(|| self.line_searched(&pieces, counters)) {
                        return Verdict::Found(rate, None);
                    }
                }
                Some(Pivoted::Ray(rate)) if self.proves(counters) => return Verdict::Found(rate, None),
                _ => {}
            }
            let stuck = vec![Piece::Stick; self.points.len()];
            if let Some(rate) = self.line_searched(&stuck, counters) {
                return Verdict::Found(rate, None);
            }
            if let Some(rate) = self.by_homotopy(STARTS, counters) {
                return Verdict::Found(rate, None);
            }
            if let Some(rate) = self.turned_from_associated(counters) {
                return Verdict::Found(rate, None);
            }
            if let Some(verdict) = self.searched(counters) {
                return verdict;
            }
            return Verdict::Undecided(combinations);
        }
        let all = self.enumerated(counters);
        let rising = all.iter().filter(|r| self.leads_on(r)).count();
        let better = |a: &&Rate, b: &&Rate| {
            a.factor.total_cmp(&b.factor).then_with(|| self.power(&a.gaps).total_cmp(&self.power(&b.gaps)))
        };
        let best = all.iter().filter(|r| r.factor >= 0.0).max_by(better);
        if let Some(rate) = best {
            return Verdict::Found(rate.clone(), Some(rising.saturating_sub(1)));
        }
        match all.iter().find(|rate| self.goes_on(rate)) {
            Some(rate) => Verdict::Falling(rate.clone()),
            None => Verdict::Nothing,
        }
    }
}

/// Shares (γ_i, γ_j) of a gap rate at a corner: ġ = −γ_i d_i − γ_j d_j.
pub fn corner(a: [f64; 2], b: [f64; 2], gap: [f64; 2]) -> [f64; 2] {
    let determinant = a[0] * b[1] - a[1] * b[0];
    [-(gap[0] * b[1] - gap[1] * b[0]) / determinant, -(a[0] * gap[1] - a[1] * gap[0]) / determinant]
}
