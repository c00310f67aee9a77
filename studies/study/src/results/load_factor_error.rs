//! Estimates of the error of a load factor.

use serde::{Deserialize, Serialize};

/// Estimates of the errors of a load factor, in units of the factor.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LoadFactorError {
    /// Error of the mesh and of the number of contact points in a joint; `null` if no block is meshed.
    pub discretisation: Option<f64>,
    /// Error of the steps along a path; `null` if the solver makes no steps.
    pub path: Option<f64>,
    /// Error of the solution: the distance between the factor and its bounds, or the tolerance of a path.
    pub solution: f64,
}

impl LoadFactorError {
    /// Their sum.
    pub fn total(&self) -> f64 {
        self.discretisation.unwrap_or(0.0) + self.path.unwrap_or(0.0) + self.solution
    }
}
