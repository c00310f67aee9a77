//! Following a load step by its strategy, as a state machine: a step ends as accepted, cut back, at a corner, over a
//! peak, or the path ends.

use super::commit::commit;
use super::control::Control;
use super::failed_step::{AfterFailure, CORNER, SHORTEST, after_failure};
use super::following::{Branch, Following, per_tangent};
use super::limit_point::rising_branch;
use super::measure::{increment_between, motion_size};
use super::peak::{locate_peak, note_proven_peak, peak_at};
use super::plastic_plateau::note_plateau;
use super::response::branch_changes;
use super::softening::{dissipating_sense, softening_peak};
use super::state::Tangent;
use super::step_energy::{MOST_REFINEMENTS, StepEnergy, step_energy};
use super::system::StepFailure;
use super::tangent::tangent_at;
use super::termination::{ends_in_ray, no_step, stops};
use super::tracer::{LoadStepEnding, Tracer, end_path};
use super::trial::{StepPlan, Trial, attempt, plan};
use voussoir_core::limit::Status;
use voussoir_core::path::LoadStep;

/// Greatest number of steps of a load step, those that are tried in vain or taken back among them.
const MOST_STEPS: u64 = 6000;

/// Contact points up to which every change of mode counts for the length of the next step; of more the
/// same share does, so that the number of steps does not grow with the number of joints.
const ORDINARY: usize = 200;

/// A converged step along the path.
struct Step {
    trial: Trial,
    /// The tangent at its end, in the sense in which the path goes on.
    tangent: Tangent,
    /// By how much the next step may be longer for the sake of its energy.
    accuracy: f64,
    /// Whether the load passes a peak in it.
    falls: bool,
}

/// How a step ends.
enum StepEnd {
    Accepted(Step),
    /// The load passes its first peak in it.
    Peak(Step),
    /// To be tried again with this length.
    CutBack(f64),
    /// The path goes on along another branch.
    Corner(Branch),
    Ended(LoadStepEnding),
}

/// By the strategy, up to a factor or the end of the path.
pub(super) fn follow(tracer: &mut Tracer, load_step: &LoadStep, target: f64) -> LoadStepEnding {
    let mut following = match Following::begin(tracer, load_step, target) {
        Ok(following) => following,
        Err(outcome) => return outcome,
    };
    for _ in 0..MOST_STEPS {
        let end = next_step(tracer, &mut following);
        if let Some(outcome) = go_on(tracer, &mut following, end) {
            return outcome;
        }
        let ends = tracer.settings.ends_at_first_limit_point(load_step.stage);
        if ends && tracer.limit.peak.is_some() {
            return end_path(tracer, Status::LimitPoint, String::new());
        }
    }
    out_of_work(tracer)
}

/// Goes on from the end of a step; how the load step ends with it, if so.
fn go_on(tracer: &mut Tracer, following: &mut Following, end: StepEnd) -> Option<LoadStepEnding> {
    match end {
        StepEnd::Accepted(step) => accept(tracer, following, step),
        StepEnd::Peak(step) => pass_peak(tracer, following, step),
        StepEnd::CutBack(length) => {
            following.length = length;
            None
        }
        StepEnd::Corner(branch) => {
            following.switch_to(branch);
            None
        }
        StepEnd::Ended(outcome) => Some(outcome),
    }
}

/// Tries one step.
fn next_step(tracer: &mut Tracer, following: &mut Following) -> StepEnd {
    let Some(plan) = plan(tracer, following) else { return strategy_stopped(tracer, following) };
    match attempt(tracer, following, &plan) {
        Ok(trial) => examine(tracer, following, trial),
        Err(failure) => failed(tracer, following, &plan, &failure),
    }
}

/// What follows a step that did not converge, or is none along the path.
fn failed(tracer: &mut Tracer, following: &mut Following, plan: &StepPlan, failure: &StepFailure) -> StepEnd {
    match after_failure(tracer, following, plan, failure) {
        AfterFailure::CutBack(length) => StepEnd::CutBack(length),
        AfterFailure::Corner(branch) => StepEnd::Corner(branch),
        AfterFailure::Ended(outcome) => StepEnd::Ended(outcome),
    }
}

/// What the strategy measures has stopped growing: without what it knows of the last step it may go on.
fn strategy_stopped(tracer: &mut Tracer, following: &mut Following) -> StepEnd {
    following.previous = None;
    if per_tangent(tracer, &following.branch.tangent, None) > 0.0 {
        return StepEnd::CutBack(following.length);
    }
    let rate = following.branch.tangent.clone();
    let why = StepFailure::new("what the continuation strategy controls stopped changing");
    StepEnd::Ended(no_step(tracer, &why, &rate, following.direction))
}

/// Examines a converged step: its energy, its tangent, and the change of the load in it.
fn examine(tracer: &mut Tracer, following: &mut Following, trial: Trial) -> StepEnd {
    let StepEnergy { growth: accuracy, holds } = step_energy(tracer, &trial.next);
    if !holds && following.refinements < MOST_REFINEMENTS {
        tracer.system.count("cutbacks", 1);
        following.refinements += 1;
        return StepEnd::CutBack(following.length * accuracy.clamp(0.25, 0.7));
    }
    following.refinements = 0;
    let (direction, next) = (following.direction, &trial.next);
    let Some(tangent) = tangent_at(&mut tracer.system, &tracer.state, next, &trial.control) else {
        return cut_back(tracer, following, "the state has no rate", None);
    };
    let unit = tracer.system.units().factor;
    let gained = next.factor - tracer.state.factor;
    let tangent = match trial.control {
        Control::Factor(_) => tangent.scaled(direction),
        _ => dissipating_sense(tracer, next, tangent),
    };
    let fell = gained * direction < -1e-10 * next.factor.abs().max(unit * 1e-3);
    let falls = tangent.factor * direction < -1e-10 * unit * motion_size(&tracer.system, &tangent);
    let softens = !tracer.system.laws.responses.is_empty();
    if (fell || falls) && softens && !tracer.strategy.passes_limit_points() {
        return cut_back(tracer, following, "the load falls in the step", Some(&tangent));
    }
    let falls = fell || (falls && following.slope > 0.0);
    let peak = falls && !softens && !trial.reaches && tracer.limit.peak.is_none();
    let step = Step { trial, tangent, accuracy, falls };
    if peak { StepEnd::Peak(step) } else { StepEnd::Accepted(step) }
}

/// Shortens a step that converged and is none along the path, or ends the path where it is too short for that; with the
/// rate at its end, if that is what is wrong.
fn cut_back(tracer: &mut Tracer, following: &mut Following, why: &str, end: Option<&Tangent>) -> StepEnd {
    tracer.system.count("cutbacks", 1);
    let length = 0.3 * following.length;
    if length < SHORTEST * following.limits.first {
        let rate = end.unwrap_or(&following.branch.tangent).clone();
        return StepEnd::Ended(no_step(tracer, &StepFailure::new(why), &rate, following.direction));
    }
    StepEnd::CutBack(length)
}

/// Over a peak: along another branch if one rises from it, else on.
fn pass_peak(tracer: &mut Tracer, following: &mut Following, step: Step) -> Option<LoadStepEnding> {
    let (state, beyond) = locate_peak(tracer, following, following.direction);
    if let Some((tangent, modes)) = rising_branch(tracer, &state, following.direction) {
        // Newton's method went over to a falling branch while another one rises.
        if !commit(tracer, state) {
            return Some(LoadStepEnding::Ended);
        }
        following.switch_to(Branch { tangent, modes: Some(modes) });
        return None;
    }
    let peak = peak_at(tracer, state, &beyond);
    note_proven_peak(tracer, peak, following.direction);
    accept(tracer, following, step)
}

/// Takes a step over; how the load step ends with it, if so.
fn accept(tracer: &mut Tracer, following: &mut Following, step: Step) -> Option<LoadStepEnding> {
    let Step { trial: Trial { next, iterations, reaches, .. }, tangent, accuracy, falls } = step;
    let (direction, target) = (following.direction, following.target);
    softening_peak(tracer, &next, falls, direction);
    note_plateau(tracer, &next, &tangent);
    following.slope = tangent.factor * direction;
    let increment = increment_between(&tracer.system, &tracer.state, &next);
    let changes = (0..next.mode.len()).filter(|c| next.mode[*c] != tracer.state.mode[*c]).count();
    // The same share of the joints, whatever their number.
    let changes = changes * ORDINARY / next.mode.len().max(ORDINARY);
    let softening = branch_changes(&tracer.system, &tracer.state, &next);
    let (whole, moves) = (next.mode == tracer.state.mode, following.length > CORNER * following.limits.first);
    following.tried.note(&next, &tangent, whole, moves);
    if !commit(tracer, next) {
        return Some(LoadStepEnding::Ended);
    }
    if reaches {
        if tracer.limit.peak.is_some() {
            tracer.record.notes.push(format!("after a limit point the path came back to the factor {target}"));
        }
        return Some(LoadStepEnding::Reached);
    }
    following.branch = Branch { tangent, modes: None };
    if !tracer.state.yields() && ends_in_ray(tracer, &following.branch.tangent, direction, target) {
        return Some(LoadStepEnding::Ended);
    }
    if stops(tracer, following.load_step, direction) {
        return Some(LoadStepEnding::Ended);
    }
    let growth = match (changes, iterations) {
        (0, 0..=5) if softening > 0 => 1.5,
        (0, 0..=6) => 2.0,
        (0..=2, 0..=6) => 1.5,
        (_, 0..=12) => 1.0,
        _ => 0.5,
    };
    following.previous = Some(increment);
    let taken = tracer.strategy.constraint(&increment, following.previous.as_ref()).value;
    following.length = accuracy.clamp(0.25, growth) * taken;
    None
}

/// The end of a path that takes too many steps.
fn out_of_work(tracer: &mut Tracer) -> LoadStepEnding {
    let factor = tracer.state.factor;
    let why = format!(
        "{MOST_STEPS} steps were not enough; the last state is at factor {factor}: larger steps (continuation, first_step) may pass"
    );
    end_path(tracer, Status::Stalled, why)
}
