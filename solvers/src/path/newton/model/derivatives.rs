//! First and second derivatives of the potential of [`kinematics`](super::kinematics).

use crate::linear::blocks::{BlockMatrix, Pattern};
use std::sync::Arc;

/// First derivatives of Π.
#[derive(Debug, Clone)]
pub struct Gradient {
    /// Gaps \[m\].
    pub gap: Vec<[f64; 2]>,
    /// Out-of-balance wrench on every body about its pole \[N, N m\].
    pub balance: Vec<[f64; 3]>,
    /// Elastic displacement of the points of every body in its frame \[m\].
    pub deformation: Vec<Vec<f64>>,
    /// Elastic energy \[J\].
    pub stored: f64,
}

/// Second derivatives by the motions of two bodies, summed over the contact points of a joint.
#[derive(Debug, Default)]
pub struct OfPair {
    /// First index of the motions of both bodies.
    at: [usize; 2],
    values: [[f64; 6]; 6],
}

impl OfPair {
    /// Starts with two bodies, whose motions begin at these indices; the sums of the previous pair become entries.
    pub fn begin(&mut self, at: [usize; 2], entries: &mut Vec<(usize, usize, f64)>) {
        if self.at != at {
            self.end(entries);
            self.at = at;
        }
    }

    /// Adds a derivative by two of the motions.
    pub fn add(&mut self, i: usize, j: usize, value: f64) {
        let [i, j] =
            [i, j].map(|i| if (self.at[0]..self.at[0] + 3).contains(&i) { i - self.at[0] } else { i - self.at[1] + 3 });
        self.values[i][j] += value;
    }

    /// Converts the sums to entries.
    pub fn end(&mut self, entries: &mut Vec<(usize, usize, f64)>) {
        let place = |i: usize| self.at[i / 3] + i % 3;
        for (i, row) in self.values.iter().enumerate() {
            let of_row = row.iter().enumerate().filter(|(_, value)| **value != 0.0);
            entries.extend(of_row.map(|(j, value)| (place(i), place(j), *value)));
        }
        self.values = [[0.0; 6]; 6];
    }
}

/// Second derivatives of Π over (r, q of all bodies), and the derivative of the gradient by the growing factor.
#[derive(Debug, Clone)]
pub struct Hessian {
    /// Gaps by forces.
    pub forces: BlockMatrix,
    /// All other derivatives: entry (i, j, value), both halves.
    pub entries: Vec<(usize, usize, f64)>,
    pub factor: Vec<f64>,
}

impl Hessian {
    /// Creates derivatives without entries, for this number of forces and motions and about this number of entries.
    pub fn zeros(pattern: Arc<Pattern>, size: usize, entries: usize) -> Self {
        let forces = BlockMatrix::zeros(pattern);
        Hessian { forces, entries: Vec::with_capacity(entries), factor: vec![0.0; size] }
    }
}
