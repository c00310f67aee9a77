//! The path problem in units of its own, as both path solvers take it: forces by the loads, displacements by what
//! those loads do to a mean contact point.
//!
//! Unknowns x = (r, q): (r_n, r_t) of every contact point, then (u_x, u_y, θ L) of every free body; after them, where a
//! solver steps, the factor λ.

mod chain;
mod load;
mod rows;
mod scaled;
mod units;

pub use load::Load;
pub use scaled::System;
pub use units::Units;

#[cfg(test)]
mod tests;
