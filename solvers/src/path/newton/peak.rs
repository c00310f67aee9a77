//! Peaks and troughs of the load within a step, by bisection.

use super::control::Control;
use super::following::{Following, per_tangent};
use super::measure::{increment_along, motion_size};
use super::recorded::recorded;
use super::state::{State, Tangent};
use super::step::solve_step;
use super::tangent::tangent_at;
use super::tracer::{Peak, Tracer, foreseen, moved_along};
use crate::path::energy::load_size;

/// Bisects the step from the present state for the point where λ stops growing in the sense `direction`:
/// the state there and the rate just beyond it.
pub(super) fn locate_peak(tracer: &mut Tracer, following: &Following, direction: f64) -> (State, Tangent) {
    let (rate, previous, length) = (&following.branch.tangent, following.previous, following.length);
    let strategy = tracer.strategy.clone();
    let per_rate = per_tangent(tracer, rate, previous.as_ref());
    let (mut low, mut high) = (0.0, length);
    let mut best = (tracer.state.clone(), rate.clone());
    let mut beyond = rate.clone();
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        let control = Control::Strategy { strategy: strategy.clone(), previous, length: middle };
        let guess = moved_along(tracer, rate, middle / per_rate);
        let Ok((state, _)) = solve_step(&mut tracer.system, &tracer.state, guess, &control) else { break };
        let Some(here) = tangent_at(&mut tracer.system, &tracer.state, &state, &control) else { break };
        if here.factor * direction > 0.0 {
            low = middle;
            best = (state, here);
        } else {
            high = middle;
            beyond = here;
        }
        let gain = best.1.factor.abs() * (high - low);
        if low > 0.0 && gain <= 1e-11 * best.0.factor.abs().max(1e-6 * tracer.system.units().factor) {
            break;
        }
    }
    (best.0, beyond)
}

/// Where the load rises again after a peak with finite displacements: the least load between, if it is
/// lower than any before and the path has not risen by much since.
pub(super) fn note_trough(tracer: &mut Tracer, following: &Following) {
    let direction = following.direction;
    let lower =
        |factor: f64| tracer.post_peak.trough.as_ref().is_none_or(|lowest| (lowest.factor - factor) * direction > 0.0);
    if !tracer.post_peak.risen && lower(tracer.state.factor) {
        let (state, beyond) = locate_peak(tracer, following, -direction);
        tracer.post_peak.trough = Some(peak_at(tracer, state, &beyond));
    }
}

/// A peak at a state between the last one and the next, with the rate just beyond it.
pub(super) fn peak_at(tracer: &mut Tracer, mut state: State, beyond: &Tangent) -> Peak {
    let gradient = tracer.system.gradient(&state);
    let (energy, _) = foreseen(tracer, &state, &gradient);
    let start = tracer.state.clone();
    tracer.system.keep(&start, &mut state);
    let seen = recorded(&energy, &tracer.system, tracer.load_step, &state, &gradient);
    let motion = scaled_motion(tracer, &state, beyond);
    Peak { factor: state.factor, state: seen, motion }
}

/// Keeps the present state as the first peak, where there was none, with the rate just beyond it.
pub(super) fn note_peak(tracer: &mut Tracer, beyond: &Tangent) {
    if tracer.limit.peak.is_none() {
        let motion = scaled_motion(tracer, &tracer.state, beyond);
        tracer.limit.peak = Some(Peak { factor: tracer.state.factor, state: tracer.record.state.clone(), motion });
    }
}

/// Velocities with p·q̇ = 1; of settlements with finite displacements, which do no work, with 1 m of
/// the fastest body's speed. `None` where the load does next to no work on them: rates are checked
/// to 1e-8 of their size, so less work than a hundred times that proves nothing.
pub(super) fn scaled_motion(tracer: &Tracer, state: &State, rate: &Tangent) -> Option<Vec<[f64; 3]>> {
    let u = tracer.system.units();
    let load = load_size(tracer.system.problem, tracer.system.loads.growing);
    let power = increment_along(&tracer.system, state, rate).displacement * u.displacement * load;
    let size = motion_size(&tracer.system, rate) * u.displacement * u.force / u.factor;
    let by = if load == 0.0 && tracer.system.finite() {
        rate.motion.iter().map(|q| q[0].hypot(q[1]).max(q[2].abs() * u.length)).fold(0.0, f64::max)
    } else if power > 1e-6 * size {
        power
    } else {
        0.0
    };
    (by > 0.0).then(|| rate.motion.iter().map(|q| q.map(|x| x / by)).collect())
}
