//! Limit analysis: its problem, the question to a solver, the answer, and the trait of limit solvers.
//!
//! A solver that solves linear programs only needs [`answer_by_programs`]; one with other optimisations needs an
//! [`Engine`] and [`answer_by`]. [`LimitMatrices`] is the problem as sparse matrices.

mod engine;
mod floating;
mod force_variables;
mod lower_proof;
mod matrices;
mod problem;
mod programs;
mod question;
mod scale;
mod solver;
mod space_answer;
mod space_points;
mod space_problem;
mod status;
mod well_formed;

pub use self::engine::{Engine, Equilibrium, Extreme, GreatestFactor};
pub use self::floating::loose_motion;
pub use self::force_variables::{ForceVariables, SparseRow};
pub use self::lower_proof::{BracketPoint, BracketWork, FIRST, LAST, LowerProof, LowerProofKind, ProductStep};
pub use self::matrices::{ForceColumn, LimitMatrices};
pub use self::problem::{JointForce, LimitJoint, LimitProblem, Velocity};
pub use self::programs::{LinearProgram, LinearSolution, answer_by_programs};
pub use self::question::answer_by;
pub use self::scale::{combined, force_scale, force_unit, with_unit_power};
pub use self::solver::{LimitAnswer, LimitQuestion, LimitSolver, NonAssociated, SettlementAnswer};
pub use self::space_answer::{SpaceAnswer, SpaceField, SpaceNonAssociated, SpaceSettled, SpaceVelocity, power};
pub use self::space_points::PointSet;
pub use self::space_problem::{SpaceContact, SpaceProblem};
pub use self::status::{Counters, Greatest, Status};
