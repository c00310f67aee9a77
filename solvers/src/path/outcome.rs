//! How a path ends: a status with the factor, mechanism or ray that it claims. The answer is checked again before
//! it is given away ([`self_check`](super::self_check)).

use super::self_check::confirmed;
use voussoir_core::limit::{Counters, Status};
use voussoir_core::path::{
    Branching, LimitPointEnd, PathAnswer, PathEvent, PathProblem, PathState, ProvenPeak, StageStability, Witness,
};

/// A status with what it claims.
#[derive(Debug, Clone)]
pub(super) struct Outcome {
    pub status: Status,
    pub factor: Option<f64>,
    /// Velocities of a mechanism with p·q̇ = 1.
    pub motion: Option<Vec<[f64; 3]>>,
    /// Rates of contact forces that carry any load.
    pub ray: Option<Vec<[f64; 2]>>,
    /// Whether the mechanism is the only one, where that was examined.
    pub unique: Option<bool>,
    /// The reason why the path ends at a limit point, if the question does not give it.
    pub limit_point_end: Option<LimitPointEnd>,
}

/// What a path leaves behind, whatever its end.
#[derive(Debug, Clone, Default)]
pub(super) struct PathRecord {
    pub load_step: usize,
    /// The state that the status speaks of.
    pub state: PathState,
    /// The last one, where the path went on beyond it.
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
    /// A status that claims a factor, or none.
    pub fn at(status: Status, factor: Option<f64>) -> Self {
        Outcome { status, factor, motion: None, ray: None, unique: None, limit_point_end: None }
    }

    /// With a mechanism, where there is one.
    pub fn moving(self, motion: Option<Vec<[f64; 3]>>) -> Self {
        Outcome { motion, ..self }
    }

    /// With a ray, where there is one.
    pub fn carried_by(self, ray: Option<Vec<[f64; 2]>>) -> Self {
        Outcome { ray, ..self }
    }

    /// The answer, its claim checked again: a stall where it is not confirmed.
    pub fn answer(self, problem: &PathProblem, finite: bool, record: PathRecord) -> PathAnswer {
        confirmed(problem, finite, self.unconfirmed(record))
    }

    /// The answer as it is: for paths whose end cannot be checked without what came before.
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
            notes,
        }
    }
}

/// An answer that says only why there is none.
pub(super) fn stalled(problem: &PathProblem, why: String) -> PathAnswer {
    let record = PathRecord { notes: vec![why], ..PathRecord::default() };
    Outcome::at(Status::Stalled, None).answer(problem, false, record)
}
