//! Checks the result of one case without a solver: certificate, bounds, mechanism, thrust line, stages, and the equilibrium of
//! the last state of a path.

mod agreement;
mod carried;
pub mod case;
mod curves;
mod events;
pub mod fields;
pub mod findings;
mod fit;
mod limit;
pub mod meaning;
mod mechanism;
pub mod outputs;
mod path;
pub mod repeat;
mod space;
mod stored_state;
mod texts;
pub mod tolerances;

pub use agreement::Agreement;
pub use fit::misfits;
