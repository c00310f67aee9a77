//! Certificates of paths. Every state that an observer receives is checked against the [structure](path_structure) of
//! the assembly and the stages, not against the problem that the solver was given.
//!
//! - `path_equilibrium`: resultants of loads and contact forces on each free body, relative to the
//!   sum of all forces (moments divided by the length of the scene), in displaced positions if
//!   displacements are finite ([`Displaced`]);
//! - `path_kinematics`: gaps recomputed from motions, forces and loads, and motions of supports from settlements, relative to
//!   the greatest gap or displacement. With finite displacements the rounding of positions is allowed, and no pressed
//!   point has slipped beyond the face that it slides on;
//! - `path_strength`: greatest excess of a facet over its bound, relative to the greatest contact force;
//! - `path_penetration`: greatest overlap of blocks, relative to the greatest gap or deformation;
//! - `path_complementarity`: greatest force × gap of open contact points, relative to both;
//! - `path_law`: difference between the force of a contact point and the force of its response for the
//!   recorded gap and the history of gaps, relative to the greatest contact force. A response includes
//!   compliance, so strength, penetration and complementarity do not apply to it;
//! - `path_dissipation`: energy that friction would have created, relative to the work;
//! - `path_inner_equilibrium`: unbalanced forces on the nodes of yielding blocks, relative to the sum of the
//!   forces on the block, with the stresses of the law at the recorded displacements and history;
//! - `path_yield`: change of this history by a further update of the law, relative to the greatest strain: 0
//!   if no stress is beyond the yield surface (a block recorded as elastic yields nowhere);
//! - `path_energy`: work of loads and settled supports minus the energy stored and dissipated, in a stage
//!   and in its worst step, relative to Σ|work| + |stored| + dissipated of this stage, the worst of all stages: 1e-3
//!   for paths of steps, rounding for exact paths.
//!
//! Claims at the end of a path have these residuals:
//!
//! - `path_flow`: distance of the jumps of a mechanism from the flow of the yielding facets;
//! - `path_power`: |p·q̇ − 1| of a mechanism;
//! - `path_ray`: unbalanced load of a ray, or its excess over a facet, relative to its forces.
//!
//! The end of a path is proved by a [`PathChain`] of its states, and by a [`Witness`](crate::path::Witness) at one of them.

mod arrival;
mod chain;
mod checker;
mod claims;
mod displaced;
mod displaced_rates;
mod dual;
mod ends;
mod energy;
mod history;
mod increment;
mod loading_set;
mod none_rises;
mod point_modes;
mod rate_check;
mod rate_equations;
mod response;
mod structure;
#[cfg(test)]
mod tests;
mod tolerance;

pub use self::chain::PathChain;
pub use self::checker::PathChecker;
pub use self::claims::{flow_residual, power_residual, ray_residual};
pub use self::displaced::Displaced;
pub use self::response::{forces_rest, leaves_forces};
pub use self::structure::path_structure;
pub use self::tolerance::{TOLERANCES, Tolerance, tolerance};
