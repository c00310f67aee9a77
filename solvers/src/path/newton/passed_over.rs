//! Whether a step may pass over a part of the path (finite displacements).
//!
//! A converged step has two ends of one path, or of two, and says nothing of what lies between. Where modes change in it:
//!
//! - *It flattens.* Little is left at its end of the rate at which the load grew at its start: a peak and a trough may lie
//!   in it.
//! - *It moves otherwise.* Where one event lies in a step that is nearly linear on both sides of it, the motion is a sum
//!   of the rates at both ends, Δq = a q̇₀ + b q̇₁ with a, b ≥ 0. What is left of Δq moved between, on a piece of the path
//!   that neither end knows.
//! - *It overtakes an event.* By the rate at its start one point leaves its mode first, and at its end another one has, and
//!   that point has not: from the first event another path starts than the one that was found.
//! - *It turns in between.* The path goes through pieces on which some points have changed their modes and others have
//!   not. If the load rises at both ends of the step and falls at the rate of such a piece, or the reverse, a peak and a
//!   trough may lie in it. Looked at are the modes of the start at the end, those of the end at the start, and at the end those
//!   with one point changed, or all but one. A peak or trough itself is looked for in steps in which no more than one point
//!   changes.
//!
//! Such steps are shortened.

use super::control::Control;
use super::following::Following;
use super::slip_history::predicted_event;
use super::state::{State, Tangent};
use super::system::StepSystem;
use super::tangent::RateEquations;
use super::tracer::{Tracer, moved};
use super::trial::{StepPlan, Trial};
use crate::path::continuation::arc_length::ArcLength;
use nalgebra::Vector2;
use std::any::Any;
use std::sync::Arc;

/// Share of the rate at the start of a step below which it has flattened.
const FLATTENED: f64 = 0.25;
/// Share of a motion that is no sum of the rates at both ends, from which on it is another one.
const OTHERWISE: f64 = 0.2;
/// Share of the predictor's next event at which one is overtaken.
const OVERTAKEN: f64 = 0.9;
/// Length, relative to the first step, down to which what may lie between is resolved.
const RESOLVED: f64 = 0.1;
/// 1 − cos² of the angle between two rates that are one.
const PARALLEL: f64 = 1e-12;
/// Shares of the step within which the next one lies.
const SHARES: [f64; 2] = [0.1, 0.5];
/// Share of a step at which its beginning is looked at: at it no length has a direction.
const BEGUN: f64 = 0.01;
/// Length, relative to the first step, down to which a piece that turns is resolved.
const TURNING: f64 = 1e-3;
/// Points that change their modes in a step up to which the pieces between are looked at.
const MOST_CHANGES: usize = 12;

/// Length of the step that is to be tried instead of one that may pass over something; `gains` is what the rates at both
/// ends would let the factor gain in it.
pub(super) fn passes_over(
    tracer: &mut Tracer,
    following: &Following,
    plan: &StepPlan,
    (trial, end): (&Trial, &Tangent),
    gains: [f64; 2],
) -> Option<f64> {
    let (state, next, length) = (&tracer.state, &trial.next, following.length);
    if !tracer.system.finite() || next.mode == state.mode || length <= TURNING * following.limits.first {
        return None;
    }
    let rate = &following.branch.tangent;
    let resolved = length <= RESOLVED * following.limits.first;
    let along = gains.map(|gain| gain * following.direction);
    if !resolved && (flattens(along) || otherwise(&tracer.system, [state, next], [rate, end])) {
        return Some(SHARES[1] * length);
    }
    let overtaken = overtaken(&tracer.system, state, (rate, plan.step), next).filter(|_| !resolved);
    let share = overtaken.map(|share| share.clamp(SHARES[0], SHARES[1]));
    let share = share.or_else(|| turns_between(tracer, following, plan, trial, gains).then_some(SHARES[1]))?;
    Some(share * length)
}

/// Whether the load turns more often on the pieces of the path that may lie in a step than the rates at its ends say; not
/// where it falls as fast at both. Which point changes first is not known.
fn turns_between(tracer: &mut Tracer, following: &Following, plan: &StepPlan, trial: &Trial, gains: [f64; 2]) -> bool {
    let (system, state) = (&mut tracer.system, &tracer.state);
    let next = &trial.next;
    let rises = |slope: f64| slope * following.direction > 0.0;
    let [before, after] = gains.map(rises);
    let changed: Vec<usize> = (0..next.mode.len()).filter(|c| next.mode[*c] != state.mode[*c]).collect();
    if before != after || changed.len() > MOST_CHANGES {
        return before != after && changed.len() > 1;
    }
    let [least, most] = [f64::min, f64::max].map(|choose| choose(gains[0].abs(), gains[1].abs()));
    if !before && least > FLATTENED * most {
        return false;
    }
    let with = |place: &State, modes: &State, swapped: Option<(usize, &State)>| {
        let mut piece = State { mode: modes.mode.clone(), ..place.clone() };
        swapped.into_iter().for_each(|(c, other)| piece.mode[c] = other.mode[c]);
        piece
    };
    let control = along_the_path(following, &trial.control);
    let mut pieces = vec![with(next, state, None)];
    if changed.len() > 1 {
        pieces.extend(changed.iter().map(|c| with(next, state, Some((*c, next)))));
    }
    if changed.len() > 2 {
        pieces.extend(changed.iter().map(|c| with(next, next, Some((*c, state)))));
    }
    let turns = |system: &mut StepSystem, rates: &RateEquations, piece: &State| {
        system.count("pieces", 1);
        rates.slope(system, piece).is_some_and(|slope| rises(slope) != before)
    };
    let at_end = RateEquations::new(system, state, (next, next), &control);
    if pieces.iter().any(|piece| turns(system, &at_end, piece)) {
        return true;
    }
    let begun = with(&moved(state, &following.branch.tangent, BEGUN * plan.step), next, None);
    // The equations of the beginning itself are known.
    let place = if system.solves_nearby() { state } else { &begun };
    let at_beginning = RateEquations::new(system, state, (place, &begun), &control);
    turns(system, &at_beginning, &begun)
}

/// The control by which the rates of pieces are oriented: lengths grow along a path, whatever another strategy measures may not.
fn along_the_path(following: &Following, control: &Control) -> Control {
    match control {
        Control::Strategy { strategy, length, .. } if !(&**strategy as &dyn Any).is::<ArcLength>() => {
            Control::Strategy {
                strategy: Arc::new(ArcLength::default()),
                previous: following.previous,
                length: *length,
            }
        }
        other => other.clone(),
    }
}

/// Whether a step that rises at both ends flattens.
fn flattens([before, after]: [f64; 2]) -> bool {
    before > 0.0 && after > 0.0 && after < FLATTENED * before
}

/// Whether a motion between two states is no sum of the rates at both.
fn otherwise(system: &StepSystem, [start, next]: [&State; 2], [begin, end]: [&Tangent; 2]) -> bool {
    let length = system.units().length;
    let metres = |q: [f64; 3]| [q[0], q[1], length * q[2]];
    let moved = next.motion.iter().zip(&start.motion).map(|(b, a)| metres([0, 1, 2].map(|k| b[k] - a[k])));
    let moved: Vec<[f64; 3]> = moved.collect();
    let [begin, end] = [begin, end].map(|rate| rate.motion.iter().map(|q| metres(*q)).collect::<Vec<_>>());
    left_over(&moved, [&begin, &end]) > OTHERWISE
}

/// Norm of what is left of a motion by the nearest sum of two others with coefficients that are not negative, relative to
/// the motion.
fn left_over(moved: &[[f64; 3]], rates: [&[[f64; 3]]; 2]) -> f64 {
    let dot = |a: &[[f64; 3]], b: &[[f64; 3]]| -> f64 {
        a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| a * b).sum()
    };
    let size = dot(moved, moved).sqrt();
    let norms = rates.map(|rate| dot(rate, rate).sqrt());
    if size == 0.0 || norms.contains(&0.0) {
        return 0.0;
    }
    // All are normed: what is left of d has the square 1 − that of its part along the rates.
    let along = Vector2::from(rates.map(|rate| dot(rate, moved) / size)).component_div(&Vector2::from(norms));
    let cosine = dot(rates[0], rates[1]) / (norms[0] * norms[1]);
    let [a, b] = [along[0] - cosine * along[1], along[1] - cosine * along[0]];
    let [of_both, determinant] = [along[0] * a + along[1] * b, 1.0 - cosine * cosine];
    let of_one = along.max().max(0.0).powi(2);
    let part = if determinant > PARALLEL && a >= 0.0 && b >= 0.0 { of_both / determinant } else { of_one };
    (1.0 - part).max(0.0).sqrt()
}

/// Share of a step at which, by the rate at its start, a point leaves its mode that keeps it in the step, before all that
/// leave theirs.
fn overtaken(system: &StepSystem, start: &State, rate: (&Tangent, f64), next: &State) -> Option<f64> {
    let shares = |changes: bool| {
        let points = (0..next.mode.len()).filter(move |c| (next.mode[*c] != start.mode[*c]) == changes);
        let told = points.filter_map(|c| predicted_event(system, start, rate, c));
        told.filter(|share| *share > 0.0 && *share < 1.0).reduce(f64::min)
    };
    let [kept, changed] = [false, true].map(shares);
    kept.filter(|kept| changed.is_some_and(|changed| *kept < OVERTAKEN * changed))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_is_a_sum_of_the_rates_at_both_ends_or_something_is_left() {
        let [x, y] = [[2.0, 0.0, 0.0], [0.0, 0.5, 0.0]];
        let left = |moved: [f64; 3], end: [f64; 3]| left_over(&[moved], [&[x], &[end]]);
        assert!(left([3.0, 4.0, 0.0], y) < 1e-15);
        assert!((left([3.0, 0.0, 4.0], y) - 0.8).abs() < 1e-15);
        // Against a rate nothing moves.
        assert!((left([3.0, -4.0, 0.0], y) - 0.8).abs() < 1e-15);
        assert!((left([-3.0, -4.0, 0.0], y) - 1.0).abs() < 1e-15);
        // Rates that are one.
        assert!((left([3.0, 4.0, 0.0], x) - 0.8).abs() < 1e-15);
        assert!(left([0.0; 3], y) == 0.0);
    }
}
