//! What every factorisation of equations can do.

/// Factorised equations, with the equations themselves for residuals.
pub trait Factorised {
    /// Their solution, once, without refinement.
    fn apply(&self, right: &[f64]) -> Option<Vec<f64>>;

    /// What they leave of a right-hand side, and the greatest backward error of a row.
    fn errors(&self, right: &[f64], x: &[f64]) -> (Vec<f64>, f64);

    /// The last row times a vector.
    fn last_row_dot(&self, x: &[f64]) -> f64;
}

/// The backward error of a row: what is left of it, relative to the sizes of what it adds up (Arioli, Demmel & Duff 1989,
/// SIAM J. Matrix Anal. Appl. 10, 165-190). A row of zeros is solved; what is no number is not.
pub fn row_error(left: f64, size: f64) -> f64 {
    let error = if left == 0.0 { 0.0 } else { (left / size).abs() };
    if error.is_nan() { f64::INFINITY } else { error }
}
