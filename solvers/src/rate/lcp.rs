//! The rate problem as a linear complementarity problem over all facets without slack, with a multiplier each.
//!
//! ```text
//! ġ = −Σ z_i d_i,   w_i = −a_i·ṙ = q_i λ̇ + Σ M_ij z_j,   0 ≤ z_i ⟂ w_i ≥ 0,   M_ij = a_i·S d_j
//! ```
//!
//! Klarbring (1990), Ing.-Arch. 60.

use super::problem::{Rate, RateProblem};
use crate::contact::mode::ContactMode;
use crate::optimise::lcp::{Lcp, LemkeResult, lemke};
use nalgebra::{DMatrix, DVector};
use voussoir_core::law::{Facet, FacetMode};

/// Relative tolerance of what pivoting finds.
pub const PIVOTING: f64 = 1e-7;
/// Facets above which it is not pivoted.
const MOST: usize = 900;

/// What pivoting found.
pub enum Pivoted {
    /// Modes close to a solution.
    Guess(Vec<ContactMode>),
    /// A mechanism.
    Ray(Rate),
}

/// The complementarity problem, each facet in its own scale.
pub struct RateLcp {
    /// (point, facet).
    pub facets: Vec<(usize, usize)>,
    /// Scale of each.
    pub unit: Vec<f64>,
    /// M and q.
    pub lcp: Lcp,
}

fn facet<'a>(problem: &RateProblem<'a>, (k, f): (usize, usize)) -> &'a Facet {
    &problem.points[k].facets[f]
}

fn flow(problem: &RateProblem, at: (usize, usize), associated: bool) -> [f64; 2] {
    let facet = facet(problem, at);
    if associated { facet.normal } else { facet.flow }
}

/// With the laws' own flow or an associated one. `None` where points are open with a strength: their
/// multipliers have any sign.
pub fn rate_lcp(problem: &RateProblem, associated: bool) -> Option<RateLcp> {
    if problem.points.iter().any(|p| p.open.is_some()) {
        return None;
    }
    let facets: Vec<(usize, usize)> =
        problem.points.iter().enumerate().flat_map(|(k, p)| p.active.iter().map(move |f| (k, *f))).collect();
    let n = facets.len();
    let s = &problem.s;
    let m = DMatrix::from_fn(n, n, |i, j| {
        let (k, l) = (facets[i].0, facets[j].0);
        let (a, d) = (facet(problem, facets[i]).normal, flow(problem, facets[j], associated));
        a[0] * (s[(2 * k, 2 * l)] * d[0] + s[(2 * k, 2 * l + 1)] * d[1])
            + a[1] * (s[(2 * k + 1, 2 * l)] * d[0] + s[(2 * k + 1, 2 * l + 1)] * d[1])
    });
    let largest = m.diagonal().amax();
    let unit: Vec<f64> = m.diagonal().iter().map(|d| d.abs().max(1e-12 * largest).sqrt()).collect();
    let matrix = DMatrix::from_fn(n, n, |i, j| m[(i, j)] / (unit[i] * unit[j]));
    let constant = DVector::from_fn(n, |i, _| {
        let (k, a) = (facets[i].0, facet(problem, facets[i]).normal);
        -(a[0] * problem.load_rate[2 * k] + a[1] * problem.load_rate[2 * k + 1]) / unit[i]
    });
    Some(RateLcp { facets, unit, lcp: Lcp { matrix, constant } })
}

/// ġ of multipliers.
fn gaps_of(problem: &RateProblem, lcp: &RateLcp, z: &[f64], associated: bool) -> Vec<[f64; 2]> {
    let mut gaps = vec![[0.0; 2]; problem.points.len()];
    for ((at, unit), z) in lcp.facets.iter().zip(&lcp.unit).zip(z) {
        let d = flow(problem, *at, associated);
        (0..2).for_each(|i| gaps[at.0][i] -= z / unit * d[i]);
    }
    gaps
}

/// Lemke's pivoting over all active facets, with their own flow or an associated one: modes to correct, or the ray
/// of a mechanism.
pub fn pivoting(problem: &RateProblem, associated: bool, trials: &mut u64) -> Option<Pivoted> {
    let rate = rate_lcp(problem, associated).filter(|rate| rate.facets.len() <= MOST)?;
    let Lcp { matrix: m, constant: q } = &rate.lcp;
    let (z, ray) = match lemke(&rate.lcp, trials) {
        LemkeResult::Solution(z) => (z, false),
        LemkeResult::Ray(z) => (z, true),
        LemkeResult::Unfinished => return None,
    };
    let z_size = z.iter().copied().fold(1e-300, f64::max);
    if !ray {
        let w = q + m * DVector::from_vec(z.clone());
        let w_size = w.amax().max(1e-300);
        let flows = |i: usize| z[i] / z_size > (w[i] / w_size).max(1e-12);
        return Some(Pivoted::Guess(modes_of(problem, &rate.facets, flows)));
    }
    let mut gaps = gaps_of(problem, &rate, &z, associated);
    let w = m * DVector::from_vec(z.clone());
    let moves = gaps.iter().flatten().fold(0.0, |a: f64, g| a.max(g.abs()));
    let largest = rate.unit.iter().copied().fold(0.0, f64::max);
    let still = w.amax() <= PIVOTING * z_size && z.iter().all(|z| *z >= -PIVOTING * z_size);
    let rises = !associated && q.dot(&DVector::from_vec(z.clone())) > 0.0;
    if !still || moves * largest <= PIVOTING * z_size || rises {
        return None;
    }
    let modes = modes_of(problem, &rate.facets, |i| z[i] > 1e-8 * z_size);
    // What does not flow does not move, not even by rounding.
    for (gap, _) in gaps.iter_mut().zip(&modes).filter(|(_, mode)| **mode == ContactMode::Stick) {
        *gap = [0.0; 2];
    }
    Some(Pivoted::Ray(Rate { factor: 0.0, modes, gaps }))
}

/// Whether a mechanism means that the load does not grow: from nothing only where slip with
/// associated flow does not carry it either.
pub fn mechanism_proves(problem: &RateProblem, trials: &mut u64) -> bool {
    !problem.from_nothing || problem.is_associated() || matches!(pivoting(problem, true, trials), Some(Pivoted::Ray(_)))
}

/// Modes and ġ of multipliers that solve the problem.
pub fn solution(problem: &RateProblem, lcp: &RateLcp, z: &[f64]) -> (Vec<ContactMode>, Vec<[f64; 2]>) {
    let most = z.iter().copied().fold(1e-300, f64::max);
    let w = &lcp.lcp.matrix * DVector::from_column_slice(z);
    let modes = modes_of(problem, &lcp.facets, |i| z[i] > 1e-9 * most && z[i] > 1e-9 * w[i]);
    (modes, gaps_of(problem, lcp, z, false))
}

/// Modes from which facets (point, index) flow.
fn modes_of(problem: &RateProblem, facets: &[(usize, usize)], flows: impl Fn(usize) -> bool) -> Vec<ContactMode> {
    let mut modes = vec![ContactMode::Stick; problem.points.len()];
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
