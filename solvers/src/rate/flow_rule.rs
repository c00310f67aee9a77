//! Flow-rule homotopy: associated flow makes the rate problem monotone; from its solution the flow is turned step by
//! step into the laws' own.

use super::active_set::active_set;
use super::lcp::{Pivoted, pivoting};
use super::problem::{Rate, RateProblem};
use crate::contact::active_point::ActivePoint;
use crate::contact::facet::with_flow_between;
use voussoir_core::law::Facet;

/// Shares of the laws' own flow.
const SHARES: [f64; 7] = [0.0, 0.25, 0.5, 0.7, 0.85, 0.95, 1.0];

/// A rate with λ̇ = 1.
pub fn flow_rule_homotopy(problem: &RateProblem, trials: &mut u64) -> Option<Rate> {
    let Some(Pivoted::Guess(mut modes)) = pivoting(problem, true, trials) else { return None };
    for share in SHARES {
        let facets: Vec<Vec<Facet>> = problem.points.iter().map(|p| with_flow_between(p.facets, share)).collect();
        let points = problem.points.iter().zip(&facets).map(|(p, facets)| ActivePoint { facets, ..p.clone() });
        let (s, load_rate) = (problem.s.clone(), problem.load_rate.clone());
        let turned = RateProblem { points: points.collect(), s, load_rate, from_nothing: false };
        match active_set(&turned, modes.clone(), trials) {
            Some(rate) if share == 1.0 => return Some(rate),
            Some(rate) => modes = rate.modes,
            None => {}
        }
    }
    None
}
