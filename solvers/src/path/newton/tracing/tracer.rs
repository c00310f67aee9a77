//! The state of a trace: the last converged state, the record of the path, and its ending.

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

/// The ending of a load step.
pub enum LoadStepEnding {
    /// The load step has reached its factor.
    Reached,
    /// The path ends in this load step.
    Ended,
}

/// A peak or limit point.
pub struct Peak {
    pub state: PathState,
    pub factor: f64,
    pub motion: Option<Vec<[f64; 3]>>,
}

/// The record of a path.
pub struct Record {
    pub energy: EnergyBalance,
    /// The balance of the present stage.
    pub balance: StageBalance,
    /// Data of the last converged state for the work of the next step.
    pub work: WorkState,
    /// The last converged state for results.
    pub state: PathState,
    pub events: Vec<PathEvent>,
    pub notes: Vec<String>,
    pub stability: Vec<StageStability>,
    pub branchings: Vec<Branching>,
    pub witnesses: Vec<Witness>,
}

/// The end of a path.
pub struct Ending {
    pub status: Status,
    pub motion: Option<Vec<[f64; 3]>>,
    pub ray: Option<Vec<[f64; 2]>>,
    /// The reason of an end at a limit point, if the question does not give it.
    pub limit_point_end: Option<LimitPointEnd>,
}

/// The greatest limit point (with small displacements the first) and its proof.
#[derive(Default)]
pub struct LimitPoint {
    pub peak: Option<Peak>,
    /// Proven peaks with finite displacements, in order.
    pub proven_peaks: Vec<ProvenPeak>,
    /// The reason if it is not proven.
    pub unproven: Option<String>,
    /// Factor at which it is proven that no rate has growing λ.
    pub proven: Option<f64>,
    /// The least load since the last limit point.
    pub trough: Option<Peak>,
}

/// The present load step.
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

/// Returns the energies at the end of a step from the last state, and the data for the next step.
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

/// Returns true if the load is above the peak by more than rounding.
pub fn is_above(direction: f64, peak: f64, load: f64) -> bool {
    (load - peak) * direction > SETTINGS.admissible * peak.abs()
}

/// Returns the sense in which the factor of the present load step should grow.
pub fn direction(tracer: &Tracer) -> f64 {
    let load_step = &tracer.system.problem.load_steps[tracer.in_force.load_step];
    let (LoadStepEnd::Factor(target) | LoadStepEnd::Collapse(target)) = load_step.end;
    if target < load_step.start { -1.0 } else { 1.0 }
}
