//! Limit analysis: its problem, what is asked, what is answered, and the trait of its solvers.

mod lower_proof;
mod problem;
mod solver;
mod well_formed;

pub use self::lower_proof::{BracketPoint, BracketWork, FIRST, LAST, LowerProof, LowerProofKind, ProductStep};
pub use self::problem::{JointForce, LimitJoint, LimitProblem, Velocity};
pub use self::solver::{
    Counters, Greatest, LimitAnswer, LimitQuestion, LimitSolver, NonAssociated, SettlementAnswer, Status,
};
