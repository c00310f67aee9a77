//! A dense system by its inverse, two rows of which change at a time (Sherman, Morrison & Woodbury).

use nalgebra::{DMatrix, DVector};

/// Changes after which the inverse is computed anew.
const UPDATES: usize = 60;
/// Relative residual of a solution above which it is.
const RESIDUAL: f64 = 1e-7;

/// Matrix and right-hand side with the inverse.
pub struct UpdatedInverse {
    matrix: DMatrix<f64>,
    right: DVector<f64>,
    inverse: Option<DMatrix<f64>>,
    updates: usize,
}

impl UpdatedInverse {
    /// Of so many unknowns, all rows zero.
    pub fn zeros(size: usize) -> Self {
        UpdatedInverse { matrix: DMatrix::zeros(size, size), right: DVector::zeros(size), inverse: None, updates: 0 }
    }

    /// Replaces two rows from `first` on, with their right-hand sides.
    pub fn set_rows(&mut self, first: usize, rows: &[DVector<f64>; 2], right: [f64; 2]) {
        let difference = DMatrix::from_fn(2, self.right.len(), |i, j| rows[i][j] - self.matrix[(first + i, j)]);
        for i in 0..2 {
            self.matrix.set_row(first + i, &rows[i].transpose());
            self.right[first + i] = right[i];
        }
        // A' = A + E D: A'⁻¹ = A⁻¹ − A⁻¹E (1 + D A⁻¹E)⁻¹ D A⁻¹.
        let Some(old) = &mut self.inverse else { return };
        let columns = old.columns(first, 2).clone_owned();
        let small = DMatrix::identity(2, 2) + &difference * &columns;
        match small.try_inverse() {
            Some(small) => {
                let rows = difference * &*old;
                old.gemm(-1.0, &(columns * small), &rows, 1.0);
                self.updates += 1;
            }
            None => self.inverse = None,
        }
    }

    /// The solution. `None` where the matrix is singular.
    pub fn solve(&mut self) -> Option<DVector<f64>> {
        let current = self.inverse.as_ref().filter(|_| self.updates <= UPDATES).map(|inverse| inverse * &self.right);
        if let Some(x) = current.filter(|x| self.holds(x)) {
            return x.iter().all(|v| v.is_finite()).then_some(x);
        }
        self.inverse = Some(self.matrix.clone().try_inverse()?);
        self.updates = 0;
        let x = self.inverse.as_ref()? * &self.right;
        x.iter().all(|v| v.is_finite()).then_some(x)
    }

    fn holds(&self, x: &DVector<f64>) -> bool {
        (&self.matrix * x - &self.right).amax() <= RESIDUAL * self.right.amax()
    }
}
