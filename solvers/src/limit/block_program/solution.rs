//! The optimum of a program.

use voussoir_core::limit::{JointForce, Velocity};

/// An optimum to rounding.
#[derive(Debug, Clone)]
pub struct Solution {
    /// Greatest factor.
    pub factor: f64,
    /// True if the greatest factor is the cap.
    pub capped: bool,
    /// Forces at the greatest factor.
    pub forces: Vec<JointForce>,
    /// Motion that proves the factor, up to a scale; zero if the cap is reached first.
    pub motion: Vec<Velocity>,
    /// True if the motion is the only one.
    pub unique: bool,
}
