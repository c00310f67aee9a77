//! A row: a linear strength condition on the forces of a whole joint.

use super::facet::FacetMode;

/// A linear strength condition on (N_0, N_1, T) \[N\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ForceRow {
    /// Coefficients of N_0, N_1 and T.
    pub normal: [f64; 3],
    /// Right-hand side \[N\].
    pub bound: f64,
    /// The way in which the joint yields.
    pub mode: FacetMode,
    /// Flow direction d in the openings of both ends and the slip; equal to the normal if the flow is associated.
    pub flow: [f64; 3],
}

impl ForceRow {
    /// Creates a row with associated flow.
    pub fn associated(mode: FacetMode, normal: [f64; 3], bound: f64) -> Self {
        ForceRow { normal, bound, mode, flow: normal }
    }
}
