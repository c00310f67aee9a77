//! The interface of factorised equations.

/// Factorised equations, with the equations themselves for residuals.
pub trait Factorised {
    /// Returns their solution, without refinement.
    fn apply(&self, right: &[f64]) -> Option<Vec<f64>>;

    /// Returns the residual of a right-hand side, and the greatest backward error of a row.
    fn errors(&self, right: &[f64], x: &[f64]) -> (Vec<f64>, f64);

    /// Returns the product of the last row with a vector.
    fn last_row_dot(&self, x: &[f64]) -> f64;
}

/// Returns the backward error of a row: its residual relative to the sum of the absolute values of its terms (Arioli,
/// Demmel & Duff 1989, SIAM J. Matrix Anal. Appl. 10, 165-190). The error is zero for a row of zeros and infinite for
/// NaN.
pub fn row_error(left: f64, size: f64) -> f64 {
    let error = if left == 0.0 { 0.0 } else { (left / size).abs() };
    if error.is_nan() { f64::INFINITY } else { error }
}
