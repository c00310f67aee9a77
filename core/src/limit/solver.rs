//! The question to a limit solver, and its answer.

use super::lower_proof::{BracketPoint, LowerProof};
use super::problem::{JointForce, LimitProblem, Velocity};
use super::space_answer::{SpaceAnswer, SpaceField, SpaceSettled};
use super::space_problem::SpaceProblem;
use super::status::{Counters, Status};
use crate::law::FlowRule;
use crate::model::Wrenches;
use std::collections::BTreeMap;
use std::fmt::Debug;

/// The question to a limit solver.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LimitQuestion {
    /// Does an admissible field exist at this factor?
    Admissible(f64),
    /// What is the greatest factor up to `max`, starting from an admissible state at `start`?
    Collapse {
        /// Factor at which the search starts.
        start: f64,
        /// Factor at which the search ends; may be ∞.
        max: f64,
    },
}

/// The answer of a limit solver for one stage. Create it with a constructor, such as [`LimitAnswer::collapse`], and set
/// the other fields afterwards: later versions may add fields.
#[derive(Debug, Clone, Default)]
pub struct LimitAnswer {
    /// The end of the stage.
    pub status: Status,
    /// The collapse factor.
    pub factor: Option<f64>,
    /// The factor at which `field` is in equilibrium.
    pub field_factor: f64,
    /// Forces of an admissible field, one entry per joint of the problem.
    pub field: Option<Vec<JointForce>>,
    /// A field in equilibrium at the start of a search for collapse, one entry per joint of the problem. Without it a
    /// second question asks the solver if the start is admissible.
    pub start_field: Option<Vec<JointForce>>,
    /// Velocities, one entry per group, about the problem's pole. They are scaled to varying·q̇ = 1; for
    /// `NoEquilibrium` with a feasible interval to ±1, without such an interval their scale is arbitrary.
    pub motion: Option<Vec<Velocity>>,
    /// True if the motion is the only one.
    pub unique: Option<bool>,
    /// Forces of a ray, one entry per joint of the problem.
    pub ray: Option<Vec<JointForce>>,
    /// All factors with an admissible field, if the start is not among them.
    pub feasible_interval: Option<[f64; 2]>,
    /// Set if each joint has the flow of its law.
    pub non_associated: Option<NonAssociated>,
    /// Work done.
    pub counters: Counters,
    /// Outputs that the card of the solver declares, by name.
    pub outputs: BTreeMap<String, f64>,
    /// Notes for the user.
    pub notes: Vec<String>,
}

impl LimitAnswer {
    /// Creates an answer that decides nothing, with the reason.
    pub fn stalled(why: impl Into<String>) -> Self {
        LimitAnswer::default().noting(why)
    }

    /// Creates the answer that the target of the stage is carried: a field at this factor.
    pub fn stands(field_factor: f64, field: Vec<JointForce>) -> Self {
        LimitAnswer { status: Status::Stands, field_factor, field: Some(field), ..LimitAnswer::default() }
    }

    /// Creates the answer that the structure collapses at a factor: a field at the factor, and a mechanism with
    /// varying·q̇ = 1.
    pub fn collapse(factor: f64, field: Vec<JointForce>, motion: Vec<Velocity>) -> Self {
        let stands = LimitAnswer::stands(factor, field);
        LimitAnswer { status: Status::Collapse, factor: Some(factor), motion: Some(motion), ..stands }
    }

    /// Creates the answer that the structure carries any factor: a field at one factor, and a ray of forces that
    /// balances the varying load alone.
    pub fn unbounded(field_factor: f64, field: Vec<JointForce>, ray: Vec<JointForce>) -> Self {
        LimitAnswer { status: Status::Unbounded, ray: Some(ray), ..LimitAnswer::stands(field_factor, field) }
    }

    /// Creates the answer that the loads at the start of the stage are not carried: a motion on which they do more work
    /// than is dissipated.
    pub fn no_equilibrium(motion: Vec<Velocity>) -> Self {
        LimitAnswer { status: Status::NoEquilibrium, motion: Some(motion), ..LimitAnswer::default() }
    }

    /// Adds a note for the user.
    pub fn noting(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }
}

/// Additional results if each joint has the flow of its own law. With non-associated flow the factor is not unique:
/// `factor` of the answer is a factor at which a mechanism with the laws' own flow and an admissible field exist
/// together.
#[derive(Debug, Clone, Default)]
pub struct NonAssociated {
    /// Proved lower bound of all such factors.
    pub proved_lower: Option<f64>,
    /// Proof of the lower bound.
    pub lower_proof: Option<LowerProof>,
    /// Steps in which the bracket became narrower, if it did not close at once.
    pub bracket: Vec<BracketPoint>,
    /// Collapse factor of associated flow, an upper bound of all such factors.
    pub associated_factor: Option<f64>,
    /// Mechanism of associated flow, scaled as `motion`; it proves the upper bound.
    pub associated_motion: Option<Vec<Velocity>>,
    /// Field of associated flow, one entry per joint of the problem; it proves the lower bound of the associated
    /// factor.
    pub associated_field: Option<Vec<JointForce>>,
}

/// Result of moving the supports of rigid blocks.
#[derive(Debug, Clone)]
pub enum SettlementAnswer {
    /// The blocks follow the supports.
    Follows {
        /// Forces, one entry per joint of the problem.
        field: Vec<JointForce>,
        /// Displacement of each group, about the problem's pole \[m, rad\].
        motion: Vec<Velocity>,
        /// True if the motion is the only one.
        unique: Option<bool>,
        /// Flow rule of the joints.
        flow: FlowRule,
    },
    /// No motion of the blocks is compatible with the motion of the supports. The proof is a set of forces in balance
    /// without loads, one entry per joint of the problem: they do no work on any flow of the joints, and positive work
    /// on the supports.
    Blocked(Vec<JointForce>),
    /// The question is not decided, with the reason.
    Refused(String),
}

/// A method of limit analysis, chosen by `[solver] solver = …`.
#[typetag::serde(tag = "solver")]
pub trait LimitSolver: Debug + Send + Sync {
    /// Answers the question without panic. If a claim cannot be proved, the status is `Stalled` and the notes give the
    /// reason.
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer;

    /// Returns the reason why this solver does not support this problem, or `None`.
    fn refuses(&self, problem: &LimitProblem) -> Option<String>;

    /// Answers the question for a scene in space, without panic. `None` if the solver knows plane scenes only.
    fn solve_space(&self, _: &SpaceProblem, _: LimitQuestion) -> Option<SpaceAnswer> {
        None
    }

    /// Finds the motion of rigid blocks in space whose supports move, with small displacements, under the fixed loads of the
    /// problem. `openings` are the gaps (n, s, t) \[m\] that the supports alone would cause at the inner points of each
    /// contact. The solver returns a motion q of least potential energy −w·q + D among all compatible motions with associated
    /// flow, and its dual field.
    fn settle_space(&self, _: &SpaceProblem, _: &SpaceField) -> SpaceSettled {
        SpaceSettled::Refused("this solver knows no supports in space that move".into())
    }

    /// Finds the motion of rigid blocks whose supports move, with small displacements. `openings` are the opening of
    /// both ends and the slip \[m\] that the supports alone would cause at each joint. Of all compatible motions q the
    /// solver returns one of least potential energy −w·q + Σ bᵢγᵢ under the loads w of each group about the pole; the
    /// dual solution is the field. Joints have associated flow. If no such motion exists, or the solver uses the laws'
    /// own flow, the answer is a state with that flow.
    fn settle(&self, _: &LimitProblem, _: &Wrenches, _: &[[f64; 3]]) -> SettlementAnswer {
        SettlementAnswer::Refused("this solver knows loads only, no supports that move".into())
    }
}
