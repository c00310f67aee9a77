//! The path problem in scaled units, for both path solvers. The unit of force is the size of the loads; the unit of
//! displacement is the deformation of a mean contact point by these loads.
//!
//! Unknowns x = (r, q): (r_n, r_t) of every contact point, then (u_x, u_y, θ L) of every free body; after them, if a
//! solver uses steps, the factor λ.

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
