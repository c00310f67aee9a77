//! From a case to its result: choice of the solver, solution and certificate.
//!
//! [`crate::cases`] solves and checks cases, and [`explain`](explain::explain) describes the problem. [`crate::checks`] checks a
//! result without a solver.

pub mod accuracy;
pub(crate) mod associated_load;
pub mod auto;
pub(crate) mod carried;
mod case_input;
mod coarse_joints;
pub mod explain;
mod explain_bridge;
pub mod knobs;
pub(crate) mod limit;
mod limit_mechanism;
pub(crate) mod limit_points;
mod limit_result;
pub mod load_entries;
mod load_history;
pub(crate) mod ours;
pub(crate) mod path;
mod path_proof;
mod path_result;
pub(crate) mod path_status;
mod recorded;
pub mod restated;
pub(crate) mod safe_theorem;
pub mod sensitivity;
mod settlement;
mod solver_outputs;
pub(crate) mod space;
pub(crate) mod space_entries;
pub(crate) mod space_settlement;
pub(crate) mod statics;
mod stored_path;
mod symmetric;

pub use case_input::CaseInput;
