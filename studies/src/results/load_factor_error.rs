//! How far a load factor may be off.

use serde::{Deserialize, Serialize};

/// Estimates of the errors of a load factor, in units of the factor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LoadFactorError {
    /// Of the mesh, and with it of the contact points of a joint; `null` where nothing is meshed.
    pub discretisation: Option<f64>,
    /// Of the steps along a path; `null` where none are taken.
    pub path: Option<f64>,
    /// Of the solution itself: what is left between the factor and its bounds, or the tolerance of a path.
    pub solution: f64,
}

impl LoadFactorError {
    /// Their sum.
    pub fn total(&self) -> f64 {
        self.discretisation.unwrap_or(0.0) + self.path.unwrap_or(0.0) + self.solution
    }
}
