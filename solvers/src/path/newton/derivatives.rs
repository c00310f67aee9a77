//! First and second derivatives of the potential of [`kinematics`](super::kinematics).

use crate::linear::blocks::{BlockMatrix, Pattern};
use std::sync::Arc;

/// First derivatives of Π.
#[derive(Debug, Clone)]
pub(super) struct Gradient {
    /// Gaps \[m\].
    pub gap: Vec<[f64; 2]>,
    /// Out-of-balance wrench on every body about its pole \[N, N m\].
    pub balance: Vec<[f64; 3]>,
    /// Elastic displacement of the points of every body in its frame \[m\].
    pub deformation: Vec<Vec<f64>>,
    /// Elastic energy \[J\].
    pub stored: f64,
}

/// Second derivatives of Π over (r, q of all bodies), and the derivative of the gradient by the factor that grows.
#[derive(Debug, Clone)]
pub(super) struct Hessian {
    /// Gaps by forces.
    pub forces: BlockMatrix,
    /// All else: entry (i, j, value), both halves.
    pub entries: Vec<(usize, usize, f64)>,
    pub factor: Vec<f64>,
}

impl Hessian {
    /// Without entries, for so many forces and motions and about so many entries.
    pub fn zeros(pattern: Arc<Pattern>, size: usize, entries: usize) -> Self {
        let forces = BlockMatrix::zeros(pattern);
        Hessian { forces, entries: Vec::with_capacity(entries), factor: vec![0.0; size] }
    }
}
