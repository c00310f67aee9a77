//! A row of the strengths on the optimal face.

use nalgebra::DVector;

/// A row A_i of the strengths over the forces of one joint, of length 1, with its slack in r̂.
#[derive(Debug, Clone)]
pub(super) struct FaceRow {
    pub joint: usize,
    /// Index among the joint's rows, or of the end of its stress block.
    pub source: Source,
    /// Factor that has made its length 1.
    pub scale: f64,
    /// Over all forces.
    pub coefficients: DVector<f64>,
    /// ≥ 0.
    pub slack: f64,
}

/// Which strength a row comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Source {
    Row(usize),
    Block(usize),
}
