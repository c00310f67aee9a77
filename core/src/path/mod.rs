//! The path problem: bodies with their flexibility, contact points and loads in their order; the question to a path
//! solver and its answer.
//!
//! One system of equations describes all of it (for small displacements; with finite displacements G q is replaced by
//! the exact kinematics):
//!
//! ```text
//! equilibrium   Gqᵀ r + w + λ p = 0
//! kinematics    g = g_0 + G q + C r + g_w + λ g_p
//! law           per contact point: facets, or a response
//! ```

mod build;
mod continuation;
mod fill;
mod law_step;
mod outputs;
mod peak;
mod period;
mod point_law;
mod problem;
mod response_check;
mod responses;
mod sliding;
mod solver;
mod state;
mod well_formed;
mod witness;
mod work;

pub use self::continuation::{Constraint, Continuation, Increment, MOST_MONITORS, Monitor};
pub use self::fill::fill_gravity;
pub use self::law_step::LawStep;
pub use self::outputs::PointOutputs;
pub use self::peak::{Branching, LimitPointEnd, ProvenPeak, StageStability};
pub use self::period::{FieldChange, Period};
pub use self::point_law::PointLaw;
pub use self::problem::{Attachment, Contact, LoadStep, LoadStepEnd, Loading, PathBody, PathProblem};
pub use self::responses::Responses;
pub use self::sliding::Sliding;
pub use self::solver::{PathAnswer, PathObserver, PathSettings, PathSolver, StageSettings, Unobserved};
pub use self::state::{ContactEvent, PathEvent, PathState, Yielded};
pub use self::witness::{FarkasVector, ModeTree, NoneContinues, PathRate, PointMode, RateClaim, Witness};
