//! The state of a trace: the last converged state, what is recorded of the path, and how it ended.

use super::derivatives::Gradient;
use super::events::events;
use super::recorded::{energy_after, recorded, work_state};
use super::second_order::stability;
use super::state::{State, Tangent};
use super::system::StepSystem;
use crate::path::energy::{EnergyBalance, StageBalance, WorkState, load_size};
use crate::path::stability::regains_limit_point;
use std::sync::Arc;
use voussoir_core::limit::Status;
use voussoir_core::path::{
    Branching, Contact, Continuation, LimitPointEnd, LoadStepEnd, PathEvent, PathObserver, PathSettings, PathState,
    ProvenPeak, StageStability,
};

/// Greatest contact force after a peak of finite displacements, by that at the peak, with which the blocks have
/// come apart: what is left is rounding.
const APART: f64 = 1e-6;
/// Rise of the load above a peak, relative to it, that is none of rounding.
const ABOVE: f64 = 1e-9;
/// Movement of the load point after a peak, as a share of the span, from which on a path may end.
pub(super) const MOVED_ON: f64 = 0.02;

/// How a load step ended.
pub(super) enum LoadStepEnding {
    /// At its factor.
    Reached,
    /// The path ends here.
    Ended,
}

/// A peak or limit point.
pub(super) struct Peak {
    pub state: PathState,
    pub factor: f64,
    pub motion: Option<Vec<[f64; 3]>>,
}

/// What is written down of a path.
pub(super) struct Record {
    pub energy: EnergyBalance,
    /// The balance of the present stage.
    pub balance: StageBalance,
    /// The last converged state as the work of the next step needs it.
    pub work: WorkState,
    /// The last converged state as others read it.
    pub state: PathState,
    pub events: Vec<PathEvent>,
    pub notes: Vec<String>,
    pub stability: Vec<StageStability>,
    pub branchings: Vec<Branching>,
}

/// How a path ends.
pub(super) struct Ending {
    pub status: Status,
    pub motion: Option<Vec<[f64; 3]>>,
    pub ray: Option<Vec<[f64; 2]>>,
    /// Why it ends at a limit point, if the question does not give the reason.
    pub limit_point_end: Option<LimitPointEnd>,
}

/// The greatest limit point, with small displacements the first, and what is known of it.
#[derive(Default)]
pub(super) struct LimitPoint {
    pub peak: Option<Peak>,
    /// Proven peaks of finite displacements in order.
    pub proven_peaks: Vec<ProvenPeak>,
    /// Why it is not proven to be one.
    pub unproven: Option<String>,
    /// Factor at which it is proven that no rate has growing λ.
    pub proven: Option<f64>,
    /// Factor at which a branch with growing λ was taken last, and how often there.
    pub rose: Option<(f64, u32)>,
}

/// The path after its peak.
#[derive(Default)]
pub(super) struct PostPeak {
    /// The least load since.
    pub trough: Option<Peak>,
    /// True if the load has fallen to half of the greatest one.
    pub far: bool,
}

/// A trace of a path.
pub(super) struct Tracer<'a, 'o> {
    pub system: StepSystem<'a>,
    pub settings: &'a PathSettings,
    pub strategy: Arc<dyn Continuation>,
    pub observer: &'o mut dyn PathObserver,
    pub load_step: usize,
    /// The last converged state.
    pub state: State,
    pub record: Record,
    pub ending: Ending,
    pub limit: LimitPoint,
    pub post_peak: PostPeak,
}

/// Takes a converged state as the next one. Whether to go on.
pub(super) fn commit(tracer: &mut Tracer, mut next: State) -> bool {
    let greatest = |force: &[[f64; 2]]| force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
    if tracer.system.finite()
        && let Some(peak) = &tracer.limit.peak
        && greatest(&next.force) <= APART * greatest(&peak.state.force)
    {
        end_path(
            tracer,
            Status::Collapse,
            "after the peak the blocks come apart: no forces are left between them".into(),
        );
        return false;
    }
    if !tracer.system.finite() {
        tracer.system.drop_rounding(&mut next, tracer.system.loads.start);
    }
    let gradient = tracer.system.gradient(&next);
    tracer.record.events.extend(events(&tracer.system, tracer.load_step, &tracer.state, &next));
    let (energy, work) = foreseen(tracer, &next, &gradient);
    tracer.record.energy = energy;
    let start = tracer.state.clone();
    tracer.system.keep(&start, &mut next);
    let mut seen = recorded(&tracer.record.energy, &tracer.system, tracer.load_step, &next, &gradient);
    if regains_limit_point(&tracer.limit.proven_peaks, tracer.load_step, [start.factor, next.factor]) {
        let settles = load_size(tracer.system.problem, tracer.system.loads.growing) == 0.0;
        seen.stable_under_load = stability(&mut tracer.system, &next, settles).under_load;
    }
    let (problem, finite) = (tracer.system.problem, tracer.system.finite());
    tracer.record.balance = tracer.record.balance.after(problem, finite, &tracer.record.state, &seen).0;
    tracer.record.state = seen;
    tracer.state = next;
    tracer.record.work = work;
    tracer.system.count("steps", 1);
    if !tracer.observer.state(tracer.system.problem, &tracer.record.state) {
        end_path(tracer, Status::Stalled, "stopped by the observer".into());
        return false;
    }
    if tracer.system.finite()
        && let Some((apart, why)) = left_its_pairing(tracer)
    {
        let status = after_slip(tracer, apart);
        end_path(tracer, status, why);
        return false;
    }
    true
}

/// Energies at the end of a step from the last state, and what the next one needs of it.
pub(super) fn foreseen(tracer: &Tracer, state: &State, gradient: &Gradient) -> (EnergyBalance, WorkState) {
    let work = work_state(&tracer.system, state, gradient);
    let start = (&tracer.state, &tracer.record.work);
    (energy_after(tracer.record.energy, &tracer.system, start, (state, &work)), work)
}

/// Ends the path with a status.
pub(super) fn end_path(tracer: &mut Tracer, status: Status, note: String) -> LoadStepEnding {
    tracer.ending.status = status;
    if !note.is_empty() {
        tracer.record.notes.push(note);
    }
    LoadStepEnding::Ended
}

/// How a path with finite displacements ends if a joint has slipped as far as its pairing holds: above its peaks more may
/// come; blocks that have left their faces, or share no more than half of them, are no structure any longer.
fn after_slip(tracer: &Tracer, apart: bool) -> Status {
    let peak = tracer.limit.peak.as_ref();
    let below = peak.is_some_and(|peak| !is_above(direction(tracer), peak.factor, tracer.state.factor));
    if below && (apart || tracer.post_peak.far) { Status::Collapse } else { Status::Stalled }
}

/// Whether the load is above the peak, by more than rounding.
pub(super) fn is_above(direction: f64, peak: f64, load: f64) -> bool {
    (load - peak) * direction > ABOVE * peak.abs()
}

/// Sense in which the factor of the present load step is to grow.
fn direction(tracer: &Tracer) -> f64 {
    let load_step = &tracer.system.problem.load_steps[tracer.load_step];
    let (LoadStepEnd::Factor(target) | LoadStepEnd::Collapse(target)) = load_step.end;
    if target < load_step.start { -1.0 } else { 1.0 }
}

/// A pressed point that has slipped further than its pairing holds: whether its blocks have come apart, and why.
fn left_its_pairing(tracer: &Tracer) -> Option<(bool, String)> {
    let largest = tracer.state.force.iter().flatten().map(|r| r.abs()).fold(0.0, f64::max);
    let points = tracer.system.problem.contacts.iter().zip(&tracer.state.force).zip(&tracer.state.gap);
    let mut pressed = points.filter(|((_, force), _)| force[0] > 1e-9 * largest);
    let ((c, _), gap) = pressed.find(|((c, _), gap)| !c.sliding.holds(gap[1]))?;
    Some(lost_joint(tracer, c, gap[1]))
}

/// Whether the blocks have come apart where a contact point has slipped as far as its pairing holds, and what has happened.
pub(super) fn lost_joint(tracer: &Tracer, contact: &Contact, slip: f64) -> (bool, String) {
    let (apart, why) = match contact.sliding.corners {
        [low, high] if low != high => (true, "it has lost half of its height"),
        [0.5, 0.5] if contact.sliding.passing == 0.0 => {
            (false, "a contact point away from all corners is paired for less")
        }
        [0.5, 0.5] => (true, "it has lost half of its height"),
        _ => (true, "its contact point leaves the face that it slides on"),
    };
    let (joint, factor) = (contact.joint, tracer.state.factor);
    (apart, format!("joint {joint} has slipped by {:.4e} m at factor {factor}: {why}", slip.abs()))
}

/// The present state a share of a rate on.
pub(super) fn moved_along(tracer: &Tracer, rate: &Tangent, share: f64) -> State {
    moved(&tracer.state, rate, share)
}

/// A state a share of a rate on.
pub(super) fn moved(state: &State, rate: &Tangent, share: f64) -> State {
    let mut guess = state.clone();
    for (r, dr) in guess.force.iter_mut().zip(&rate.force) {
        (0..2).for_each(|k| r[k] += share * dr[k]);
    }
    for (q, dq) in guess.motion.iter_mut().zip(&rate.motion) {
        (0..3).for_each(|k| q[k] += share * dq[k]);
    }
    guess.factor += share * rate.factor;
    guess
}
