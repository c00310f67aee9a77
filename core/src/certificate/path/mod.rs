//! Certificates of paths: every state that an observer sees is checked against the [structure](path_structure) that the assembly and
//! the stages describe, not against the problem that the solver was given.
//!
//! - `path_equilibrium`: resultants of loads and contact forces on each free body, relative to the
//!   sum of all forces (moments divided by the scene's length), in displaced positions where
//!   displacements are finite ([`Displaced`]);
//! - `path_kinematics`: gaps recomputed from motions, forces and loads, and motions of supports from settlements, relative to the
//!   greatest gap or displacement. With finite displacements the rounding of positions is granted, and no pressed point has
//!   slipped beyond the face that it slides on;
//! - `path_strength`: greatest excess of a facet over its bound, relative to the greatest contact force;
//! - `path_penetration`: greatest overlap of blocks, relative to the greatest gap or deformation;
//! - `path_complementarity`: greatest force × gap of open contact points, relative to both;
//! - `path_law`: difference between the force of a contact point and what its law of tractions from
//!   gaps gives for the recorded gap and the history of gaps, relative to the greatest contact force.
//!   Such a law has its own compliance: strength, penetration and complementarity say nothing there;
//! - `path_dissipation`: energy that friction would have created, relative to the work;
//! - `path_inner_equilibrium`: of blocks whose material yields, forces on the nodes that stresses leave,
//!   relative to the sum of the forces on the block; stresses are those that the law itself gives at the
//!   recorded displacements and history;
//! - `path_yield`: how much the law would still change that history, relative to the greatest strain: 0
//!   where no stress lies beyond the yield surface (a block recorded as elastic yields nowhere);
//! - `path_energy`: what the work of loads and settled supports leaves of the energy stored and dissipated, in a stage
//!   and in its worst step, relative to Σ|work| + |stored| + dissipated of that stage, the worst of all stages: 1e-3
//!   for paths of steps, rounding for exact ones;
//!
//! and of what is claimed at a path's end:
//!
//! - `path_flow`: how far a mechanism's jumps leave the flow of the facets that yield;
//! - `path_power`: |p·q̇ − 1| of a mechanism;
//! - `path_ray`: what a ray leaves of the load, or its excess over a facet, relative to its forces.
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
