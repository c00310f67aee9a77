//! The one place that factorises unsymmetric sparse matrices.

use faer::linalg::solvers::Solve;
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Mat, MatMut};

/// Entries (row, column, value); repeated ones add up.
pub type Entries = Vec<(usize, usize, f64)>;

/// L U of a square sparse matrix with partial pivoting, with the matrix itself for refinement.
pub struct SparseLu {
    matrix: SparseColMat<usize, f64>,
    factors: Lu<usize, f64>,
}

impl SparseLu {
    /// Factorises a matrix. `None` where it is singular in its pattern.
    pub fn new(size: usize, entries: &Entries) -> Option<Self> {
        let triplets: Vec<_> = entries.iter().map(|&(i, j, v)| Triplet::new(i, j, v)).collect();
        let matrix = SparseColMat::try_new_from_triplets(size, size, &triplets).ok()?;
        let symbolic = SymbolicLu::try_new(matrix.symbolic()).ok()?;
        let factors = Lu::try_new_with_symbolic(symbolic, matrix.as_ref()).ok()?;
        Some(SparseLu { matrix, factors })
    }

    /// Factorises a matrix with something added, which refinement takes out again: where the matrix
    /// itself is singular but its right-hand sides are consistent. `None` as for [`SparseLu::new`].
    pub fn shifted(size: usize, entries: &Entries, shift: &Entries) -> Option<Self> {
        let all: Entries = entries.iter().chain(shift).copied().collect();
        let triplets: Vec<_> = entries.iter().map(|&(i, j, v)| Triplet::new(i, j, v)).collect();
        let factors = SparseLu::new(size, &all)?.factors;
        Some(SparseLu { matrix: SparseColMat::try_new_from_triplets(size, size, &triplets).ok()?, factors })
    }

    /// Solves for several right-hand sides (columns), each with `refinements` steps of iterative
    /// refinement. `None` where the matrix is singular to rounding.
    pub fn solve(&self, right: &[Vec<f64>], refinements: usize) -> Option<Vec<Vec<f64>>> {
        let size = self.matrix.nrows();
        let target = Mat::from_fn(size, right.len(), |i, j| right[j][i]);
        let mut x = target.clone();
        self.in_place(x.as_mut());
        for _ in 0..refinements {
            let mut step = &target - &self.matrix * &x;
            self.in_place(step.as_mut());
            x += step;
        }
        let out: Vec<Vec<f64>> = (0..right.len()).map(|j| (0..size).map(|i| x[(i, j)]).collect()).collect();
        out.iter().flatten().all(|v| v.is_finite()).then_some(out)
    }

    fn in_place(&self, x: MatMut<'_, f64>) {
        self.factors.solve_in_place(x);
    }
}
