//! The shortest solution of dense equations.

use faer::Mat;
use faer::linalg::solvers::ColPivQr;
use nalgebra::{DMatrix, DVector};

/// Corrections of the solution.
const CORRECTIONS: usize = 2;

/// Returns the shortest x with A x = b for the equations that do not depend on others within rounding.
///
/// Aᵀ P = Q R with column pivoting gives the independent equations. Their x = Aᵀ y with Rᵀ R y = b needs no Q; corrections with the
/// remaining error make it as accurate as one with Q (Björck 1987, *Linear Algebra Appl.* 88/89, 31–48).
pub fn least_norm(a: &DMatrix<f64>, b: &DVector<f64>) -> DVector<f64> {
    let decomposed = ColPivQr::new(Mat::from_fn(a.ncols(), a.nrows(), |i, j| a[(j, i)]).as_ref());
    let order = decomposed.P().arrays().0;
    let thin = decomposed.thin_R();
    let least = f64::EPSILON * a.nrows().max(a.ncols()) as f64 * thin.norm_max();
    let rank = (0..thin.nrows()).take_while(|k| thin[(*k, *k)].abs() > least).count();
    let r = DMatrix::from_fn(rank, rank, |i, j| if i <= j { thin[(i, j)] } else { 0.0 });
    let mut x = DVector::zeros(a.ncols());
    for _ in 0..=CORRECTIONS {
        let left = b - a * &x;
        let left = DVector::from_fn(rank, |k, _| left[order[k]]);
        let Some(y) = r.tr_solve_upper_triangular(&left).and_then(|z| r.solve_upper_triangular(&z)) else { break };
        let mut all = DVector::zeros(a.nrows());
        y.iter().zip(order).for_each(|(y, place)| all[*place] = *y);
        x += a.tr_mul(&all);
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The solution is a combination of the rows and satisfies all equations, also if two of them are equal.
    #[test]
    fn the_solution_is_the_shortest_one() {
        let a = DMatrix::from_row_slice(3, 4, &[1.0, 2.0, 0.0, -1.0, 1.0, 2.0, 0.0, -1.0, 0.0, 1e-6, 3.0, 1.0]);
        let x = least_norm(&a, &DVector::from_vec(vec![6.0, 6.0, 10.0]));
        assert!((&a * &x - DVector::from_vec(vec![6.0, 6.0, 10.0])).amax() < 1e-14);
        let normal = DMatrix::from_row_slice(2, 2, &[6.0, 2e-6 - 1.0, 2e-6 - 1.0, 10.0 + 1e-12]);
        let y = normal.lu().solve(&DVector::from_vec(vec![6.0, 10.0])).unwrap();
        let own = a.row(0).transpose() * y[0] + a.row(2).transpose() * y[1];
        assert!((x - own).amax() < 1e-14);
    }
}
