//! What is asked of a limit solver, and what it answers.

use super::lower_proof::{BracketPoint, LowerProof};
use super::problem::{JointForce, LimitProblem, Velocity};
use crate::law::FlowRule;
use crate::model::Wrenches;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::fmt::Debug;

/// What is asked of a limit solver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LimitQuestion {
    /// Is there an admissible field at this factor?
    Admissible(f64),
    /// From an admissible state at `start`, what is the greatest factor, searched up to `max`?
    Collapse {
        /// Where the search starts.
        start: f64,
        /// Where it ends (may be ∞).
        max: f64,
    },
}

/// The end of a stage. The certificate decides it; the status in a solver's answer is a hint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Status {
    /// The structure carries the target of the stage: an admissible state at the target proves it.
    Stands,
    /// The structure collapses at a factor that both bounds enclose.
    Collapse,
    /// The structure carries any factor: a ray proves it.
    Unbounded,
    /// The loads present before the stage begins cannot be carried: a motion proves it.
    NoEquilibrium,
    /// A proved maximum of the stage's parameter, at which the path ends.
    LimitPoint,
    /// A number is proved, but not the statement that was asked for: `bounds` holds the proved ends.
    Open,
    /// No claim is proved; the notes give the reason.
    Stalled,
}

impl Status {
    /// Returns true if the status is neither open nor stalled.
    pub fn is_answer(self) -> bool {
        !matches!(self, Status::Open | Status::Stalled)
    }
}

/// The proof of the greatest factor of the last stage (of the least one if joints have their own flow).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Greatest {
    /// A lower and an upper bound meet, or a proof shows that there is no such factor.
    ProvedOptimal,
    /// Both bounds of a least load are proved and differ.
    Bracketed,
    /// It is the greatest factor of a path within the range that was followed.
    ProvedOnThePath,
    /// At least one end is not proved.
    #[default]
    Open,
}

/// Counts of work done.
pub type Counters = BTreeMap<String, u64>;

/// A limit solver's answer for one stage.
#[derive(Debug, Clone)]
pub struct LimitAnswer {
    /// How it ends.
    pub status: Status,
    /// The collapse factor.
    pub factor: Option<f64>,
    /// The factor at which `field` is in equilibrium.
    pub field_factor: f64,
    /// One entry per joint of the problem.
    pub field: Option<Vec<JointForce>>,
    /// A field in equilibrium at the start of a search for collapse, one entry per joint of the problem. Without it the
    /// solver is asked whether the start is admissible.
    pub start_field: Option<Vec<JointForce>>,
    /// One entry per group, about the problem's pole; scaled to varying·q̇ = 1, for `NoEquilibrium`
    /// with a feasible interval to ±1, without one in any scale.
    pub motion: Option<Vec<Velocity>>,
    /// Is the motion the only one?
    pub unique: Option<bool>,
    /// One entry per joint of the problem.
    pub ray: Option<Vec<JointForce>>,
    /// All factors with an admissible field, where that interval leaves out the start.
    pub feasible_interval: Option<[f64; 2]>,
    /// Set where joints were read with their laws' own flow.
    pub non_associated: Option<NonAssociated>,
    /// Work done.
    pub counters: Counters,
    /// What a user should know.
    pub notes: Vec<String>,
}

/// What comes with an answer that reads each joint with its law's own flow. With non-associated
/// flow the factor is not unique: `factor` of the answer is one at which the law's own mechanism
/// and field exist together.
#[derive(Debug, Clone, Default)]
pub struct NonAssociated {
    /// No such factor is less than this.
    pub proved_lower: Option<f64>,
    /// What that rests on.
    pub lower_proof: Option<LowerProof>,
    /// How the bracket closed, where it did not at once.
    pub bracket: Vec<BracketPoint>,
    /// The greatest factor of associated flow, above which nothing can be.
    pub associated_factor: Option<f64>,
    /// Its mechanism, scaled as `motion`, which bounds it from above.
    pub associated_motion: Option<Vec<Velocity>>,
    /// Its field, one entry per joint of the problem, which bounds it from below.
    pub associated_field: Option<Vec<JointForce>>,
}

/// How rigid blocks follow supports that move.
#[derive(Debug, Clone)]
pub enum SettlementAnswer {
    /// They do.
    Follows {
        /// One entry per joint of the problem.
        field: Vec<JointForce>,
        /// Displacement of each group, about the problem's pole \[m, rad\].
        motion: Vec<Velocity>,
        /// Whether it is the only one.
        unique: Option<bool>,
        /// How joints were read.
        flow: FlowRule,
    },
    /// No motion goes with that of the supports: forces in balance without loads that do no work against any flow of the
    /// joints, and do work against the supports. One entry per joint of the problem.
    Blocked(Vec<JointForce>),
    /// Not decided, and why.
    Refused(String),
}

/// A way to do limit analysis, chosen by `[solver] solver = …`.
#[typetag::serde(tag = "solver")]
pub trait LimitSolver: Debug + Send + Sync {
    /// Answers the question. Never panics; what cannot be proven is `Stalled` with its reason.
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer;

    /// Why this solver cannot take this problem, if so.
    fn refuses(&self, problem: &LimitProblem) -> Option<String>;

    /// How rigid blocks follow supports that move, small displacements: of all motions q with the given `openings` of
    /// both ends and slip \[m\] that the supports alone would cause at each joint, those of least potential energy
    /// −w·q + Σ bᵢγᵢ under the loads w of each group about the pole; the dual is the field. Joints are read with
    /// associated flow; where no motion goes with that, or the solver takes laws as they are, the answer is a state of the laws' own flow.
    fn settle(&self, _: &LimitProblem, _: &Wrenches, _: &[[f64; 3]]) -> SettlementAnswer {
        SettlementAnswer::Refused("this solver knows loads only, no supports that move".into())
    }
}
