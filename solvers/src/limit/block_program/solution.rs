//! The optimum of a program.

use voussoir_core::limit::{JointForce, Velocity};

/// An optimum to rounding.
#[derive(Debug, Clone)]
pub struct Solution {
    /// Greatest factor.
    pub factor: f64,
    /// Whether it is the cap.
    pub capped: bool,
    /// Forces at it.
    pub forces: Vec<JointForce>,
    /// Motion that proves it, up to a factor; nothing moves where the cap is reached first.
    pub motion: Vec<Velocity>,
    /// Whether it is the only one.
    pub unique: bool,
}
