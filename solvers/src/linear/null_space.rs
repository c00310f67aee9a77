//! The null space of a small dense matrix.

use nalgebra::DMatrix;

/// Returns an orthonormal basis of the vectors x with A x = 0, as columns. Singular values up to `least` times the greatest count as zero.
/// `None` if the decomposition fails.
pub fn null_space(matrix: &DMatrix<f64>, least: f64) -> Option<DMatrix<f64>> {
    let (rows, columns) = matrix.shape();
    if rows == 0 || columns == 0 {
        return Some(DMatrix::identity(columns, columns));
    }
    // Rows of zeros make the decomposition return all right singular vectors; R of A = Q R has the same ones.
    let padded = matrix.clone().resize_vertically(rows.max(columns), 0.0);
    let svd = padded.qr().unpack_r().try_svd(false, true, f64::EPSILON, 10_000)?;
    let (values, vectors) = (svd.singular_values, svd.v_t?);
    let null: Vec<usize> = (0..columns).filter(|k| values[*k] <= least * values.max()).collect();
    Some(DMatrix::from_fn(columns, null.len(), |i, k| vectors[(null[k], i)]))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vectors of the null space have no image, and their number completes the rank, for tall, wide and zero matrices.
    #[test]
    fn null_spaces_complete_the_rank() {
        let wide = DMatrix::from_row_slice(1, 3, &[1.0, 2.0, -1.0]);
        let tall = DMatrix::from_row_slice(3, 2, &[1.0, 2.0, 2.0, 4.0, -1.0, -2.0]);
        for (matrix, rank) in [(wide, 1), (tall, 1), (DMatrix::zeros(2, 2), 0), (DMatrix::zeros(0, 3), 0)] {
            let basis = null_space(&matrix, 1e-12).unwrap();
            assert_eq!(basis.ncols(), matrix.ncols() - rank);
            assert!((&matrix * &basis).iter().all(|x| x.abs() < 1e-14));
            assert!((basis.transpose() * &basis - DMatrix::identity(basis.ncols(), basis.ncols())).norm() < 1e-14);
        }
    }
}
