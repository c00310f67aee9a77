//! The traced path: accepted states, limit points, snaps to stable equilibria, energy of steps.

pub mod commit;
pub mod descent_energy;
pub mod peak;
pub mod relaxation;
pub mod stable_branch;
pub mod step_energy;
pub mod tracer;
pub mod witness;
