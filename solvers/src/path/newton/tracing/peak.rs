//! Limit points of a path.

use super::tracer::{Peak, Tracer, foreseen};
use super::witness::none_rises;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::quantities::measure::{fastest, increment_along, motion_size};
use crate::path::newton::quantities::recorded::recorded;
use crate::settings::SETTINGS;
use voussoir_core::path::ProvenPeak;

/// Keeps a proven peak; the path's answer has the greatest. A peak is not counted again if the path returns to it after
/// a lower load: with friction a path may run in a loop.
pub fn note_proven_peak(tracer: &mut Tracer, peak: Peak, direction: f64) {
    let (factor, displacement) = (peak.factor, peak.state.displacement);
    let greatest = |known: &Peak| (factor - known.factor) * direction > 0.0;
    let load_step = tracer.in_force.load_step;
    let near = |a: f64, b: f64, by: f64| (a - b).abs() <= by * b.abs();
    let same = |known: &&ProvenPeak| {
        known.load_step == load_step
            && near(factor, known.factor, SETTINGS.active)
            && near(displacement, known.displacement, SETTINGS.active)
            && !near(known.lowest, known.factor, SETTINGS.distinct())
    };
    if tracer.limit.proven_peaks.iter().any(|known| same(&known)) {
        return;
    }
    tracer.limit.proven_peaks.push(ProvenPeak { load_step, factor, displacement, lowest: factor });
    tracer.limit.trough = None;
    if tracer.limit.peak.as_ref().is_none_or(greatest) {
        tracer.limit.peak = Some(peak);
    }
}

/// Returns a peak at a state between the last one and the next, with the rate just beyond it.
pub fn peak_at(tracer: &mut Tracer, mut state: State, beyond: &Tangent) -> Peak {
    let gradient = tracer.system.gradient(&state);
    let (energy, _) = foreseen(tracer, &state, &gradient);
    let start = tracer.state.clone();
    tracer.system.keep(&start, &mut state);
    let seen = recorded(&energy, &tracer.system, tracer.in_force.load_step, &state, &gradient);
    let motion = scaled_motion(tracer, &state, beyond);
    Peak { factor: state.factor, state: seen, motion }
}

/// Keeps the present state as a peak, with the rate just beyond it.
pub fn note_peak(tracer: &mut Tracer, beyond: Option<&Tangent>, direction: f64) {
    let motion = beyond.and_then(|rate| scaled_motion(tracer, &tracer.state, rate));
    let peak = Peak { factor: tracer.state.factor, state: tracer.record.state.clone(), motion };
    note_proven_peak(tracer, peak, direction);
    if let Some(rate) = beyond {
        let Tracer { system, state, record, .. } = tracer;
        record.witnesses.extend(none_rises(system, (state, &record.state), rate, direction));
    }
}

/// Returns velocities with p·q̇ = 1; for settlements, which do no work, with a speed of 1 m of the fastest body. `None`
/// if the load does almost no work on them: rates are checked to 1e-8 of their size, so less work than a hundred times
/// that proves nothing.
pub fn scaled_motion(tracer: &Tracer, state: &State, rate: &Tangent) -> Option<Vec<[f64; 3]>> {
    let u = tracer.system.units();
    let load = tracer.system.problem.load_size(tracer.system.loads.growing);
    let power = increment_along(&tracer.system, state, rate).displacement * u.displacement * load;
    let size = motion_size(&tracer.system, rate) * u.displacement * u.force / u.factor;
    let by = if load == 0.0 {
        fastest(&tracer.system, &rate.motion)
    } else if power > 1e-6 * size {
        power
    } else {
        0.0
    };
    (by > 0.0).then(|| rate.motion.iter().map(|q| q.map(|x| x / by)).collect())
}
