//! Linear programs of limit analysis with block structure: the normal equations have one 3 × 3 block for each body.
//!
//! Maximise θ subject to E x + θ p + w = 0, A x ≤ b and θ ≤ t, where x are the forces of the joints. A joint has at
//! most three forces and four rows, and connects two bodies. With weights W of the rows, E (Aᵀ W A)⁻¹ Eᵀ is the
//! stiffness matrix of bodies on springs. It is sparse whatever the number of rows. An interior point method
//! ([`interior_point`], [`directions`]) solves the program to rounding unless [`polish`] is faster; both use this
//! matrix with different springs. Source: Wright (1997), *Primal–dual interior-point methods*, chapters 10 and 11;
//! Mehrotra (1992).

mod cone;
mod directions;
mod interior_point;
mod polish;
mod program;
mod refinement;
mod residuals;
mod solution;
mod state;
mod stiffness;
#[cfg(test)]
mod tests;
mod wanted;

pub use self::interior_point::{Solved, solve};
pub use self::program::{Loads, Program};
pub use self::solution::Solution;
