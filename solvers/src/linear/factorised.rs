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
