//! The rate problem by branching: a rate, or a proof that there is none.
//!
//! First one with λ growing is looked for, then one with λ standing still, then one with λ falling. Rates with
//! λ̇ ≥ 0 are found together by one more unknown t = λ̇ ≥ 0 and the row Σ z + t ≥ 1, which leaves out the rate that
//! is nothing (each solution can be scaled; `counted`); those with λ̇ < 0 on which a point that has just arrived
//! flows with t = −λ̇ and Σ z ≥ 1 over these points.

use super::active_set::active_set;
use super::lcp::{PIVOTING, RateLcp, gaps_of, mechanism_proves, modes_of_solution, rate_lcp};
use super::problem::{RateOutcome, RateProblem};
use crate::contact::mode::ContactMode;
use crate::optimise::branching::{LcpAnswer, solve_by_branching};
use crate::optimise::lcp::Lcp;
use nalgebra::{DMatrix, DVector};
use voussoir_core::law::FacetMode;

/// Facets above which it is not tried.
const MOST: usize = 160;
/// Linear programs of one question.
const PROGRAMS: u64 = 4000;

/// What is known of rates with growing λ.
pub enum RisingRate {
    /// There is none: a limit point.
    None,
    /// ġ with λ̇ = 1 and the modes.
    Found(Vec<[f64; 2]>, Vec<ContactMode>),
    /// Not decided, and why.
    Undecided(String),
}

/// The limit point test: whether there is a rate with λ growing, by at most so many linear programs, which are
/// counted.
pub fn rising_rate(problem: &RateProblem, most: u64, programs: &mut u64) -> RisingRate {
    let Some(lcp) = rate_lcp(problem, false) else {
        return RisingRate::Undecided("nothing holds the points that are open".into());
    };
    // Without a load on them the facets have nothing to do.
    let Lcp { matrix, constant } = &lcp.lcp;
    let size = if lcp.facets.is_empty() { 1.0 } else { constant.amax().max(1e-300) };
    let scaled = Lcp { matrix: matrix.clone(), constant: constant / size };
    let (answer, took) = solve_by_branching(&scaled, most);
    *programs += took;
    match answer {
        LcpAnswer::NoSolution => RisingRate::None,
        LcpAnswer::Undecided(why) => RisingRate::Undecided(why),
        LcpAnswer::Solution(z) => {
            let z: Vec<f64> = z.iter().map(|z| z * size).collect();
            RisingRate::Found(gaps_of(problem, &lcp, &z, 1.0, false), modes_of_solution(problem, &lcp, &z))
        }
    }
}

/// What is known of a complementarity problem; `trials` counts linear programs.
fn answer(matrix: DMatrix<f64>, constant: DVector<f64>, trials: &mut u64) -> LcpAnswer {
    let (answer, programs) = solve_by_branching(&Lcp { matrix, constant }, PROGRAMS);
    *trials += programs;
    answer
}

/// The outcome of branching. `None` where that is not decided.
pub fn branching(problem: &RateProblem, trials: &mut u64) -> Option<RateOutcome> {
    let lcp = rate_lcp(problem, false).filter(|lcp| lcp.facets.len() <= MOST)?;
    let size = lcp.lcp.constant.amax();
    if size == 0.0 {
        return None;
    }
    let q = &lcp.lcp.constant / size;
    match answer(lcp.lcp.matrix.clone(), q.clone(), trials) {
        LcpAnswer::Solution(z) => {
            let rate = active_set(problem, modes_of_solution(problem, &lcp, &z), trials);
            return rate.map(|rate| RateOutcome::Found(rate, None));
        }
        LcpAnswer::Undecided(_) => return None,
        LcpAnswer::NoSolution => {}
    }
    Some(standing_or_falling(problem, &lcp, &q, trials).unwrap_or(RateOutcome::NoneRises))
}

/// The search where no rate has λ growing, for `q` of size one.
fn standing_or_falling(
    problem: &RateProblem,
    lcp: &RateLcp,
    q: &DVector<f64>,
    trials: &mut u64,
) -> Option<RateOutcome> {
    let n = lcp.facets.len();
    // t in column n; its row and the column of the last row's partner are empty.
    let cone = |sense: f64, counted: &[f64]| {
        DMatrix::from_fn(n + 2, n + 2, |i, j| match (i < n, j < n) {
            (true, true) => lcp.lcp.matrix[(i, j)],
            (true, false) if j == n => sense * q[i],
            (false, _) if i == n + 1 && j <= n => counted[j],
            _ => 0.0,
        })
    };
    let least = DVector::from_fn(n + 2, |i, _| if i == n + 1 { -1.0 } else { 0.0 });
    for counted in counted(problem, lcp, true, |_| true) {
        match answer(cone(1.0, &counted), least.clone(), trials) {
            LcpAnswer::Solution(z) => {
                let (modes, gaps) =
                    (modes_of_solution(problem, lcp, &z[..n]), gaps_of(problem, lcp, &z[..n], 0.0, false));
                let rate = problem.mechanism_near(&modes, &gaps).filter(|_| z[n] <= PIVOTING)?;
                return mechanism_proves(problem, trials).then_some(RateOutcome::Found(rate, None));
            }
            LcpAnswer::Undecided(_) => return None,
            LcpAnswer::NoSolution => {}
        }
    }
    // Mere unloading is none: a point that has just arrived must flow.
    for counted in counted(problem, lcp, false, |k| problem.points[k].hit) {
        match answer(cone(-1.0, &counted), least.clone(), trials) {
            LcpAnswer::Solution(z) => {
                let rate = problem.exactly(modes_of_solution(problem, lcp, &z[..n]), -1.0)?;
                return problem.goes_on(&rate).then_some(RateOutcome::Falling(rate));
            }
            LcpAnswer::Undecided(_) => return None,
            LcpAnswer::NoSolution => {}
        }
    }
    Some(RateOutcome::NoRate)
}

/// Sums of multipliers (and, last, of t) at some points, one of which is positive wherever something
/// moves there. At an apex both senses of slip together are no motion: openings are counted with all
/// else, and each sense of slip in a sum of its own.
fn counted(problem: &RateProblem, lcp: &RateLcp, with_t: bool, at: impl Fn(usize) -> bool) -> Vec<Vec<f64>> {
    let n = lcp.facets.len();
    let slips = |i: usize| {
        let (k, f) = lcp.facets[i];
        problem.points[k].apex && problem.points[k].facets[f].mode == FacetMode::Sliding
    };
    let counts = |i: usize| f64::from(at(lcp.facets[i].0) && !slips(i));
    let mut sums = vec![(0..n).map(counts).chain([f64::from(with_t)]).collect::<Vec<f64>>()];
    for i in (0..n).filter(|i| at(lcp.facets[*i].0) && slips(*i)) {
        let share = |j: usize| match (j == i, j < n && lcp.facets[j].0 == lcp.facets[i].0 && slips(j)) {
            (true, _) => 1.0,
            (false, true) => -lcp.unit[i] / lcp.unit[j],
            _ => 0.0,
        };
        sums.push((0..=n).map(share).collect());
    }
    sums
}
