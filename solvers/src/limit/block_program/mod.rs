//! Linear programs of limit analysis by the blocks they are made of: 3 × 3 normal equations, one block for each body.
//!
//! Maximise θ subject to E x + θ p + w = 0, A x ≤ b and θ ≤ t, where x are the forces of the joints. A joint has three
//! forces and four rows at the most, and touches two bodies: with weights W of the rows, E (Aᵀ W A)⁻¹ Eᵀ is the
//! stiffness matrix of bodies on springs, as sparse as the bodies touch, whatever the number of rows. An interior
//! point method ([`interior_point`], its [`directions`]) solves the program, to rounding where [`polish`] does not get there sooner, by
//! the same matrix with other springs. Source: Wright (1997), *Primal–dual interior-point methods*, chapters 10 and 11; Mehrotra (1992).

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

pub use self::interior_point::{Solved, solve, stands};
pub use self::program::{Loads, Program};
pub use self::solution::Solution;
