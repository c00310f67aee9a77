//! The one place that factorises sparse matrices, and the only one that knows how.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::ldlt::factor::LdltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LdltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, Triplet};
use faer::{Conj, Mat, MatMut, MatRef, Par, Side};
use nalgebra::DMatrix;

/// Entries (row, column, value); repeated ones add up.
pub type Entries = Vec<(usize, usize, f64)>;

/// L D Lᵀ of a symmetric quasi-definite matrix, with the matrix itself. Such matrices have a
/// factorisation in any order, so the order that keeps it sparse is free to choose, also where a
/// variable occurs in every equation.
pub struct Factorised {
    matrix: SparseColMat<usize, f64>,
    symbolic: SymbolicCholesky<usize>,
    values: Vec<f64>,
}

impl Factorised {
    /// Factorises \[A, Bᵀ; B, −C\], A and C positive definite, A of size `positive`. `entries` hold
    /// both triangles. `None` where it fails.
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
        Some(Factorised { matrix, symbolic, values })
    }

    fn solve_once(&self, x: MatMut<f64>) -> Option<()> {
        let factor = LdltRef::new(&self.symbolic, &self.values);
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(x.ncols(), Par::Seq);
        let mut buffer = MemBuffer::try_new(scratch).ok()?;
        factor.solve_in_place_with_conj(Conj::No, x, Par::Seq, MemStack::new(&mut buffer));
        Some(())
    }

    /// Solves with iterative refinement.
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

    /// Solves for every column at once, with one step of iterative refinement. Also gives the
    /// greatest entry of the residual over the greatest of the right-hand side. `None` where a
    /// solution is not finite.
    pub fn solve_columns(&self, right: &DMatrix<f64>) -> Option<(DMatrix<f64>, f64)> {
        let (rows, columns) = right.shape();
        let target = MatRef::from_column_major_slice(right.as_slice(), rows, columns);
        let mut x = target.to_owned();
        self.solve_once(x.as_mut())?;
        let mut step = target - &self.matrix * &x;
        self.solve_once(step.as_mut())?;
        x += step;
        let rest = target - &self.matrix * &x;
        let greatest = |m: MatRef<f64>| {
            (0..columns).flat_map(|j| (0..rows).map(move |i| (i, j))).fold(0.0f64, |max, at| max.max(m[at].abs()))
        };
        let solution = DMatrix::from_fn(rows, columns, |i, j| x[(i, j)]);
        let error = greatest(rest.as_ref()) / greatest(target).max(f64::MIN_POSITIVE);
        (solution.iter().all(|v| v.is_finite()) && error.is_finite()).then_some((solution, error))
    }
}
