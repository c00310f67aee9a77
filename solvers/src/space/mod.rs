//! Limit analysis in space: the greatest factor with forces inside cones of friction, and collapse with the laws' own flow.
//!
//! [`solve`] uses an interior point method on second-order cones (`interior_point`); each contact is condensed to a
//! 6 × 6 block of the normal equations (`stiffness`). Its iterates are repaired to exact evidence (`evidence`):
//! forces in equilibrium inside the cones, and mechanisms inside the dual cones. [`solve_by_clarabel`] is the second
//! route and the fallback. [`solve_with_own_flow`] finds collapse states with the flow rules of the laws (`joints`), and
//! [`prove_least`] proves that a few blocks have no lower one (`branching`). The certificate of `voussoir_core::space` decides
//! the status.

mod branching;
mod by_clarabel;
mod cone;
mod evidence;
mod interior_point;
mod joints;
mod limit_cones;
mod program;
mod settings;
mod settlement;
mod solve;
mod stiffness;
#[cfg(test)]
mod tests;
mod uniqueness;

#[cfg(test)]
pub use self::branching::lower_bound;
pub use self::branching::prove as prove_least;
pub use self::joints::answer as solve_with_own_flow;
pub use self::settlement::settle as settle_in_space;
pub use self::solve::{solve, solve_by_clarabel};
