//! The rate problem as a linear complementarity problem over all facets without slack, with a multiplier each.
//!
//! ```text
//! ġ = −Σ z_i d_i,   w_i = −a_i·ṙ = q_i λ̇ + Σ M_ij z_j,   0 ≤ z_i ⟂ w_i ≥ 0,   M_ij = a_i·S d_j
//! ```
//!
//! Klarbring (1990), Ing.-Arch. 60.

use super::problem::{Rate, RateProblem};
use super::proof::{ModeTree, NoRate};
use crate::contact::active_point::ActivePoint;
use crate::contact::mode::ContactMode;
use crate::optimise::lcp::{Lcp, LemkeResult, lemke};
use crate::settings::SETTINGS;
use nalgebra::{DMatrix, DVector};
use voussoir_core::law::{Facet, FacetMode};

/// Facets up to which a problem is pivoted: its matrix is dense, and it takes about as many pivots as it has facets.
const MOST: usize = 4000;

/// The complementarity problem, each facet in its own scale. Multipliers of opening facets that are open have any
/// sign: they are eliminated.
pub struct RateLcp {
    /// (point, facet) of each pair.
    pub facets: Vec<(usize, usize)>,
    /// Scale of each.
    pub unit: Vec<f64>,
    /// M and q.
    pub lcp: Lcp,
    free: Free,
}

/// Multipliers that have been eliminated.
struct Free {
    facets: Vec<(usize, usize)>,
    /// By the pairs' z and, last, by λ̇.
    multipliers: DMatrix<f64>,
    /// Multipliers of their rows by the multipliers of the pairs' rows.
    rows: DMatrix<f64>,
}

fn facet<'a>(problem: &RateProblem<'a>, (k, f): (usize, usize)) -> &'a Facet {
    &problem.points[k].facets[f]
}

impl RateLcp {
    /// Returns (point, facet) of all rows; rows of eliminated multipliers are last.
    pub fn all_rows(&self) -> Vec<(usize, usize)> {
        [&self.facets[..], &self.free.facets].concat()
    }

    /// Multipliers of the eliminated rows, so that the sum with multipliers y of the pairs' rows does not contain the
    /// eliminated variables.
    pub fn eliminated_rows(&self, y: &[f64]) -> Vec<f64> {
        (&self.free.rows * DVector::from_column_slice(y)).iter().copied().collect()
    }

    /// The proof that no rate has λ̇ > 0 by the ray z of a mechanism on which the load does work. If M is
    /// symmetric, with y = z the sum y·w − (yᵀM)·z = λ̇ y·q has no negative coefficient and a negative right-hand side.
    fn excluded_by(&self, z: &[f64]) -> Option<NoRate> {
        let y = DVector::from_iterator(z.len(), z.iter().map(|z| z.max(0.0)));
        let right = y.dot(&self.lcp.constant) / self.lcp.constant.amax();
        let against: f64 = self.lcp.matrix.tr_mul(&y).iter().map(|c| c.max(0.0)).sum();
        let mut own: Vec<f64> = y.iter().zip(&self.unit).map(|(y, unit)| y / unit).collect();
        own.extend(self.eliminated_rows(&own));
        let proof = || NoRate { factor: 1.0, rows: self.all_rows(), tree: ModeTree::Contradiction(own) };
        (right < 0.0 && SETTINGS.largest_inverse() * against < -0.5 * right).then(proof)
    }
}

/// Creates the problem. `None` if a point that is open with a strength is not held by anything.
pub fn rate_lcp(problem: &RateProblem) -> Option<RateLcp> {
    let points = || problem.points.iter().enumerate();
    let pairs = |(k, p): (usize, &ActivePoint)| -> Vec<(usize, usize)> {
        p.active.iter().filter(|f| Some(**f) != p.open).map(|f| (k, *f)).collect()
    };
    let facets: Vec<(usize, usize)> = points().flat_map(pairs).collect();
    let opened: Vec<(usize, usize)> = points().filter_map(|(k, p)| p.open.map(|f| (k, f))).collect();
    let s = &problem.s;
    let entry = |i: (usize, usize), j: (usize, usize)| {
        let (k, l) = (i.0, j.0);
        let (a, d) = (facet(problem, i).normal, facet(problem, j).flow);
        a[0] * (s[(2 * k, 2 * l)] * d[0] + s[(2 * k, 2 * l + 1)] * d[1])
            + a[1] * (s[(2 * k + 1, 2 * l)] * d[0] + s[(2 * k + 1, 2 * l + 1)] * d[1])
    };
    let by_load = |(k, f): (usize, usize)| {
        let a = facet(problem, (k, f)).normal;
        -(a[0] * problem.load_rate[2 * k] + a[1] * problem.load_rate[2 * k + 1])
    };
    let (n, o) = (facets.len(), opened.len());
    let mut m = DMatrix::from_fn(n, n, |i, j| entry(facets[i], facets[j]));
    let mut q = DVector::from_fn(n, |i, _| by_load(facets[i]));
    let (mut multipliers, mut rows) = (DMatrix::zeros(0, n + 1), DMatrix::zeros(0, n));
    if o > 0 {
        let own = DMatrix::from_fn(o, o, |i, j| entry(opened[i], opened[j]));
        let by = |i: usize, j: usize| if j < n { entry(opened[i], facets[j]) } else { by_load(opened[i]) };
        rows = -own.transpose().lu().solve(&DMatrix::from_fn(o, n, |i, j| entry(facets[j], opened[i])))?;
        multipliers = -own.lu().solve(&DMatrix::from_fn(o, n + 1, by))?;
        let onto = DMatrix::from_fn(n, o, |i, j| entry(facets[i], opened[j]));
        m += &onto * multipliers.columns(0, n);
        q += &onto * multipliers.column(n);
    }
    let largest = m.diagonal().amax();
    // A diagonal entry within rounding of zero cannot be a unit.
    let common = if largest > 0.0 { largest } else { 1.0 };
    let scale = |d: f64| if d > SETTINGS.inequality() * largest { d.sqrt() } else { common.sqrt() };
    let unit: Vec<f64> = m.diagonal().iter().map(|d| scale(d.abs())).collect();
    let matrix = DMatrix::from_fn(n, n, |i, j| m[(i, j)] / (unit[i] * unit[j]));
    let constant = DVector::from_fn(n, |i, _| q[i] / unit[i]);
    Some(RateLcp { facets, unit, lcp: Lcp { matrix, constant }, free: Free { facets: opened, multipliers, rows } })
}

/// Returns ġ of multipliers with a λ̇.
pub fn gaps_of(problem: &RateProblem, lcp: &RateLcp, z: &[f64], factor: f64) -> Vec<[f64; 2]> {
    let mut gaps = vec![[0.0; 2]; problem.points.len()];
    let mut add = |at: (usize, usize), multiplier: f64| {
        let d = facet(problem, at).flow;
        (0..2).for_each(|i| gaps[at.0][i] -= multiplier * d[i]);
    };
    let own: Vec<f64> = z.iter().zip(&lcp.unit).map(|(z, unit)| z / unit).chain([factor]).collect();
    lcp.facets.iter().zip(&own).for_each(|(at, multiplier)| add(*at, *multiplier));
    let free = &lcp.free.multipliers * DVector::from_vec(own);
    lcp.free.facets.iter().zip(free.iter()).for_each(|(at, multiplier)| add(*at, *multiplier));
    gaps
}

/// A rate by Lemke's pivoting: with λ̇ = 1, or the ray of a mechanism, with the proof that no rate rises if it is one. For a
/// monotone problem pivoting ends with one of both. `None` if it finds no rate that satisfies the laws.
pub fn pivoted_rate(problem: &RateProblem, trials: &mut u64) -> Option<(Rate, Option<NoRate>)> {
    let lcp = rate_lcp(problem).filter(|lcp| lcp.facets.len() <= MOST)?;
    let mut proof = None;
    let rate = match lemke(&lcp.lcp, trials) {
        LemkeResult::Unfinished => return None,
        LemkeResult::Solution(z) => {
            Rate { factor: 1.0, modes: modes_of_solution(problem, &lcp, &z), gaps: gaps_of(problem, &lcp, &z, 1.0) }
        }
        LemkeResult::Ray(z) => {
            let most = z.iter().copied().fold(1e-300, f64::max);
            let modes = modes_of(problem, &lcp.facets, |i| z[i] > 1e-8 * most);
            proof = lcp.excluded_by(&z);
            Rate { factor: 0.0, modes, gaps: gaps_of(problem, &lcp, &z, 0.0) }
        }
    };
    problem.admits(&rate).then_some((rate, proof))
}

/// Returns the modes of multipliers that solve the problem.
pub fn modes_of_solution(problem: &RateProblem, lcp: &RateLcp, z: &[f64]) -> Vec<ContactMode> {
    let most = z.iter().copied().fold(1e-300, f64::max);
    let w = &lcp.lcp.matrix * DVector::from_column_slice(z);
    modes_of(problem, &lcp.facets, |i| z[i] > 1e-9 * most && z[i] > 1e-9 * w[i])
}

/// Returns the modes in which the facets (point, index) flow.
fn modes_of(problem: &RateProblem, facets: &[(usize, usize)], flows: impl Fn(usize) -> bool) -> Vec<ContactMode> {
    let open = |point: &ActivePoint| point.open.map_or(ContactMode::Stick, |f| ContactMode::Facet(f as u8));
    let mut modes: Vec<ContactMode> = problem.points.iter().map(open).collect();
    for i in (0..facets.len()).filter(|i| flows(*i)) {
        let (k, f) = facets[i];
        let point = &problem.points[k];
        let opens = point.facets[f].mode == FacetMode::Opening;
        modes[k] = match modes[k] {
            ContactMode::Stick if point.apex && opens => ContactMode::Open,
            ContactMode::Stick => ContactMode::Facet(f as u8),
            _ if point.apex => ContactMode::Open,
            ContactMode::Facet(other) => ContactMode::Corner(other, f as u8),
            kept => kept,
        };
    }
    modes
}
