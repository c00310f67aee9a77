//! The end of a path: the range that a stage requests.

use crate::path::newton::tracing::tracer::{LoadStepEnding, Tracer, end_path, is_above};
use crate::settings::SETTINGS;
use voussoir_core::limit::Status;
use voussoir_core::path::LoadStep;

/// Returns the ending of a path that has reached the end of its requested range.
pub(super) fn end_of_range(
    tracer: &mut Tracer,
    load_step: &LoadStep,
    direction: f64,
    from: f64,
) -> Option<LoadStepEnding> {
    let (factor, displacement) = (tracer.state.factor, tracer.record.state.displacement);
    if let Some(last) = tracer.limit.proven_peaks.last_mut()
        && (last.lowest - factor) * direction > 0.0
    {
        last.lowest = factor;
    }
    let span = tracer.system.problem.span.max(tracer.system.units().length);
    let gone = (displacement - from).abs() >= span;
    let Some((greatest, place)) = tracer.limit.peak.as_ref().map(|peak| (peak.factor, peak.state.displacement)) else {
        return gone.then(|| {
            let why = format!("no limit point up to a displacement of {displacement} m, at factor {factor}");
            end_path(tracer, Status::Stalled, why)
        });
    };
    let done = match tracer.settings.stop(load_step.stage) {
        // A support does not move further by itself: the next motion is a fall.
        [None, None] if tracer.system.settles() => true,
        [None, None] => {
            let fallen = (greatest - factor) * direction;
            fallen >= SETTINGS.half * (greatest - load_step.start).abs() || gone
        }
        [most, least] => {
            // Measured from the last limit point.
            let from = tracer.limit.proven_peaks.last().map_or(place, |last| last.displacement);
            most.is_some_and(|most| (displacement - from).abs() >= most)
                || least.is_some_and(|least| (factor - least) * direction <= 0.0)
        }
    };
    if !done {
        return None;
    }
    if is_above(direction, greatest, factor) {
        let why =
            format!("still rising: at the end of its range the load is above all limit points, at factor {factor}");
        return Some(end_path(tracer, Status::Stalled, why));
    }
    Some(end_path(tracer, Status::Collapse, String::new()))
}
