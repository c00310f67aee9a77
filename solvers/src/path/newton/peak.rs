//! Peaks and troughs of the load within a step, by bisection.

use super::control::Control;
use super::following::{Following, per_tangent};
use super::measure::{fastest, increment_along, motion_size};
use super::recorded::recorded;
use super::state::{State, Tangent};
use super::step::solve_step;
use super::tangent::tangent_at;
use super::tracer::{Peak, Tracer, foreseen, moved_along};
use super::witness::{self, has_history, none_rises};
use voussoir_core::path::ProvenPeak;

/// Relative differences of the loads and displacements of two limit points that are one.
const SAME: f64 = 1e-8;
/// Fall of the load between two of them, relative to it, from which on the path has been elsewhere.
const FALLEN: f64 = 1e-6;

/// Bisects the step from the present state for the peak of λ in the sense `direction`: the last state on which it grows, and
/// the rate just beyond it.
pub(super) fn locate_peak(tracer: &mut Tracer, following: &Following, direction: f64) -> (State, Tangent) {
    let (rate, previous, length) = (&following.branch.tangent, following.previous, following.length);
    let strategy = tracer.strategy.clone();
    let (unit, per_rate) = (tracer.system.units().factor, per_tangent(tracer, rate, previous.as_ref()));
    let (mut low, mut high) = (0.0, length);
    let mut best = (tracer.state.clone(), rate.clone());
    let gain = |best: &(State, Tangent), width: f64| best.1.factor.abs() * width / best.0.factor.abs().max(1e-6 * unit);
    let mut beyond = None;
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
            beyond = Some(here);
        }
        if low > 0.0 && gain(&best, high - low) <= 1e-11 {
            break;
        }
    }
    (best.0, beyond.unwrap_or_else(|| rate.clone()))
}

/// Keeps a proven peak; the greatest is what the path's answer speaks of (with small displacements the first).
/// If the path has been there before, with less load in between, it is not another one: with friction a path may run in a
/// loop.
pub(super) fn note_proven_peak(tracer: &mut Tracer, peak: Peak, direction: f64) {
    let (factor, displacement) = (peak.factor, peak.state.displacement);
    let greatest = |known: &Peak| (factor - known.factor) * direction > 0.0;
    if tracer.system.finite() {
        let load_step = tracer.load_step;
        let near = |a: f64, b: f64, by: f64| (a - b).abs() <= by * b.abs();
        let same = |known: &&ProvenPeak| {
            known.load_step == load_step
                && near(factor, known.factor, SAME)
                && near(displacement, known.displacement, SAME)
                && !near(known.lowest, known.factor, FALLEN)
        };
        if tracer.limit.proven_peaks.iter().any(|known| same(&known)) {
            return;
        }
        tracer.limit.proven_peaks.push(ProvenPeak { load_step, factor, displacement, lowest: factor });
        tracer.trough = None;
    }
    if tracer.limit.peak.as_ref().is_none_or(greatest) {
        tracer.limit.peak = Some(peak);
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
    if has_history(&tracer.system) {
        tracer.record.witnesses.push(witness::beyond(&seen, beyond));
    }
    Peak { factor: state.factor, state: seen, motion }
}

/// Keeps the present state as a peak, with the rate just beyond it: with small displacements only the first.
pub(super) fn note_peak(tracer: &mut Tracer, beyond: Option<&Tangent>, direction: f64) {
    if tracer.system.finite() || tracer.limit.peak.is_none() {
        let motion = beyond.and_then(|rate| scaled_motion(tracer, &tracer.state, rate));
        let peak = Peak { factor: tracer.state.factor, state: tracer.record.state.clone(), motion };
        note_proven_peak(tracer, peak, direction);
        if let (true, Some(rate)) = (tracer.system.finite(), beyond) {
            let Tracer { system, state, record, .. } = tracer;
            record.witnesses.extend(none_rises(system, (state, &record.state), rate, direction));
        }
    }
}

/// Velocities with p·q̇ = 1; of settlements with finite displacements, which do no work, with 1 m of
/// the fastest body's speed. `None` where the load does next to no work on them: rates are checked
/// to 1e-8 of their size, so less work than a hundred times that proves nothing.
pub(super) fn scaled_motion(tracer: &Tracer, state: &State, rate: &Tangent) -> Option<Vec<[f64; 3]>> {
    let u = tracer.system.units();
    let load = tracer.system.problem.load_size(tracer.system.loads.growing);
    let power = increment_along(&tracer.system, state, rate).displacement * u.displacement * load;
    let size = motion_size(&tracer.system, rate) * u.displacement * u.force / u.factor;
    let by = if load == 0.0 && tracer.system.finite() {
        fastest(&tracer.system, &rate.motion)
    } else if power > 1e-6 * size {
        power
    } else {
        0.0
    };
    (by > 0.0).then(|| rate.motion.iter().map(|q| q.map(|x| x / by)).collect())
}
