//! Accepts converged states, and ends paths at which a joint or all contact is lost.

use super::peak::note_peak;
use super::tracer::{LoadStepEnding, Tracer, direction, end_path, foreseen, is_above};
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::events::events;
use crate::path::newton::quantities::recorded::recorded;
use crate::path::newton::solve::second_order::stability;
use crate::path::stability::regains_limit_point;
use crate::settings::SETTINGS;
use voussoir_core::limit::Status;
use voussoir_core::path::{Contact, LimitPointEnd};

/// Accepts a converged state as the next one. Returns true if the path continues.
pub fn commit(tracer: &mut Tracer, mut next: State) -> bool {
    let greatest = |force: &[[f64; 2]]| force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
    if tracer.system.finite()
        && let Some(peak) = &tracer.limit.peak
        && greatest(&next.force) <= SETTINGS.distinct() * greatest(&peak.state.force)
    {
        end_path(
            tracer,
            Status::Collapse,
            "after the peak the blocks come apart: no forces are left between them".into(),
        );
        return false;
    }
    tracer.system.drop_rounding(&mut next);
    // A point that closes beyond its face has no contact: the path ends at the state before.
    if let Some((apart, why)) = left_its_pairing(&tracer.system, &next, SETTINGS.admissible) {
        end_at_lost_joint(tracer, apart, None, why);
        return false;
    }
    let gradient = tracer.system.gradient(&next);
    tracer.record.events.extend(events(&tracer.system, tracer.in_force.load_step, &tracer.state, &next));
    let (energy, work) = foreseen(tracer, &next, &gradient);
    tracer.record.energy = energy;
    let start = tracer.state.clone();
    tracer.system.keep(&start, &mut next);
    let mut seen = recorded(&tracer.record.energy, &tracer.system, tracer.in_force.load_step, &next, &gradient);
    if regains_limit_point(&tracer.limit.proven_peaks, tracer.in_force.load_step, [start.factor, next.factor]) {
        let settles = tracer.system.settles();
        seen.stable_under_load = stability(&mut tracer.system, &next, settles).under_load;
    }
    let (problem, finite) = (tracer.system.problem, tracer.settings.finite);
    tracer.record.balance = tracer.record.balance.after(problem, finite, &tracer.record.state, &seen).0;
    tracer.record.state = seen;
    tracer.state = next;
    tracer.record.work = work;
    tracer.system.count("steps", 1);
    if !tracer.observer.state(tracer.system.problem, &tracer.record.state) {
        end_path(tracer, Status::Stalled, "stopped by the observer".into());
        return false;
    }
    if let Some((apart, why)) = left_its_pairing(&tracer.system, &tracer.state, 0.0) {
        end_at_lost_joint(tracer, apart, None, why);
        return false;
    }
    true
}

/// Ends a path with finite displacements at which a joint has slipped to the limit of its pairing. If its blocks have
/// come `apart`, they are not a structure any more, and a load that has grown up to here is a limit point; `rate`
/// continues from it.
pub fn end_at_lost_joint(tracer: &mut Tracer, apart: bool, rate: Option<&Tangent>, why: String) -> LoadStepEnding {
    let direction = direction(tracer);
    let greatest = tracer.limit.peak.as_ref().is_none_or(|peak| is_above(direction, peak.factor, tracer.state.factor));
    let status = match (apart, greatest) {
        (true, true) => {
            note_peak(tracer, rate, direction);
            tracer.ending.limit_point_end = Some(LimitPointEnd::JointLost);
            Status::LimitPoint
        }
        (true, false) => Status::Collapse,
        (false, _) => Status::Stalled,
    };
    end_path(tracer, status, why)
}

/// Checks closed points with finite displacements that have slipped beyond the limit of their pairing by more than a
/// share `beyond` of the size. Returns true if the blocks have come apart, and a note.
pub fn left_its_pairing(system: &StepSystem, state: &State, beyond: f64) -> Option<(bool, String)> {
    if !system.finite() {
        return None;
    }
    let largest = state.force.iter().flatten().map(|r| r.abs()).fold(0.0, f64::max);
    let points = system.problem.contacts.iter().zip(&state.force).zip(&state.gap);
    let mut pressed = points.filter(|((_, force), _)| force[0] > 1e-9 * largest);
    let margin = beyond * system.units().length;
    let leaves = |c: &Contact, slip: f64| slip < c.sliding.slip[0] - margin || slip > c.sliding.slip[1] + margin;
    let ((c, _), gap) = pressed.find(|((c, _), gap)| leaves(c, gap[1]))?;
    Some(lost_joint(c, gap[1], state.factor))
}

/// Returns true, with a note, if the blocks have come apart at a point at the limit of its pairing.
pub fn lost_joint(contact: &Contact, slip: f64, factor: f64) -> (bool, String) {
    let (apart, why) = match contact.sliding.corners {
        [low, high] if low != high => (true, "it has lost half of its height"),
        [0.5, 0.5] if contact.sliding.passing == 0.0 => {
            (false, "a contact point away from all corners is paired for less")
        }
        [0.5, 0.5] => (true, "it has lost half of its height"),
        _ => (true, "its contact point leaves the face that it slides on"),
    };
    let joint = contact.joint;
    (apart, format!("joint {joint} has slipped by {:.4e} m at factor {factor}: {why}", slip.abs()))
}
