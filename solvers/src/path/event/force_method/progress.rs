//! How far a path has come in redundants and load: z = (X, s), and ∫ z dzᵀ on the way.

use nalgebra::{DMatrix, DVector};

/// Redundants X and the arc s of the load.
pub struct Progress {
    /// (X, s).
    pub place: DVector<f64>,
    /// ∫ z dzᵀ.
    pub area: DMatrix<f64>,
}

impl Progress {
    /// At the beginning.
    pub fn new(size: usize) -> Self {
        Progress { place: DVector::zeros(size), area: DMatrix::zeros(size, size) }
    }

    /// Goes a step at a rate.
    pub fn step(&mut self, rate: &DVector<f64>, step: f64) {
        let moved = rate * step;
        self.area += (&self.place + 0.5 * &moved) * moved.transpose();
        self.place += moved;
    }

    /// s.
    pub fn arc(&self) -> f64 {
        self.place[self.place.len() - 1]
    }
}
