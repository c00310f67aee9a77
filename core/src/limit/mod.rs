//! Limit analysis: its problem, the question to a solver, the answer, and the trait of limit solvers.

mod lower_proof;
mod problem;
mod solver;
mod well_formed;

pub use self::lower_proof::{BracketPoint, BracketWork, FIRST, LAST, LowerProof, LowerProofKind, ProductStep};
pub use self::problem::{JointForce, LimitJoint, LimitProblem, Velocity};
pub use self::solver::{
    Counters, Greatest, LimitAnswer, LimitQuestion, LimitSolver, NonAssociated, SettlementAnswer, Status,
};
