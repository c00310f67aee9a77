//! Factorisation L D Lᵀ of symmetric quasi-definite sparse matrices.

use super::entries::Entries;
use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, Mat, MatMut, MatRef, Par, Side};
use nalgebra::DMatrix;

/// L D Lᵀ of a symmetric quasi-definite matrix, with the matrix itself. Such a matrix can be factorised in any order,
/// so the order is chosen to keep the factors sparse, also if a variable occurs in every equation.
pub struct SparseLdlt {
    matrix: SparseColMat<usize, f64>,
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
}

impl SparseLdlt {
    /// Factorises \[A, Bᵀ; B, −C\] with A and C positive definite and A of size `positive`. `entries` contain both
    /// triangles. `None` if the factorisation fails.
    pub fn new(size: usize, positive: usize, entries: &Entries) -> Option<Self> {
        let triplets: Vec<_> = entries.iter().map(|&(i, j, v)| Triplet::new(i, j, v)).collect();
        let matrix = SparseColMat::try_new_from_triplets(size, size, &triplets).ok()?;
        let symbolic = factorize_symbolic_cholesky(
            matrix.symbolic(),
            Side::Lower,
            SymmetricOrdering::Amd,
            CholeskySymbolicParams::default(),
        )
        .ok()?;
        let signs: Vec<i8> = (0..size).map(|i| if i < positive { 1 } else { -1 }).collect();
        let regularisation = LdltRegularization {
            dynamic_regularization_signs: Some(&signs[..]),
            dynamic_regularization_delta: 1e-9,
            dynamic_regularization_epsilon: 1e-14,
        };
        let mut values = vec![0.0; symbolic.len_val()];
        let scratch = symbolic.factorize_numeric_ldlt_scratch::<f64>(Par::Seq, Default::default());
        symbolic
            .factorize_numeric_ldlt(
                &mut values,
                matrix.as_ref(),
                Side::Lower,
                regularisation,
                Par::Seq,
                MemStack::new(&mut MemBuffer::try_new(scratch).ok()?),
                Default::default(),
            )
            .ok()?;
        Some(SparseLdlt { matrix, symbolic, values })
    }

    fn solve_once(&self, x: MatMut<f64>) -> Option<()> {
        let factor = LdltRef::new(&self.symbolic, &self.values);
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(x.ncols(), Par::Seq);
        let mut buffer = MemBuffer::try_new(scratch).ok()?;
        factor.solve_in_place_with_conj(Conj::No, x, Par::Seq, MemStack::new(&mut buffer));
        Some(())
    }

    /// Solves with iterative refinement. `None` if the solution is not finite.
    pub fn solve(&self, right: &[f64]) -> Option<Vec<f64>> {
        let target = Mat::from_fn(right.len(), 1, |i, _| right[i]);
        let mut x = target.clone();
        self.solve_once(x.as_mut())?;
        for _ in 0..3 {
            let mut step = &target - &self.matrix * &x;
            self.solve_once(step.as_mut())?;
            x += step;
        }
        let x: Vec<f64> = (0..right.len()).map(|i| x[(i, 0)]).collect();
        x.iter().all(|v| v.is_finite()).then_some(x)
    }

    /// Solves for all columns at once, without refinement. `None` if the solution is not finite.
    pub fn solve_columns(&self, mut right: DMatrix<f64>) -> Option<DMatrix<f64>> {
        let (rows, columns) = right.shape();
        self.solve_once(MatMut::from_column_major_slice_mut(right.as_mut_slice(), rows, columns))?;
        right.iter().all(|v| v.is_finite()).then_some(right)
    }

    /// Returns the matrix times columns.
    pub fn times(&self, columns: &DMatrix<f64>) -> DMatrix<f64> {
        let (rows, count) = columns.shape();
        let product = &self.matrix * MatRef::from_column_major_slice(columns.as_slice(), rows, count);
        DMatrix::from_fn(rows, count, |i, j| product[(i, j)])
    }
}
