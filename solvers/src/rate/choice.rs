//! The one rule that chooses if several rates continue.
//!
//! 1. The present modes, if they continue and are stable under control.
//! 2. Otherwise other modes come before the present ones. A rate with λ rising that is unstable under control is left out
//!    if a stable one rises, too, since motions at a constant load grow on it. Then the greatest dissipation per unit step
//!    decides.
//! 3. If none dissipates, the rate with the least second-order energy per unit step.
//!
//! Rates that their modes do not determine are left out if others are left: if two parts of a structure may slide
//! independently, one of them slides first. Rates within a relative 1e-6 are twins. A unit step has a length of one
//! ([`RateProblem::step`](super::problem::RateProblem::step)).
//!
//! *Stable under control*: with the modes m of a rate, flows D and rows A, the matrix AᵀSD has no negative real
//! eigenvalue (stable under load); or it has one, λ falls and the load point moves on (a softening branch that is
//! followed with the load point held). A rate that needs more than that is on a branch beyond a bifurcation.

use super::arrival::Arrival;
use super::neighbours::forward_modes;
use super::problem::{Rate, RateProblem};
use crate::contact::mode::ContactMode;
use crate::settings::SETTINGS;

/// The chosen rate and its twins. `None` if there is no rate.
pub fn choose(problem: &RateProblem, arrival: &Arrival, rates: Vec<Rate>) -> Option<(Rate, Vec<Rate>)> {
    if rates.len() < 2 {
        return rates.into_iter().next().map(|rate| (rate, Vec::new()));
    }
    let present = [arrival.modes(), forward_modes(problem, arrival)];
    let goes_on =
        |modes: &Vec<ContactMode>| rates.iter().find(|rate| rate.modes == *modes && problem.stable_under_control(rate));
    if let Some(rate) = present.iter().find_map(goes_on) {
        return Some((rate.clone(), Vec::new()));
    }
    // The present modes are unstable: another rate continues, if there is one.
    let (own, others): (Vec<Rate>, Vec<Rate>) = rates.into_iter().partition(|rate| present.contains(&rate.modes));
    let rates = if others.is_empty() { own } else { others };
    let lasts = |rate: &&Rate| rate.factor <= 0.0 || problem.stable_under_control(rate);
    let lasting: Vec<Rate> = rates.iter().filter(lasts).cloned().collect();
    let rates = if lasting.iter().any(|rate| rate.factor > 0.0) { lasting } else { rates };
    let dissipation: Vec<f64> = rates.iter().map(|rate| dissipation_share(problem, arrival, rate)).collect();
    let most = dissipation.iter().copied().fold(0.0, f64::max);
    let merit: Vec<f64> = if most > SETTINGS.admissible * force_size(problem, arrival) {
        dissipation
    } else {
        rates.iter().map(|rate| -problem.second_order_energy(rate)).collect()
    };
    let best = merit.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let size = merit.iter().fold(0.0, |a: f64, m| a.max(m.abs()));
    let mut tied =
        rates.into_iter().zip(merit).filter(|(_, m)| best - m <= SETTINGS.distinct() * size).map(|(rate, _)| rate);
    tied.next().map(|rate| (rate, tied.collect()))
}

/// Dissipation per unit step.
fn dissipation_share(problem: &RateProblem, arrival: &Arrival, rate: &Rate) -> f64 {
    arrival.dissipation(rate) / problem.step(rate).max(1e-300)
}

/// The greatest contact force in the units of the points.
fn force_size(problem: &RateProblem, arrival: &Arrival) -> f64 {
    let share = |(k, point): (usize, &super::arrival::ArrivalPoint)| {
        point.force[0].hypot(point.force[1]) / problem.points[k].stiffness.sqrt()
    };
    arrival.points.iter().enumerate().map(share).fold(0.0, f64::max)
}
