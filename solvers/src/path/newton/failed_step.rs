//! What follows a step that did not converge: another branch, a shorter step, or the end of the path.

use super::branch_switching::{branch_beyond_fold, yielding_blocks_branch};
use super::creeping::CREEPS;
use super::following::{Branch, Following};
use super::limit_point::rising_branch;
use super::peak::{PLACED, note_peak};
use super::state::Tangent;
use super::system::StepFailure;
use super::termination::{no_step, snaps};
use super::tracer::{LoadStepEnding, Tracer, after_fold, after_peak, end_path};
use super::trial::{StepPlan, first_slip};
use voussoir_core::limit::Status;

/// Length, relative to the first step, down to which modes guessed at a corner are tried before rates are searched.
const UNFOLLOWED: f64 = 1e-4;

/// Length, relative to the first step, at which a corner of the path is looked for.
pub(super) const CORNER: f64 = 1e-7;

/// Length, relative to the first step, below which there is no step.
pub(super) const SHORTEST: f64 = 1e-10;

/// What follows.
pub(super) enum AfterFailure {
    /// A step of this length.
    CutBack(f64),
    /// A corner of the path: another branch.
    Corner(Branch),
    /// A snap: a settlement goes no further by itself, on this rate it goes back.
    Snap(Tangent),
    /// Nothing.
    Ended(LoadStepEnding),
}

/// Whether another branch has been looked for at the present state.
pub(super) fn searched_here(tracer: &Tracer, following: &Following) -> bool {
    following.tried.branch == tracer.system.counters.get("steps").copied()
}

/// Decides what follows a step that did not converge.
pub(super) fn after_failure(
    tracer: &mut Tracer,
    following: &mut Following,
    plan: &StepPlan,
    failure: &StepFailure,
) -> AfterFailure {
    tracer.system.count("cutbacks", 1);
    let slip = first_slip(tracer, &following.branch.tangent).unwrap_or(f64::INFINITY);
    let steps = tracer.system.counters.get("steps").copied();
    let first = following.limits.first;
    let short = following.length <= CORNER * first;
    let fresh = !searched_here(tracer, following);
    if short
        && fresh
        && let Some(other) = yielding_blocks_branch(tracer, &following.branch.tangent, 1e-5 * first / plan.per_tangent)
    {
        following.tried.branch = steps;
        return blocks_yield(tracer, following, failure, other);
    }
    // With finite displacements points that open together turn the path as sharply as slip does. Where a point creeps
    // its modes are those of no solution, and shorter steps creep as well.
    let creeps = failure.why == CREEPS && following.length < UNFOLLOWED * first;
    let at_corner = tracer.system.rules.oriented && (short || creeps);
    if (slip <= 1e-9 * plan.share.max(first / plan.per_tangent) || at_corner) && fresh {
        following.tried.branch = steps;
        if let Some(after) = corner(tracer, following, plan, failure) {
            return after;
        }
    }
    // Rounding must not leave the length as it is.
    let (share, length) = (plan.share, following.length);
    let shorter = if slip > 1e-9 * share && slip < 0.9 * share { slip * plan.per_tangent } else { 0.3 * length };
    shortened(tracer, following, shorter, failure)
}

/// A block at its strength softens: the path turns where it begins to yield.
fn blocks_yield(tracer: &mut Tracer, following: &Following, failure: &StepFailure, other: Tangent) -> AfterFailure {
    if other.factor * following.direction <= 0.0 {
        if !tracer.strategy.passes_limit_points() {
            return AfterFailure::Ended(no_step(tracer, failure, &other, following.direction));
        }
        note_peak(tracer, &other, following.direction);
    }
    AfterFailure::Corner(Branch { tangent: other, modes: None })
}

/// At the very event: another branch, on which the points at their limit yield.
fn corner(
    tracer: &mut Tracer,
    following: &mut Following,
    plan: &StepPlan,
    failure: &StepFailure,
) -> Option<AfterFailure> {
    let direction = following.direction;
    let found = match branch_beyond_fold(tracer, following, following.limits.first / plan.per_tangent) {
        Ok(found) => found,
        Err(why) => {
            if following.slope > 0.0 && following.comes_stable() {
                note_peak(tracer, &following.branch.tangent, direction);
            }
            let status = match (tracer.system.finite(), following.branch.tangent.factor * direction > 0.0) {
                (true, true) if following.limits.ends_at_peak => Status::LimitPoint,
                (true, true) => after_fold(tracer),
                (true, false) => after_peak(tracer),
                (false, _) => Status::LimitPoint,
            };
            return Some(AfterFailure::Ended(end_path(tracer, status, why)));
        }
    };
    let (mut tangent, mut modes) = found?;
    let mut falls = tangent.factor * direction <= 0.0;
    let arrives = !tracer.system.finite() || following.slope > 0.0;
    let state = tracer.state.clone();
    // In the present modes no step has led on, however short.
    if falls
        && arrives
        && let Some(rising) = rising_branch(tracer, &state, direction).filter(|rising| rising.1 != state.mode)
    {
        (tangent, modes) = rising;
        falls = false;
    }
    // The corner lies within the step that failed: next to a load that is almost nothing that may be far.
    let ahead = following.slope * following.length / plan.per_tangent;
    let shorter = 0.3 * following.length;
    if falls && ahead > PLACED * tracer.state.factor.abs() && shorter >= SHORTEST * following.limits.first {
        following.tried.branch = None;
        return Some(AfterFailure::CutBack(shorter));
    }
    if falls && !tracer.strategy.passes_limit_points() {
        return Some(match following.takes_arc_lengths(tracer) {
            true => AfterFailure::CutBack(following.length),
            false => AfterFailure::Ended(no_step(tracer, failure, &tangent, direction)),
        });
    }
    let grew = following.slope > 0.0;
    if falls && grew && following.orientation.is_some() && snaps(tracer, following.load_step) {
        return Some(AfterFailure::Snap(tangent));
    }
    if falls && following.comes_stable() && (grew || (!tracer.system.finite() && tracer.limit.peak.is_none())) {
        note_peak(tracer, &tangent, direction);
    }
    Some(AfterFailure::Corner(Branch { tangent, modes: Some(modes) }))
}

/// A shorter step. If it is too short, a rate with growing λ by a search, or the end.
fn shortened(tracer: &mut Tracer, following: &mut Following, length: f64, failure: &StepFailure) -> AfterFailure {
    if following.comes_to_smooth_peak(tracer) && following.takes_arc_lengths(tracer) {
        return AfterFailure::CutBack(following.length);
    }
    if length >= SHORTEST * following.limits.first {
        return AfterFailure::CutBack(length);
    }
    let state = tracer.state.clone();
    if tracer.limit.peak.is_none()
        && let Some((tangent, modes)) = rising_branch(tracer, &state, following.direction)
    {
        return AfterFailure::Corner(Branch { tangent, modes: Some(modes) });
    }
    if following.takes_arc_lengths(tracer) {
        return AfterFailure::CutBack(following.length);
    }
    AfterFailure::Ended(no_step(tracer, failure, &following.branch.tangent, following.direction))
}
