//! The end of a path: a status with its claimed factor, mechanism or ray. The answer is checked again before it is
//! returned ([`self_check`](super::self_check)).

use super::self_check::confirmed;
use voussoir_core::limit::Status;
use voussoir_core::path::{LimitPointEnd, PathAnswer, PathProblem};

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

    /// Returns the answer of a record of the path after its claim is checked again; a stall if it is not confirmed.
    pub fn answer(self, problem: &PathProblem, finite: bool, record: PathAnswer) -> PathAnswer {
        confirmed(problem, finite, self.unconfirmed(record))
    }

    /// Returns the unchecked answer, for paths whose end cannot be checked without the earlier path.
    pub fn unconfirmed(self, record: PathAnswer) -> PathAnswer {
        let Outcome { status, factor, motion, ray, unique, limit_point_end } = self;
        PathAnswer { status, factor, motion, ray, unique, limit_point_end, ..record }
    }
}
