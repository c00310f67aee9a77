//! Steps and peaks of paths on which bonds soften.
//!
//! Where a bond begins to soften the path has a kink, in a brittle structure a sharp return: both
//! load and displacement fall. A step of a given length in motion or load may then not exist, or be the
//! way back. What always grows is the gap of the points that soften: where the strategy's own step
//! fails, one step is controlled by these gaps (de Borst 1987, Computers & Structures 25, 211-224).

use super::control::LocalControl;
use super::measure::increment_along;
use super::peak::{note_proven_peak, peak_at};
use super::response::{local_control_of_step, local_controls, tractions_dissipate};
use super::state::{State, Tangent};
use super::step::solve_step;
use super::tangent::tangent_at;
use super::tracer::{Peak, Tracer, moved_along};

/// A step controlled by the gaps of the points that the rate softens. `None` where there are none, none is found, or
/// the load falls in it and the strategy does not pass limit points.
pub(super) fn softening_step(
    tracer: &mut Tracer,
    rate: &Tangent,
    share: f64,
    target: f64,
    direction: f64,
) -> Option<(State, u64, LocalControl)> {
    let (from, passes) = (tracer.state.factor, tracer.strategy.passes_limit_points());
    let fits = |factor: f64| (factor - target) * direction <= 0.0 && (passes || (factor - from) * direction > 0.0);
    step_by_gaps(tracer, rate, share, fits)
}

/// Whether the path goes on with a load that falls, in a step controlled by the gaps of the points that soften.
pub(super) fn softens_down(tracer: &mut Tracer, rate: &Tangent, direction: f64) -> bool {
    let from = tracer.state.factor;
    let falls = |factor: f64| (factor - from) * direction < -1e-9 * from.abs();
    [1e-1, 1e-2, 1e-3, 1e-4, 1e-6].iter().any(|share| step_by_gaps(tracer, rate, *share, falls).is_some())
}

/// The first step controlled by gaps that softens and whose factor fits.
fn step_by_gaps(
    tracer: &mut Tracer,
    rate: &Tangent,
    share: f64,
    fits: impl Fn(f64) -> bool,
) -> Option<(State, u64, LocalControl)> {
    if tracer.system.laws.responses.is_empty() {
        return None;
    }
    let start = tracer.state.clone();
    let mut ahead = moved_along(tracer, rate, share);
    for (gap, rate) in ahead.gap.iter_mut().zip(&rate.gap) {
        (0..2).for_each(|k| gap[k] += share * rate[k]);
    }
    for local in local_controls(&mut tracer.system, &start, &ahead, rate) {
        let Ok((next, iterations)) = solve_step(&mut tracer.system, &start, ahead.clone(), &local.control(share))
        else {
            continue;
        };
        if fits(next.factor) && tractions_dissipate(&tracer.system, &next) {
            return Some((next, iterations, local));
        }
    }
    None
}

/// The rate in the sense in which what softened in the step goes on to.
pub(super) fn dissipating_sense(tracer: &mut Tracer, next: &State, rate: Tangent) -> Tangent {
    if tracer.system.laws.responses.is_empty() || !tractions_dissipate(&tracer.system, next) {
        return rate;
    }
    let back = rate.scaled(-1.0);
    let [on, off] = [&rate, &back].map(|rate| increment_along(&tracer.system, next, rate).dissipation);
    if off > 100.0 * on { back } else { rate }
}

/// A limit point below the factor at which the path ends is not its greatest.
pub(super) fn forget_lower_peak(tracer: &mut Tracer, direction: f64) {
    let factor = tracer.state.factor;
    let lower = |peak: &Peak| (factor - peak.factor) * direction > 0.0;
    if !tracer.system.laws.responses.is_empty()
        && let Some(peak) = tracer.limit.peak.take_if(|peak| lower(peak))
    {
        tracer
            .record
            .notes
            .push(format!("after a limit point at factor {} the load rises above it again", peak.factor));
    }
}

/// Keeps the greatest factor between the last state and `next` as the peak, where the factor falls
/// in the step and no earlier peak was higher. Bisects by the gaps of the points that soften in it.
pub(super) fn softening_peak(tracer: &mut Tracer, next: &State, falls: bool, direction: f64) {
    if !falls || tracer.system.laws.responses.is_empty() {
        return;
    }
    let start = tracer.state.clone();
    let higher = |factor: f64, than: f64| (factor - than) * direction > 1e-12 * than.abs();
    let earlier = tracer.limit.peak.as_ref().map(|peak| peak.factor);
    let Some(local) = local_control_of_step(&tracer.system, &start, next) else { return };
    let (mut low, mut high) = (0.0, 1.0);
    let (mut best, mut beyond) = (start.clone(), None);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let control = local.control(middle);
        let guess = between(&start, next, middle);
        let Ok((state, _)) = solve_step(&mut tracer.system, &start, guess, &control) else { break };
        let Some(here) = tangent_at(&mut tracer.system, &start, &state, &control) else { break };
        let gain = here.factor.abs() * (high - low);
        if here.factor * direction > 0.0 {
            (low, best) = (middle, state);
            if gain <= 1e-11 * best.factor.abs().max(1e-6 * tracer.system.units().factor) {
                break;
            }
        } else {
            (high, beyond) = (middle, Some(here));
        }
    }
    let beyond = match beyond {
        Some(beyond) => beyond,
        None => match tangent_at(&mut tracer.system, &start, next, &local.control(1.0)) {
            Some(rate) => rate,
            None => return,
        },
    };
    if earlier.is_none_or(|earlier| higher(best.factor, earlier)) {
        if let Some(earlier) = earlier {
            tracer.record.notes.push(format!("after a limit point at factor {earlier} the load rises above it again"));
        }
        let peak = peak_at(tracer, best, &beyond);
        note_proven_peak(tracer, peak, direction);
    }
}

/// The state a share of the way from one to another.
fn between(from: &State, to: &State, share: f64) -> State {
    let mut state = from.clone();
    for (r, end) in state.force.iter_mut().zip(&to.force) {
        (0..2).for_each(|k| r[k] += share * (end[k] - r[k]));
    }
    for (q, end) in state.motion.iter_mut().zip(&to.motion) {
        (0..3).for_each(|k| q[k] += share * (end[k] - q[k]));
    }
    state.factor += share * (to.factor - state.factor);
    state
}
