//! A row of the strengths on the optimal face.

use nalgebra::DVector;

/// A row A_i of the strengths over the forces of one joint, of length 1, with its slack in r̂.
#[derive(Debug, Clone)]
pub(super) struct FaceRow {
    pub joint: usize,
    /// The strength from which the row comes.
    pub source: Source,
    /// Factor that scales the row to length 1.
    pub scale: f64,
    /// Coefficients over all forces.
    pub coefficients: DVector<f64>,
    /// Slack, ≥ 0.
    pub slack: f64,
}

/// The strength from which a row comes: a row of the joint, or one end of its stress block.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Source {
    Row(usize),
    Block(usize),
}
