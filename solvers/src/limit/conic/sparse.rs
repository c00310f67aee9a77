//! The one place that factorises sparse matrices.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::Lu;
use faer::sparse::{SparseColMat, Triplet};

/// Entries (row, column, value); repeated ones add up.
pub type Entries = Vec<(usize, usize, f64)>;

/// A factorised square sparse matrix with the matrix itself.
pub struct Factorised {
    matrix: SparseColMat<usize, f64>,
    lu: Lu<usize, f64>,
}

impl Factorised {
    /// LU with partial pivoting; `None` where it is singular.
    pub fn new(size: usize, entries: &Entries) -> Option<Self> {
        let triplets: Vec<_> = entries
            .iter()
            .map(|&(i, j, v)| Triplet::new(i, j, v))
            .collect();
        let matrix = SparseColMat::try_new_from_triplets(size, size, &triplets).ok()?;
        let lu = matrix.sp_lu().ok()?;
        Some(Factorised { matrix, lu })
    }

    /// Solves with two steps of iterative refinement.
    pub fn solve(&self, right: &[f64]) -> Option<Vec<f64>> {
        let column = |values: &[f64]| faer::Mat::from_fn(values.len(), 1, |i, _| values[i]);
        let target = column(right);
        let mut x = self.lu.solve(&target);
        for _ in 0..2 {
            let residual = &target - &self.matrix * &x;
            x += self.lu.solve(&residual);
        }
        let x: Vec<f64> = (0..right.len()).map(|i| x[(i, 0)]).collect();
        x.iter().all(|v| v.is_finite()).then_some(x)
    }
}
