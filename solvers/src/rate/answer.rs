//! The answer to a rate problem: the rate that continues a path, a proof that no rate does, or undecided.
//!
//! The order of the search is fixed, and one rule ([`choice`](super::choice)) chooses among several rates:
//!
//! 1. rates in the cells next to the arrival ([`neighbours`](super::neighbours));
//! 2. on a path that does not fall, if none of them rises, all rates with λ̇ > 0. If there is one, it continues the
//!    path, since the structure is in equilibrium under a growing load. A limit point needs a proof that no such rate exists;
//! 3. if none rises, all rates with λ̇ = 0 on which the load does work; if neither such a rate nor a neighbour continues, all
//!    with λ̇ < 0. A neighbour with λ̇ = 0 on which the load does negative work continues the path if a point of the event
//!    enters a new mode: other loads drive it.
//!
//! Rates that a structure with imperfections does not follow ([`Arrival::is_followed_by`]) come last: an event can be a
//! bifurcation.
//!
//! Pivoting comes first in step 2. For associated flow without softening (AᵀSA positive semidefinite) it ends with a rate or
//! with the proof that none rises. Otherwise steps 2 and 3 are complete searches ([`tree`](super::tree)) within a budget. If
//! there are more combinations next to the arrival than the budget allows, the rate that pivoting finds is followed.

use super::arrival::Arrival;
use super::choice::choose;
use super::counts::{Algorithm, RateCounts};
use super::lcp::pivoted_rate;
use super::neighbours::{add, neighbours};
use super::order::Ordered;
use super::problem::{Rate, RateProblem};
use super::proof::NoRate;
use super::tree::{Searched, search_some};

/// Leaves of a search for mechanisms after which it ends if it has found one.
const ENOUGH: usize = 256;

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
        rates: Vec::new(),
        unfollowed: Vec::new(),
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

/// Returns the only rate in the cells next to the arrival that continues the path, if it needs neither a proof nor a
/// choice; it rises if the path does not fall.
pub fn only_neighbour(problem: &RateProblem, arrival: &Arrival, budget: &Budget, trials: &mut u64) -> Neighbour {
    let (rates, complete) = neighbours(problem, arrival, budget.combinations, trials);
    let goes_on = |rate: &Rate| {
        let moves_on = rate.factor > 0.0 || arrival.factor < 0.0 && (rate.factor < 0.0 || problem.leads_on(rate));
        moves_on && arrival.continues(problem, rate) && arrival.is_followed_by(problem, rate)
    };
    let mut rates = rates.into_iter().filter(goes_on);
    match (rates.next(), rates.next()) {
        (None, _) => Neighbour::None,
        (Some(rate), None) if complete && problem.is_isolated(&rate) => Neighbour::Only(rate),
        _ => Neighbour::Several,
    }
}

/// Rates in the cells next to an arrival.
#[derive(Debug, Clone)]
pub enum Neighbour {
    /// No rate rises.
    None,
    /// One rate continues the path.
    Only(Rate),
    /// The rule must choose.
    Several,
}

/// The state of the search.
struct Inquiry<'a> {
    problem: &'a RateProblem<'a>,
    arrival: &'a Arrival,
    budget: &'a Budget,
    counts: &'a mut RateCounts,
    /// Rates that continue the path.
    rates: Vec<Rate>,
    /// Rates that continue the path, but that a structure with imperfections does not follow.
    unfollowed: Vec<Rate>,
    /// The first reason why a search was not complete.
    why_open: Option<String>,
}

impl Inquiry<'_> {
    fn answer(&mut self) -> RateAnswer {
        let falls = self.arrival.factor < 0.0;
        let trials = &mut self.counts.trials;
        let (rates, complete) = neighbours(self.problem, self.arrival, self.budget.combinations, trials);
        self.keep(rates);
        // If there are too many combinations next to the arrival, there are too many for a complete search.
        if self.leads_on(|rate| rate.factor > 0.0 || (falls && complete)) {
            return self.chosen(Algorithm::Neighbours, None);
        }
        let (none_rises, by) = self.rising(complete);
        if self.leads_on(|rate| rate.factor >= 0.0 || (falls && complete)) {
            return self.chosen(by, none_rises);
        }
        let standing = self.searched(0.0);
        if self.leads_on(|rate| rate.factor >= 0.0 || complete) {
            return self.chosen(Algorithm::Tree, none_rises);
        }
        let falling = self.searched(-1.0);
        if self.rates.is_empty() {
            self.rates = std::mem::take(&mut self.unfollowed);
        }
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

    /// Adds those rates that continue the path. With λ̇ = 0 the load does work, or a point of the event enters a new mode.
    fn keep(&mut self, rates: Vec<Rate>) {
        for rate in rates {
            let enters = || self.problem.load_resists(&rate) && self.arrival.enters(self.problem, &rate);
            let moves_on = rate.factor != 0.0 || self.problem.leads_on(&rate) || enters();
            if moves_on && self.arrival.continues(self.problem, &rate) {
                let followed = self.arrival.is_followed_by(self.problem, &rate);
                add(if followed { &mut self.rates } else { &mut self.unfollowed }, rate);
            }
        }
    }

    /// Searches for rates with λ rising; returns a proof if no such rate exists. With `few` combinations the search is complete,
    /// since the rate that another algorithm finds may not be the only one. Otherwise the first rate is kept.
    fn rising(&mut self, few: bool) -> (Option<NoRate>, Algorithm) {
        let trials = &mut self.counts.trials;
        let (rate, proof) = pivoted_rate(self.problem, trials).unzip();
        let (rises, proof) = (rate.as_ref().is_some_and(|rate| rate.factor > 0.0), proof.flatten());
        self.keep(rate.into_iter().collect());
        if proof.is_some() || (rises && !few) {
            return (proof, Algorithm::Pivoting);
        }
        (self.searched(1.0), Algorithm::Tree)
    }

    /// A complete search in one sense of λ; its proof if no rate continues. At a constant load it ends early if it has
    /// found a rate: forces rest in a mechanism, so that all cells of points that do not move contain it.
    fn searched(&mut self, factor: f64) -> Option<NoRate> {
        let enough = if factor == 0.0 { ENOUGH } else { usize::MAX };
        let limits = (self.budget.leaves, enough);
        let Searched { rates, proof, open } = search_some(self.problem, factor, limits, &mut self.counts.trials);
        let proves = factor < 0.0 || rates.is_empty();
        self.keep(rates);
        self.why_open = self.why_open.take().or(open);
        proof.filter(|_| proves && !self.rates.iter().any(|rate| rate.factor == factor))
    }

    /// The rate that the rule chooses. On a path that does not fall, rates with λ rising come first, then those at a
    /// constant load.
    fn chosen(&mut self, by: Algorithm, none_rises: Option<NoRate>) -> RateAnswer {
        let mut found = std::mem::take(&mut self.rates);
        if self.arrival.factor >= 0.0 {
            let most = found.iter().map(|rate| rate.factor).fold(-1.0, f64::max);
            found.retain(|rate| rate.factor == most);
        }
        let (isolated, mixed): (Vec<Rate>, Vec<Rate>) =
            found.into_iter().partition(|rate| self.problem.is_isolated(rate));
        let rates = if isolated.is_empty() { mixed } else { isolated };
        *self.counts.decided.entry(by).or_default() += 1;
        let continuation = match choose(self.problem, self.arrival, rates) {
            Some((rate, twins)) => Continuation::Goes { rate, twins },
            None => Continuation::Open("no rate".into()),
        };
        RateAnswer { continuation, none_rises }
    }
}
