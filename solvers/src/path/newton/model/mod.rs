//! The data of the problem: geometry, laws, loads, the state, gaps and balance with their derivatives.

pub mod blocks;
pub mod control;
pub mod deformation;
pub mod derivatives;
pub mod equations;
pub mod factors;
pub mod geometry;
pub mod kinematics;
pub mod limits;
pub mod loads;
pub mod state;
pub mod system;
pub mod tractions;
