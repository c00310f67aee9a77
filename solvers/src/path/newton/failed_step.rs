//! What follows a step that did not converge: another branch, a shorter step, or the end of the path.

use super::branch_switching::{yielding_blocks_branch, yielding_branch};
use super::following::{Branch, Following};
use super::limit_point::rising_branch;
use super::peak::note_peak;
use super::state::Tangent;
use super::system::StepFailure;
use super::termination::no_step;
use super::tracer::{LoadStepEnding, Tracer};
use super::trial::{StepPlan, first_slip};

/// Length, relative to the first step, at which a corner of the path is looked for.
pub(super) const CORNER: f64 = 1e-7;

/// Share of the load within which a corner is placed, as far as steps can be that short.
const PLACED: f64 = 1e-8;

/// Length, relative to the first step, below which there is no step.
pub(super) const SHORTEST: f64 = 1e-10;

/// What follows.
pub(super) enum AfterFailure {
    /// A step of this length.
    CutBack(f64),
    /// A corner of the path: another branch.
    Corner(Branch),
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
    if slip <= 1e-9 * plan.share.max(first / plan.per_tangent) && fresh {
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
        note_peak(tracer, Some(&other), following.direction);
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
    let share = following.limits.first / plan.per_tangent;
    let (mut tangent, mut modes) = yielding_branch(tracer, &following.branch.tangent, share)?;
    let mut falls = tangent.factor * direction <= 0.0;
    let state = tracer.state.clone();
    // In the present modes no step has led on, however short.
    if falls && let Some(rising) = rising_branch(tracer, &state, direction).filter(|rising| rising.1 != state.mode) {
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
        return Some(AfterFailure::Ended(no_step(tracer, failure, &tangent, direction)));
    }
    if falls && tracer.limit.peak.is_none() {
        note_peak(tracer, Some(&tangent), direction);
    }
    Some(AfterFailure::Corner(Branch { tangent, modes: Some(modes) }))
}

/// A shorter step. If it is too short, a rate with growing λ by a search, or the end.
fn shortened(tracer: &mut Tracer, following: &mut Following, length: f64, failure: &StepFailure) -> AfterFailure {
    if length >= SHORTEST * following.limits.first {
        return AfterFailure::CutBack(length);
    }
    let state = tracer.state.clone();
    if tracer.limit.peak.is_none()
        && let Some((tangent, modes)) = rising_branch(tracer, &state, following.direction)
    {
        return AfterFailure::Corner(Branch { tangent, modes: Some(modes) });
    }
    AfterFailure::Ended(no_step(tracer, failure, &following.branch.tangent, following.direction))
}
