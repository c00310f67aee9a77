//! Following a load step by its strategy, as a state machine: a step ends as accepted, cut back, at a corner, over a
//! peak, or the path ends.

use super::control::Control;
use super::failed_step::{AfterFailure, CORNER, SHORTEST, after_failure, searched_here};
use super::following::{Branch, Following, per_tangent};
use super::limit_point::rising_branch;
use super::measure::{increment_between, motion_size};
use super::orientation::Orientation;
use super::passed_over::passes_over;
use super::peak::{Bracketed, locate_peak, note_peak, note_proven_peak, note_trough, peak_at};
use super::plastic_plateau::note_plateau;
use super::response::branch_changes;
use super::slip_history::{missed_slip, plainly_missed_slip};
use super::softening::{dissipating_sense, softening_peak};
use super::stable_branch::{Departure, leave_unstable};
use super::state::Tangent;
use super::step_energy::{MOST_REFINEMENTS, StepEnergy, step_energy};
use super::system::StepFailure;
use super::tangent::{modes_ahead, tangent_at};
use super::termination::{ends_in_ray, no_step, snaps, stops};
use super::tracer::{LoadStepEnding, Tracer, after_peak, commit, end_path, moved};
use super::trial::{StepPlan, Trial, attempt, plan};
use crate::contact::mode::ContactMode;
use voussoir_core::limit::Status;
use voussoir_core::path::{Branching, LoadStep};

/// Greatest number of steps of a load step, those that are tried in vain or taken back among them.
const MOST_STEPS: u64 = 6000;

/// Newton's iterations and evaluations of laws of a load step with finite displacements beyond both of which it ends: some
/// twenty seconds. Steps of most paths take four iterations.
const MOST_WORK: [u64; 2] = [100_000, 20_000_000];

/// Contact points up to which every change of mode counts for the length of the next step; of more the
/// same share does, so that the number of steps does not grow with the number of joints.
const ORDINARY: usize = 200;

/// Length, relative to the first step, at which a bifurcation is passed.
const PINNED: f64 = 1e-3;

/// Share of a settlement by which it goes on beyond a limit point from which it snaps.
const SNAP: f64 = 1e-7;

/// Jump of λ in a step that is not one along a path with finite displacements, as a share of λ.
const JUMP: f64 = 1e-4;

/// A converged step along the path.
struct Step {
    trial: Trial,
    /// The tangent at its end, in the sense in which the path goes on.
    tangent: Tangent,
    /// By how much the next step may be longer for the sake of its energy.
    accuracy: f64,
    /// Whether the load passes a peak in it.
    falls: bool,
    /// Whether the path folds back sharply in it.
    folded: bool,
    orientation: Option<Orientation>,
    plan: StepPlan,
}

/// How a step ends.
enum StepEnd {
    Accepted(Step),
    /// The load passes a peak in it, where the flow is associated and displacements are small the first.
    Peak(Step),
    /// It ends in an unstable equilibrium, from which other branches lead.
    Unstable(Step),
    /// To be tried again with this length.
    CutBack(f64),
    /// The path goes on along another branch.
    Corner(Branch),
    /// A settlement goes no further by itself.
    Snap(Tangent),
    Ended(LoadStepEnding),
}

/// By the strategy, up to a factor or the end of the path.
pub(super) fn follow(tracer: &mut Tracer, load_step: &LoadStep, target: f64) -> LoadStepEnding {
    let mut following = match Following::begin(tracer, load_step, target) {
        Ok(following) => following,
        Err(outcome) => return outcome,
    };
    let work = |tracer: &Tracer| {
        ["newton_iterations", "law_evaluations"].map(|name| tracer.system.counters.get(name).copied().unwrap_or(0))
    };
    let before = work(tracer);
    for _ in 0..MOST_STEPS {
        let now = work(tracer);
        if tracer.system.finite() && (0..2).all(|k| now[k] - before[k] > MOST_WORK[k]) {
            return out_of_work(tracer, &format!("{} iterations", now[0] - before[0]));
        }
        let end = next_step(tracer, &mut following);
        if let Some(outcome) = go_on(tracer, &mut following, end) {
            return outcome;
        }
        let ends = following.limits.ends_at_peak || tracer.settings.ends_at_first_limit_point(load_step.stage);
        if ends && tracer.limit.peak.is_some() {
            return end_path(tracer, Status::LimitPoint, String::new());
        }
    }
    out_of_work(tracer, &format!("{MOST_STEPS} steps"))
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
            let here = tracer.state.clone();
            following.switch_to(&mut tracer.system, &here, branch);
            None
        }
        StepEnd::Snap(beyond) => {
            let orientation = Orientation::of(&mut tracer.system, &tracer.state.clone(), true);
            snap(tracer, following, orientation, &beyond)
        }
        StepEnd::Unstable(step) => leave(tracer, following, step),
        StepEnd::Ended(outcome) => Some(outcome),
    }
}

/// Tries one step.
fn next_step(tracer: &mut Tracer, following: &mut Following) -> StepEnd {
    let Some(plan) = plan(tracer, following) else { return strategy_stopped(tracer, following) };
    match attempt(tracer, following, &plan) {
        Ok(trial) => examine(tracer, following, &plan, trial),
        Err(failure) => failed(tracer, following, &plan, &failure),
    }
}

/// What follows a step that did not converge, or is none along the path.
fn failed(tracer: &mut Tracer, following: &mut Following, plan: &StepPlan, failure: &StepFailure) -> StepEnd {
    match after_failure(tracer, following, plan, failure) {
        AfterFailure::CutBack(length) => StepEnd::CutBack(length),
        AfterFailure::Corner(branch) => StepEnd::Corner(branch),
        AfterFailure::Snap(beyond) => StepEnd::Snap(beyond),
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
    lost(tracer, following, "what the continuation strategy controls stopped changing", &rate)
}

/// What follows where a strategy has lost the path: arc lengths, if they may follow on, else the path ends.
fn lost(tracer: &mut Tracer, following: &mut Following, why: &str, rate: &Tangent) -> StepEnd {
    if following.takes_arc_lengths(tracer) {
        return StepEnd::CutBack(following.length);
    }
    StepEnd::Ended(no_step(tracer, &StepFailure::new(why), rate, following.direction))
}

/// How far a gain of λ is from those of a path whose rates at both ends of the step would give `before` and
/// `after`: a strategy that cannot turn back may step over a snap-back.
fn jump(before: f64, after: f64, gained: f64) -> f64 {
    let [low, high] = [before.min(after), before.max(after)];
    let slack = 0.5 * (high - low) + 0.5 * before.abs().max(after.abs());
    (low - slack - gained).max(gained - high - slack)
}

/// Whether a converged step is accurate, has a tangent, and is no jump to another branch.
fn examine(tracer: &mut Tracer, following: &mut Following, plan: &StepPlan, trial: Trial) -> StepEnd {
    let StepEnergy { growth: accuracy, holds } = step_energy(tracer, &trial.next);
    if !holds && following.refinements < MOST_REFINEMENTS {
        tracer.system.count("cutbacks", 1);
        following.refinements += 1;
        return StepEnd::CutBack(following.length * accuracy.clamp(0.25, 0.7));
    }
    following.refinements = 0;
    if let Some(shorter) = plainly_missed_slip(tracer, following, plan, &trial) {
        return StepEnd::CutBack(shorter);
    }
    let (direction, rate, next) = (following.direction, &following.branch.tangent, &trial.next);
    let Some(tangent) = tangent_at(&mut tracer.system, &tracer.state, next, &trial.control) else {
        return cut_back(tracer, following, "the state has no rate", None);
    };
    let (unit, finite) = (tracer.system.units().factor, tracer.system.finite());
    let gained = next.factor - tracer.state.factor;
    let [before, after] = [rate.factor / plan.per_tangent, tangent.factor].map(|slope| slope * following.length);
    let off = jump(before, after, gained);
    let by_strategy = matches!(trial.control, Control::Strategy { .. });
    let jumps = by_strategy && finite && off > JUMP * next.factor.abs().max(unit);
    let tangent = match trial.control {
        Control::Factor(_) => tangent.scaled(direction),
        _ => dissipating_sense(tracer, next, tangent),
    };
    if let Some(shorter) = missed_slip(tracer, following, plan, &trial, &tangent) {
        return StepEnd::CutBack(shorter);
    }
    let hidden =
        by_strategy.then(|| passes_over(tracer, following, plan, (&trial, &tangent), [before, after])).flatten();
    if let Some(shorter) = hidden {
        tracer.system.count("passed_over", 1);
        return StepEnd::CutBack(shorter);
    }
    if jumps {
        return cut_back(tracer, following, "the state jumps to another branch", None);
    }
    let folded = folds_back(tracer, following, &trial, &tangent);
    let tangent = if folded { tangent.scaled(-1.0) } else { tangent };
    let fell = gained * direction < -1e-10 * trial.next.factor.abs().max(unit * 1e-3);
    let still = 1e-10 * unit * motion_size(&tracer.system, &tangent);
    // With finite displacements a load that stands still is a limit point: what slides on a plane
    // does so under the same load for ever.
    let falls = tangent.factor * direction < if finite { still } else { -still };
    let softens = !tracer.system.laws.responses.is_empty();
    if (fell || falls) && softens && !tracer.strategy.passes_limit_points() {
        return cut_back(tracer, following, "the load falls in the step", Some(&tangent));
    }
    let falls = fell || (falls && following.slope > 0.0);
    let orientation = Orientation::along(&mut tracer.system, &trial.next, &tangent, direction);
    let first = tracer.limit.peak.is_none();
    let grew = following.slope > 0.0 && following.orientation.as_ref().is_none_or(|before| !before.still);
    let peak = falls && !softens && !trial.reaches && (first || (finite && grew));
    let step = Step { trial, tangent, accuracy, falls, folded, orientation, plan: *plan };
    if let Some(other) = off_the_branch(tracer, following, plan, &step) {
        return other;
    }
    match &step.orientation {
        Some(orientation) if orientation.unstable && beyond_all_peaks(tracer, following, &step) => {
            StepEnd::Unstable(step)
        }
        _ if peak => StepEnd::Peak(step),
        _ => StepEnd::Accepted(step),
    }
}

/// Whether a step over a sharp fold ended before the fold on the branch beyond it, so that what its strategy measures
/// grows towards the fold: a rate in that sense soon asks for the modes before it, and by second-order work the path
/// goes on in the other one.
fn folds_back(tracer: &mut Tracer, following: &Following, trial: &Trial, tangent: &Tangent) -> bool {
    let (short, next) = (following.length < PINNED * following.limits.first, &trial.next);
    if !short || !tracer.system.finite() || next.mode == tracer.state.mode {
        return false;
    }
    let after = Orientation::along(&mut tracer.system, next, tangent, following.direction);
    let (Some(before), Some(after)) = (&following.orientation, after) else { return false };
    if [before, &after].iter().any(|side| side.is_singular()) || !before.leads_over_kink_to(&after.reversed()) {
        return false;
    }
    let per_tangent = per_tangent(tracer, tangent, None);
    let [near, far] = [1.0, 10.0].map(|lengths| moved(next, tangent, lengths * following.length / per_tangent));
    let reverts = [near, far].iter().any(|ahead| modes_ahead(&mut tracer.system, next, ahead) == tracer.state.mode);
    tracer.system.count("sharp_folds", u64::from(reverts));
    reverts
}

/// Whether the load at the end of a step is above all peaks of its load step: below them what is followed is the
/// post-peak branch, stable or not.
fn beyond_all_peaks(tracer: &Tracer, following: &Following, step: &Step) -> bool {
    let own = tracer.limit.proven_peaks.iter().filter(|peak| peak.load_step == tracer.load_step);
    own.map(|peak| (step.trial.next.factor - peak.factor) * following.direction).all(|above| above > 0.0)
}

/// What follows a step whose end does not lie on the branch of its start, by their second-order work: a shorter one. At
/// the shortest a step that turns back has failed; a bifurcation is passed.
fn off_the_branch(tracer: &mut Tracer, following: &mut Following, plan: &StepPlan, step: &Step) -> Option<StepEnd> {
    let (before, after) = (following.orientation.as_ref()?, step.orientation.as_ref()?);
    if before.leads_to(after) || before.is_singular() || after.is_singular() {
        return None;
    }
    let pinned = following.length < PINNED * following.limits.first;
    let kinked = step.trial.next.mode != tracer.state.mode;
    if pinned && kinked && before.leads_over_kink_to(after) {
        return None;
    }
    // Where flow is not associated the path turns at a kink to one of its rates; else energy decides.
    let turns =
        kinked && !after.unstable && !tracer.system.joints_flow_associated() && tracer.system.piecewise_linear();
    let unsearched = turns && !searched_here(tracer, following);
    if before.rises == after.rises && pinned && !unsearched {
        note_bifurcation(tracer, before, after, step.trial.next.factor);
        return None;
    }
    tracer.system.count("off_the_branch", 1);
    let corner = turns && following.length <= CORNER * following.limits.first;
    Some(if before.rises == after.rises && !corner {
        StepEnd::CutBack(0.3 * following.length)
    } else {
        failed(tracer, following, plan, &StepFailure::new("the step turned back, or to another branch"))
    })
}

/// Names a bifurcation that is passed on a branch that stays stable under its loads: points that slide would stick on
/// the way to another one, which starts under growing loads only (Shanley 1947, J. Aeronaut. Sci. 14, 261-268).
fn note_bifurcation(tracer: &mut Tracer, before: &Orientation, after: &Orientation, factor: f64) {
    if after.rises && !after.unstable && after.work.turned > before.work.turned {
        let load_step = tracer.load_step;
        tracer.record.branchings.push(Branching { load_step, factor, snaps: false, released: 0.0, twins: false });
        tracer.record.notes.push(format!(
            "at factor {factor} another branch starts under growing load, on which points stop sliding; the one that is followed is stable under its loads"
        ));
    }
}

/// From an unstable equilibrium to the stable one that damped descent reaches.
fn leave(tracer: &mut Tracer, following: &mut Following, step: Step) -> Option<LoadStepEnding> {
    let Some(orientation) = step.orientation.clone() else { return accept(tracer, following, step) };
    let reaches = step.trial.reaches;
    if !commit(tracer, step.trial.next) {
        return Some(LoadStepEnding::Ended);
    }
    let state = tracer.state.clone();
    match leave_unstable(tracer, &state, &orientation.work, false) {
        Departure::Stopped => Some(LoadStepEnding::Ended),
        Departure::Stable if reaches => Some(LoadStepEnding::Reached),
        Departure::Stable => begin_anew(tracer, following),
        Departure::Falls if tracer.limit.peak.is_some() => {
            let factor = tracer.state.factor;
            let why = format!(
                "at factor {factor} the branch after the peak becomes unstable under its loads, and damped descent reaches no stable one"
            );
            let status = after_peak(tracer);
            Some(end_path(tracer, status, why))
        }
        Departure::Falls => {
            note_peak(tracer, &step.tangent, following.direction);
            let factor = tracer.state.factor;
            let why = format!(
                "at factor {factor} the equilibrium becomes unstable under its loads, and no stable one is near: the path ends here"
            );
            Some(end_path(tracer, Status::LimitPoint, why))
        }
    }
}

/// Follows the load step anew from the present state; how it ends there, if so.
fn begin_anew(tracer: &mut Tracer, following: &mut Following) -> Option<LoadStepEnding> {
    match Following::begin(tracer, following.load_step, following.target) {
        Ok(anew) => {
            *following = anew;
            None
        }
        Err(ending) => Some(ending),
    }
}

/// Shortens a step that converged and is none along the path, or ends the path where it is too short for that; with the
/// rate at its end, if that is what is wrong.
fn cut_back(tracer: &mut Tracer, following: &mut Following, why: &str, end: Option<&Tangent>) -> StepEnd {
    tracer.system.count("cutbacks", 1);
    let length = 0.3 * following.length;
    if length < SHORTEST * following.limits.first {
        let rate = end.unwrap_or(&following.branch.tangent).clone();
        return lost(tracer, following, why, &rate);
    }
    StepEnd::CutBack(length)
}

/// Over a peak: along another branch where one rises from it, else on. A settlement that goes no further by itself
/// snaps, where it is to go to a factor.
fn pass_peak(tracer: &mut Tracer, following: &mut Following, step: Step) -> Option<LoadStepEnding> {
    if step.folded && !snaps(tracer, following.load_step) {
        // As at a corner that no step passes.
        if following.comes_stable() {
            note_peak(tracer, &step.tangent, following.direction);
        }
        return accept(tracer, following, step);
    }
    let stable = following.comes_stable();
    let Bracketed { state, beyond, kinked } = match locate_peak(tracer, following, following.direction) {
        Some(bracketed) => bracketed,
        None => {
            let why = StepFailure::new("two converged states of one branch do not bracket the peak");
            let end = failed(tracer, following, &step.plan, &why);
            return go_on(tracer, following, end);
        }
    };
    // A rate in the modes in which the path has come is that on which it came, to the corner itself.
    let finite = tracer.system.finite();
    let another = |(_, modes): &(Tangent, Vec<ContactMode>)| !finite || *modes != state.mode;
    if kinked && let Some((tangent, modes)) = rising_branch(tracer, &state, following.direction).filter(another) {
        // Newton's method went over to a falling branch where another one rises.
        if !commit(tracer, state) {
            return Some(LoadStepEnding::Ended);
        }
        let here = tracer.state.clone();
        following.switch_to(&mut tracer.system, &here, Branch { tangent, modes: Some(modes) });
        return None;
    }
    if snaps(tracer, following.load_step) && step.orientation.is_some() {
        let orientation = Orientation::of(&mut tracer.system, &state, true);
        if !commit(tracer, state) {
            return Some(LoadStepEnding::Ended);
        }
        return snap(tracer, following, orientation, &beyond);
    }
    if stable {
        let peak = peak_at(tracer, state.clone(), &beyond);
        note_proven_peak(tracer, peak, following.direction);
    }
    if stable && following.limits.ends_at_peak {
        return (!commit(tracer, state)).then_some(LoadStepEnding::Ended);
    }
    accept(tracer, following, step)
}

/// Beyond a limit point of a settlement, the present state: to the equilibrium that damped descent reaches.
fn snap(
    tracer: &mut Tracer,
    following: &mut Following,
    orientation: Option<Orientation>,
    beyond: &Tangent,
) -> Option<LoadStepEnding> {
    let mut pushed = tracer.state.clone();
    pushed.factor += SNAP * (following.target - following.load_step.start);
    let departure = match &orientation {
        Some(orientation) => leave_unstable(tracer, &pushed, &orientation.work, true),
        None => Departure::Falls,
    };
    match departure {
        Departure::Stopped => Some(LoadStepEnding::Ended),
        Departure::Stable => begin_anew(tracer, following),
        Departure::Falls => {
            note_peak(tracer, beyond, following.direction);
            let factor = tracer.state.factor;
            let why = format!(
                "at factor {factor} no equilibrium follows as the settlement goes on, and damped descent reaches none: the path ends here"
            );
            Some(end_path(tracer, Status::LimitPoint, why))
        }
    }
}

/// Takes a step over; how the load step ends with it, if so.
fn accept(tracer: &mut Tracer, following: &mut Following, step: Step) -> Option<LoadStepEnding> {
    let Step { trial: Trial { next, iterations, reaches, .. }, tangent, accuracy, falls, orientation, .. } = step;
    let (direction, target, finite) = (following.direction, following.target, tracer.system.finite());
    let rises =
        tangent.factor * direction > 1e-10 * tracer.system.units().factor * motion_size(&tracer.system, &tangent);
    if finite && tracer.limit.peak.is_some() && following.slope < 0.0 && rises && !reaches {
        note_trough(tracer, following);
    }
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
    following.orientation = orientation;
    if reaches {
        if tracer.limit.peak.is_some() {
            tracer.record.notes.push(format!("after a limit point the path came back to the factor {target}"));
        }
        return Some(LoadStepEnding::Reached);
    }
    following.branch = Branch { tangent, modes: None };
    if !finite && !tracer.state.yields() && ends_in_ray(tracer, &following.branch.tangent, direction, target) {
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
    if let Some(arrest) = following.arrest {
        (following.arrest, following.length) = arrest.after(taken, following.length);
    }
    None
}

/// The end of a path that takes too many steps, or too many iterations.
fn out_of_work(tracer: &mut Tracer, work: &str) -> LoadStepEnding {
    // After a peak too a greater one may lie before the stop, unless the load has fallen to half, where paths end.
    let factor = tracer.state.factor;
    let status = if tracer.system.finite() { after_peak(tracer) } else { Status::Stalled };
    end_path(
        tracer,
        status,
        format!(
            "{work} were not enough; the last state is at factor {factor}: larger steps (continuation, first_step) or event_path may pass"
        ),
    )
}
