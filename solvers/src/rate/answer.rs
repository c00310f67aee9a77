//! The answer to a rate problem: the rate along which a path goes on, or a proof that none does, or open.
//!
//! The order of the search is fixed, and one rule ([`choice`](super::choice)) chooses among several rates:
//!
//! 1. rates in the cells next to the arrival ([`neighbours`](super::neighbours));
//! 2. on a path that does not fall, if none of them rises, all rates with λ̇ > 0. If there is one, the path goes on with
//!    it, since the structure is in equilibrium under a growing load. A limit point needs a proof that no such rate exists;
//! 3. if no neighbour continues, all rates with λ̇ = 0 on which the load does work, and all with λ̇ < 0.
//!
//! For associated flow without softening (AᵀSA positive semidefinite) step 2 is a monotone complementarity problem, which
//! pivoting always solves. Otherwise steps 2 and 3 are complete searches ([`tree`](super::tree)) within a budget.

use super::arrival::Arrival;
use super::choice::choose;
use super::lcp::{monotone_rate, rate_lcp};
use super::neighbours::{add, neighbours};
use super::order::Ordered;
use super::problem::{Rate, RateProblem};
use super::proof::NoRate;
use super::solve::{Algorithm, RateCounts};
use super::tree::{Searched, search};
use nalgebra::DMatrix;

/// Asymmetry and negative eigenvalue of AᵀSA with a unit diagonal up to which the problem is monotone.
const MONOTONE: f64 = 1e-9;

/// Limits of the search.
#[derive(Debug, Clone, Copy)]
pub struct Budget {
    /// Combinations of modes of the points of an event.
    pub combinations: usize,
    /// Leaves of the tree of a complete search.
    pub leaves: usize,
}

impl Default for Budget {
    fn default() -> Self {
        Budget { combinations: 4096, leaves: 10_000 }
    }
}

/// The continuation of the path after the event.
#[derive(Debug, Clone)]
pub enum Continuation {
    /// With a rate, which satisfies all inequalities.
    Goes {
        /// The chosen rate.
        rate: Rate,
        /// Other rates that the rule does not tell from it.
        twins: Vec<Rate>,
    },
    /// No rate continues the path. One proof for each sense of λ: 1, 0 and −1.
    NoneContinues([NoRate; 3]),
    /// Not decided, and the reason.
    Open(String),
}

/// The answer to a rate problem.
#[derive(Debug, Clone)]
pub struct RateAnswer {
    /// The continuation of the path.
    pub continuation: Continuation,
    /// A proof that no rate has λ̇ > 0, if one was sought and found.
    pub none_rises: Option<NoRate>,
}

/// Answers a rate problem at the end of a piece of a path.
pub fn answer(problem: &RateProblem, arrival: &Arrival, budget: &Budget, counts: &mut RateCounts) -> RateAnswer {
    let ordered = Ordered::new(problem, arrival);
    let mut inquiry = Inquiry {
        problem: &ordered.problem,
        arrival: &ordered.arrival,
        budget,
        counts,
        monotone: is_monotone(&ordered.problem),
        rates: Vec::new(),
        why_open: None,
    };
    let found = inquiry.answer();
    let proof = |proof: NoRate| proof.renumbered(&ordered.original);
    let continuation = match found.continuation {
        Continuation::Goes { rate, twins } => Continuation::Goes {
            rate: ordered.restored(rate),
            twins: twins.into_iter().map(|rate| ordered.restored(rate)).collect(),
        },
        Continuation::NoneContinues(proofs) => Continuation::NoneContinues(proofs.map(proof)),
        open => open,
    };
    RateAnswer { continuation, none_rises: found.none_rises.map(proof) }
}

/// The state of the search.
struct Inquiry<'a> {
    problem: &'a RateProblem<'a>,
    arrival: &'a Arrival,
    budget: &'a Budget,
    counts: &'a mut RateCounts,
    /// True for associated flow without softening.
    monotone: bool,
    /// Rates that continue the path.
    rates: Vec<Rate>,
    /// The first reason why a search was not complete.
    why_open: Option<String>,
}

impl Inquiry<'_> {
    fn answer(&mut self) -> RateAnswer {
        let falls = self.arrival.factor < 0.0;
        // The forces of a monotone problem are unique: one combination is enough.
        let most = if self.monotone { 0 } else { self.budget.combinations };
        let (rates, complete) = neighbours(self.problem, self.arrival, most, &mut self.counts.trials);
        self.keep(rates);
        if (complete || self.monotone) && self.leads_on(|rate| falls || rate.factor > 0.0) {
            return self.chosen(Algorithm::Neighbours, None);
        }
        let (none_rises, by) = self.rising();
        if self.leads_on(|rate| complete || rate.factor >= 0.0) {
            return self.chosen(by, none_rises);
        }
        let standing = self.searched(0.0);
        let falling = self.searched(-1.0);
        if !self.rates.is_empty() {
            return self.chosen(Algorithm::Tree, none_rises);
        }
        let continuation = match (none_rises.clone(), standing, falling, self.why_open.take()) {
            (Some(rising), Some(standing), Some(falling), None) => {
                *self.counts.decided.entry(Algorithm::Tree).or_default() += 1;
                Continuation::NoneContinues([rising, standing, falling])
            }
            (.., why) => Continuation::Open(why.unwrap_or_else(|| "a search is not complete".into())),
        };
        RateAnswer { continuation, none_rises }
    }

    /// True if a rate that its modes determine is of a kind.
    fn leads_on(&self, kind: impl Fn(&Rate) -> bool) -> bool {
        self.rates.iter().any(|rate| kind(rate) && self.problem.is_isolated(rate))
    }

    /// Adds those rates that continue the path.
    fn keep(&mut self, rates: Vec<Rate>) {
        for rate in rates {
            let moves_on = rate.factor != 0.0 || self.problem.leads_on(&rate);
            if moves_on && self.arrival.continues(self.problem, &rate) {
                add(&mut self.rates, rate);
            }
        }
    }

    /// Searches all rates with λ rising; returns a proof if no such rate exists.
    fn rising(&mut self) -> (Option<NoRate>, Algorithm) {
        if self.monotone {
            let rate = monotone_rate(self.problem, &mut self.counts.trials);
            let rises = rate.as_ref().is_some_and(|rate| rate.factor > 0.0);
            self.keep(rate.into_iter().collect());
            if rises {
                return (None, Algorithm::Pivoting);
            }
        }
        (self.searched(1.0), Algorithm::Tree)
    }

    /// A complete search in one sense of λ; its proof if no rate continues.
    fn searched(&mut self, factor: f64) -> Option<NoRate> {
        let Searched { rates, proof, open } = search(self.problem, factor, self.budget.leaves, &mut self.counts.trials);
        let proves = factor < 0.0 || rates.is_empty();
        self.keep(rates);
        self.why_open = self.why_open.take().or(open);
        proof.filter(|_| proves && !self.rates.iter().any(|rate| rate.factor == factor))
    }

    /// The rate that the rule chooses. On a path that does not fall, rates with λ rising come first, then those at a
    /// constant load.
    fn chosen(&mut self, by: Algorithm, none_rises: Option<NoRate>) -> RateAnswer {
        let found = std::mem::take(&mut self.rates);
        let (isolated, mixed): (Vec<Rate>, Vec<Rate>) =
            found.into_iter().partition(|rate| self.problem.is_isolated(rate));
        let mut rates = if isolated.is_empty() { mixed } else { isolated };
        if self.arrival.factor >= 0.0 {
            let most = rates.iter().map(|rate| rate.factor).fold(-1.0, f64::max);
            rates.retain(|rate| rate.factor == most);
        }
        *self.counts.decided.entry(by).or_default() += 1;
        let continuation = match choose(self.problem, self.arrival, rates) {
            Some((rate, twins)) => Continuation::Goes { rate, twins },
            None => Continuation::Open("no rate".into()),
        };
        RateAnswer { continuation, none_rises }
    }
}

/// True for associated flow without softening: AᵀSA is symmetric and positive semidefinite.
fn is_monotone(problem: &RateProblem) -> bool {
    let semidefinite = |m: &DMatrix<f64>| {
        let symmetric = m.is_empty() || (m - m.transpose()).amax() <= MONOTONE;
        symmetric && (m + DMatrix::identity(m.nrows(), m.ncols()) * MONOTONE).cholesky().is_some()
    };
    problem.is_associated() && rate_lcp(problem, true).is_some_and(|lcp| semidefinite(&lcp.lcp.matrix))
}
