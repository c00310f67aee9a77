//! From a case to its result: choice of the solver, solution and certificate.
//!
//! [`solve_case`] solves one case, [`solve_cases`] solves several in parallel, and [`explain`](explain::explain) describes the
//! problem. [`mod@crate::verify`] checks a result without a solver.

pub mod accuracy;
pub(crate) mod associated_load;
pub mod auto;
pub(crate) mod carried;
mod case;
mod case_input;
mod coarse_joints;
pub mod explain;
mod explain_bridge;
pub mod knobs;
mod limit;
mod limit_mechanism;
pub(crate) mod limit_points;
mod limit_result;
mod load_history;
mod observer;
pub(crate) mod ours;
mod path;
mod path_proof;
mod path_result;
pub(crate) mod path_status;
mod recorded;
pub(crate) mod restated;
pub(crate) mod safe_theorem;
pub mod sensitivity;
mod settlement;
mod statics;
mod stored_path;
mod symmetric;

pub(crate) use case::proved_case;
pub use case::{label_of, solve_case, solve_cases, solve_followed, solve_input, solve_unless_cancelled};
pub use case_input::CaseInput;
pub use observer::{Observer, PathProgress, RunEvent, Unobserved, Watch};
