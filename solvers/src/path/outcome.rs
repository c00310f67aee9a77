//! The end of a path: a status with its claimed factor, mechanism or ray. The answer is checked again before it is
//! returned ([`self_check`](super::self_check)).

use super::self_check::confirmed;
use voussoir_core::limit::{Counters, Status};
use voussoir_core::path::{
    Branching, LimitPointEnd, PathAnswer, PathEvent, PathProblem, PathState, ProvenPeak, StageStability, Witness,
};

/// A status with its claims.
#[derive(Debug, Clone)]
pub(super) struct Outcome {
    pub status: Status,
    pub factor: Option<f64>,
    /// Velocities of a mechanism with p·q̇ = 1.
    pub motion: Option<Vec<[f64; 3]>>,
    /// Rates of contact forces that carry any amount of the load.
    pub ray: Option<Vec<[f64; 2]>>,
    /// True if the mechanism is the only one; `None` if that was not examined.
    pub unique: Option<bool>,
    /// The reason why the path ends at a limit point, if the question does not give it.
    pub limit_point_end: Option<LimitPointEnd>,
}

/// The record of a path, whatever its end.
#[derive(Debug, Clone, Default)]
pub(super) struct PathRecord {
    pub load_step: usize,
    /// The state of the status.
    pub state: PathState,
    /// The last state, if the path continued beyond it.
    pub last: Option<PathState>,
    pub events: Vec<PathEvent>,
    pub limit_points: Vec<ProvenPeak>,
    pub stability: Vec<StageStability>,
    pub branchings: Vec<Branching>,
    pub witnesses: Vec<Witness>,
    pub counters: Counters,
    pub notes: Vec<String>,
}

impl Outcome {
    /// Creates an outcome with a status and a factor, if it claims one.
    pub fn at(status: Status, factor: Option<f64>) -> Self {
        Outcome { status, factor, motion: None, ray: None, unique: None, limit_point_end: None }
    }

    /// Adds a mechanism, if there is one.
    pub fn moving(self, motion: Option<Vec<[f64; 3]>>) -> Self {
        Outcome { motion, ..self }
    }

    /// Adds a ray, if there is one.
    pub fn carried_by(self, ray: Option<Vec<[f64; 2]>>) -> Self {
        Outcome { ray, ..self }
    }

    /// Returns the answer after its claim is checked again; a stall if it is not confirmed.
    pub fn answer(self, problem: &PathProblem, finite: bool, record: PathRecord) -> PathAnswer {
        confirmed(problem, finite, self.unconfirmed(record))
    }

    /// Returns the unchecked answer, for paths whose end cannot be checked without the earlier path.
    pub fn unconfirmed(self, record: PathRecord) -> PathAnswer {
        let Outcome { status, factor, motion, ray, unique, limit_point_end } = self;
        let PathRecord {
            load_step,
            state,
            last,
            events,
            limit_points,
            stability,
            branchings,
            witnesses,
            counters,
            notes,
        } = record;
        PathAnswer {
            status,
            load_step,
            factor,
            state,
            last,
            motion,
            unique,
            limit_points,
            limit_point_end,
            stability,
            branchings,
            ray,
            events,
            witnesses,
            counters,
            outputs: Default::default(),
            notes,
        }
    }
}

/// Returns an answer with only the reason why there is no result.
pub(super) fn stalled(problem: &PathProblem, why: String) -> PathAnswer {
    let record = PathRecord { notes: vec![why], ..PathRecord::default() };
    Outcome::at(Status::Stalled, None).answer(problem, false, record)
}
