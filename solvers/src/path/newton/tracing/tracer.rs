//! The state of a trace: the last converged state, what is recorded of the path, and how it ended.

use crate::path::energy::{EnergyBalance, StageBalance, WorkState};
use crate::path::newton::model::derivatives::Gradient;
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::recorded::{energy_after, work_state};
use crate::settings::SETTINGS;
use std::sync::Arc;
use voussoir_core::limit::Status;
use voussoir_core::path::{
    Branching, Continuation, LimitPointEnd, LoadStepEnd, PathEvent, PathObserver, PathSettings, PathState, ProvenPeak,
    StageStability, Witness,
};

/// How a load step ended.
pub enum LoadStepEnding {
    /// At its factor.
    Reached,
    /// The path ends here.
    Ended,
}

/// A peak or limit point.
pub struct Peak {
    pub state: PathState,
    pub factor: f64,
    pub motion: Option<Vec<[f64; 3]>>,
}

/// What is written down of a path.
pub struct Record {
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
    pub witnesses: Vec<Witness>,
}

/// How a path ends.
pub struct Ending {
    pub status: Status,
    pub motion: Option<Vec<[f64; 3]>>,
    pub ray: Option<Vec<[f64; 2]>>,
    /// Why it ends at a limit point, if the question does not give the reason.
    pub limit_point_end: Option<LimitPointEnd>,
}

/// The greatest limit point, with small displacements the first, and what is known of it.
#[derive(Default)]
pub struct LimitPoint {
    pub peak: Option<Peak>,
    /// Proven peaks of finite displacements in order.
    pub proven_peaks: Vec<ProvenPeak>,
    /// Why it is not proven to be one.
    pub unproven: Option<String>,
    /// Factor at which it is proven that no rate has growing λ.
    pub proven: Option<f64>,
    /// The least load since the last limit point.
    pub trough: Option<Peak>,
}

/// The load step that is followed.
pub struct InForce {
    pub load_step: usize,
    pub strategy: Arc<dyn Continuation>,
}

/// A trace of a path.
pub struct Tracer<'a, 'o> {
    pub system: StepSystem<'a>,
    pub settings: &'a PathSettings,
    pub observer: &'o mut dyn PathObserver,
    pub in_force: InForce,
    /// The last converged state.
    pub state: State,
    pub record: Record,
    pub ending: Ending,
    pub limit: LimitPoint,
}

/// Energies at the end of a step from the last state, and what the next one needs of it.
pub fn foreseen(tracer: &Tracer, state: &State, gradient: &Gradient) -> (EnergyBalance, WorkState) {
    let work = work_state(&tracer.system, state, gradient);
    let start = (&tracer.state, &tracer.record.work);
    (energy_after(tracer.record.energy, &tracer.system, start, (state, &work)), work)
}

/// Ends the path with a status.
pub fn end_path(tracer: &mut Tracer, status: Status, note: String) -> LoadStepEnding {
    tracer.ending.status = status;
    if !note.is_empty() {
        tracer.record.notes.push(note);
    }
    LoadStepEnding::Ended
}

/// Whether the load is above the peak, by more than rounding.
pub fn is_above(direction: f64, peak: f64, load: f64) -> bool {
    (load - peak) * direction > SETTINGS.admissible * peak.abs()
}

/// Sense in which the factor of the present load step is to grow.
pub fn direction(tracer: &Tracer) -> f64 {
    let load_step = &tracer.system.problem.load_steps[tracer.in_force.load_step];
    let (LoadStepEnd::Factor(target) | LoadStepEnd::Collapse(target)) = load_step.end;
    if target < load_step.start { -1.0 } else { 1.0 }
}
