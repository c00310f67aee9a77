//! Rates in the cells next to the arrival: each combination of modes of the points of the event, while the other points
//! keep their modes or leave them by their inequalities.
//!
//! The solution curve of a piecewise smooth system crosses an event into an adjacent cell. Both senses of λ are tried,
//! since the curve may turn there.

use super::arrival::Arrival;
use super::problem::{Rate, RateProblem};
use crate::contact::mode::ContactMode;
use crate::settings::SETTINGS;

/// The modes in which the path continues without a choice: the modes of the arrival, with each point of the event in
/// the mode that repairs its violation there.
pub fn forward_modes(problem: &RateProblem, arrival: &Arrival) -> Vec<ContactMode> {
    let mut modes = arrival.modes();
    let hit = |k: usize| arrival.points[k].hit;
    let attempt = problem.attempt(&modes, 1.0).filter(|attempt| !attempt.singular && arrival.factor != 0.0);
    let Some(attempt) = attempt else {
        (0..modes.len()).filter(|k| hit(*k)).for_each(|k| modes[k] = problem.points[k].guess);
        return modes;
    };
    for (_, k, to) in problem.violations(&modes.clone(), &attempt, arrival.factor) {
        if hit(k) {
            modes[k] = to;
        }
    }
    modes
}

/// All rates in the cells next to the arrival, each once, and true if all combinations were tried.
pub fn neighbours(problem: &RateProblem, arrival: &Arrival, most: usize, trials: &mut u64) -> (Vec<Rate>, bool) {
    let forward = forward_modes(problem, arrival);
    let hit: Vec<usize> = (0..forward.len()).filter(|k| arrival.points[*k].hit).collect();
    let free = vec![false; forward.len()];
    let mut found = Vec::new();
    for start in [arrival.modes(), forward] {
        add_both_senses(problem, &start, &free, trials, &mut found);
    }
    let candidates: Vec<Vec<ContactMode>> = hit.iter().map(|k| problem.points[*k].candidates()).collect();
    let combinations = candidates.iter().fold(1usize, |n, own| n.saturating_mul(own.len()));
    if combinations > most {
        return (found, false);
    }
    let mut held = free;
    hit.iter().for_each(|k| held[*k] = true);
    for number in 0..combinations {
        let (mut modes, mut rest) = (arrival.modes(), number);
        for (k, own) in hit.iter().zip(&candidates) {
            modes[*k] = own[rest % own.len()];
            rest /= own.len();
        }
        add_both_senses(problem, &modes, &held, trials, &mut found);
    }
    (found, true)
}

fn add_both_senses(
    problem: &RateProblem,
    modes: &[ContactMode],
    held: &[bool],
    trials: &mut u64,
    found: &mut Vec<Rate>,
) {
    for sense in [1.0, -1.0] {
        if let Some(rate) = settled(problem, modes.to_vec(), held, sense, trials) {
            add(found, rate);
        }
    }
}

/// Adds a rate that is not yet known.
pub fn add(found: &mut Vec<Rate>, rate: Rate) {
    if !found.iter().any(|known| known.is_same(&rate, SETTINGS.same_rate())) {
        found.push(rate);
    }
}

/// Primal–dual active set in one sense of λ: points that are not `held` change their modes by their inequalities.
/// `None` if it cycles or if a held point violates its mode.
pub fn settled(
    problem: &RateProblem,
    mut modes: Vec<ContactMode>,
    held: &[bool],
    sense: f64,
    trials: &mut u64,
) -> Option<Rate> {
    let mut seen: Vec<Vec<ContactMode>> = Vec::new();
    for _ in 0..60 + modes.len() {
        *trials += 1;
        let attempt = problem.attempt(&modes, 1.0)?;
        if attempt.singular {
            return problem.at_constant_load(&modes);
        }
        let violations = problem.violations(&modes, &attempt, sense);
        if violations.is_empty() {
            return Some(problem.rate(&modes, &attempt, sense, sense));
        }
        if violations.iter().any(|(_, k, _)| held[*k]) || seen.contains(&modes) {
            return None;
        }
        seen.push(modes.clone());
        violations.into_iter().for_each(|(_, k, to)| modes[k] = to);
    }
    None
}
