//! The one order in which algorithms are put to a rate problem, and who decided.
//!
//! The active set from the present modes first. Where it fails, few combinations of modes are all tried, which finds
//! mechanisms (λ̇ = 0) and falling branches (λ̇ < 0) too and proves that there is no other; many are put to pivoting,
//! a line search, piecewise linear paths and branching, which proves as well.

use super::active_set::active_set;
use super::branching::branching;
use super::enumerate::enumerate_modes;
use super::homotopy::homotopy;
use super::lcp::{Pivoted, mechanism_proves, pivoting};
use super::line_search::line_search;
use super::problem::{Rate, RateOutcome, RateProblem};
use crate::contact::mode::ContactMode;

/// Combinations that are all tried.
const COMBINATIONS: usize = 140_000;
/// Combinations up to which all are tried at once.
const FEW: usize = 3000;
/// Combinations up to which a problem is examined for other solutions by trying all.
pub const EXAMINED: usize = 64;
/// Points up to which it is examined by paths from other guesses, and those guesses.
const EXAMINED_POINTS: usize = 12;
const EXAMINATIONS: u64 = 1;
/// Guesses from which piecewise linear paths are followed: beside enumeration, and without it.
const STARTS: [u64; 2] = [2, 8];

/// Who decides a rate problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Algorithm {
    /// Primal–dual active set.
    ActiveSet,
    /// Every combination of modes.
    Enumeration,
    /// Lemke's pivoting, and the active set from it.
    Pivoting,
    /// Newton's method with a line search.
    LineSearch,
    /// Piecewise linear homotopy.
    Homotopy,
    /// Branching on the complementarity problem.
    Branching,
    /// The cells next to the arrival.
    Neighbours,
    /// The complete search over modes.
    Tree,
}

/// How often each algorithm decided, and the linear systems and programs that this took.
#[derive(Debug, Clone, Default)]
pub struct RateCounts {
    /// Linear systems, pivots, programs.
    pub trials: u64,
    /// Problems decided.
    pub decided: std::collections::BTreeMap<Algorithm, u64>,
}

impl Algorithm {
    /// Its name among the counters of an answer.
    pub fn name(self) -> &'static str {
        match self {
            Algorithm::ActiveSet => "rates_by_active_set",
            Algorithm::Enumeration => "rates_by_enumeration",
            Algorithm::Pivoting => "rates_by_pivoting",
            Algorithm::LineSearch => "rates_by_line_search",
            Algorithm::Homotopy => "rates_by_homotopy",
            Algorithm::Branching => "rates_by_branching",
            Algorithm::Neighbours => "rates_by_neighbours",
            Algorithm::Tree => "rates_by_tree",
        }
    }
}

/// Solves a rate problem. `examine` asks for the number of other solutions where it is cheap.
pub fn solve(problem: &RateProblem, examine: bool, counts: &mut RateCounts) -> RateOutcome {
    let (outcome, by) = decide(problem, examine, &mut counts.trials);
    if let Some(by) = by {
        *counts.decided.entry(by).or_default() += 1;
    }
    outcome
}

fn decide(problem: &RateProblem, examine: bool, trials: &mut u64) -> (RateOutcome, Option<Algorithm>) {
    let combinations = problem.combinations();
    let guess = problem.points.iter().map(|p| p.guess).collect();
    if let Some(rate) = active_set(problem, guess, trials) {
        let others = if examine { other_solutions(problem, &rate, combinations, trials) } else { None };
        return (RateOutcome::Found(rate, others), Some(Algorithm::ActiveSet));
    }
    if combinations > COMBINATIONS {
        return match by_large_scale(problem, trials) {
            Some((outcome, by)) => (outcome, Some(by)),
            None => (RateOutcome::Undecided(combinations), None),
        };
    }
    if combinations >= FEW
        && let Some(rate) = by_homotopy(problem, STARTS[0], trials)
    {
        return (RateOutcome::Found(rate, None), Some(Algorithm::Homotopy));
    }
    (best_of_all(problem, trials), Some(Algorithm::Enumeration))
}

/// How many other solutions with growing λ are known; `None` where that is not examined.
fn other_solutions(problem: &RateProblem, rate: &Rate, combinations: usize, trials: &mut u64) -> Option<usize> {
    if combinations <= EXAMINED {
        let all = enumerate_modes(problem, trials);
        return Some(all.iter().filter(|r| problem.leads_on(r)).count().saturating_sub(1));
    }
    (problem.points.len() <= EXAMINED_POINTS).then(|| {
        let others = (1..=EXAMINATIONS).filter_map(|number| {
            let (modes, _) = homotopy(problem, number, trials)?;
            active_set(problem, modes, trials)
        });
        let mut found = vec![rate.clone()];
        for other in others {
            if !found.iter().any(|known| known.is_same(&other, 1e-6)) {
                found.push(other);
            }
        }
        found.len() - 1
    })
}

/// The best of all solutions: the greatest λ̇ ≥ 0, of several the one on which the load does most work.
fn best_of_all(problem: &RateProblem, trials: &mut u64) -> RateOutcome {
    let all = enumerate_modes(problem, trials);
    let rising = all.iter().filter(|r| problem.leads_on(r)).count();
    let better = |a: &&Rate, b: &&Rate| {
        a.factor.total_cmp(&b.factor).then_with(|| problem.power(&a.gaps).total_cmp(&problem.power(&b.gaps)))
    };
    if let Some(rate) = all.iter().filter(|r| r.factor >= 0.0).max_by(better) {
        return RateOutcome::Found(rate.clone(), Some(rising.saturating_sub(1)));
    }
    match all.iter().find(|rate| problem.goes_on(rate)) {
        Some(rate) => RateOutcome::Falling(rate.clone()),
        None => RateOutcome::NoRate,
    }
}

/// More combinations than can be tried.
fn by_large_scale(problem: &RateProblem, trials: &mut u64) -> Option<(RateOutcome, Algorithm)> {
    let found = |rate: Rate, by: Algorithm| Some((RateOutcome::Found(rate, None), by));
    match pivoting(problem, false, trials) {
        Some(Pivoted::Guess(modes)) => {
            if let Some(rate) = active_set(problem, modes, trials) {
                return found(rate, Algorithm::Pivoting);
            }
        }
        Some(Pivoted::Ray(rate)) if mechanism_proves(problem, trials) => return found(rate, Algorithm::Pivoting),
        _ => {}
    }
    let stuck = vec![ContactMode::Stick; problem.points.len()];
    if let Some(rate) = line_search(problem, &stuck, trials) {
        return found(rate, Algorithm::LineSearch);
    }
    if let Some(rate) = by_homotopy(problem, STARTS[1], trials) {
        return found(rate, Algorithm::Homotopy);
    }
    branching(problem, trials).map(|outcome| (outcome, Algorithm::Branching))
}

/// By piecewise linear paths from several guesses: a rate, or a mechanism that proves that there is none.
fn by_homotopy(problem: &RateProblem, starts: u64, trials: &mut u64) -> Option<Rate> {
    let mut mechanism = None;
    for number in 0..starts {
        let Some((modes, gaps)) = homotopy(problem, number, trials) else { continue };
        if let Some(rate) = active_set(problem, modes.clone(), trials) {
            return Some(rate);
        }
        mechanism = mechanism.or_else(|| problem.mechanism_near(&modes, &gaps));
        // With associated flow a mechanism excludes that the load grows.
        if mechanism.is_some() && problem.is_associated() {
            break;
        }
    }
    mechanism.filter(|_| mechanism_proves(problem, trials))
}
