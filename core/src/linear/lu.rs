//! Factorisation L U of unsymmetric sparse matrices.

use super::entries::Entries;
use faer::linalg::solvers::{PartialPivLu, Solve};
use faer::sparse::linalg::solvers::{Lu, SymbolicLu};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use faer::{Mat, MatMut};
use std::sync::{Mutex, PoisonError};

/// L U of a square sparse matrix with partial pivoting, with the matrix itself for refinement.
pub struct SparseLu {
    matrix: SparseColMat<usize, f64>,
    factors: Factors,
}

enum Factors {
    Sparse(Lu<usize, f64>),
    Full(PartialPivLu<f64>),
}

/// A matrix is factorised as a full one if more than one of eight entries is stored: its factors are nearly full.
const FULL: usize = 8;

/// The pattern of a matrix and the order of elimination that keeps its factors sparse. Matrices with the same pattern
/// share it, whatever their values.
#[derive(Default)]
pub struct Analysis(Option<Known>);

struct Known {
    columns: Vec<usize>,
    rows: Vec<usize>,
    order: SymbolicLu<usize>,
}

impl Analysis {
    /// Returns the analysis of a matrix; the stored one if the pattern is the same.
    fn of(&mut self, matrix: &SparseColMat<usize, f64>) -> Option<SymbolicLu<usize>> {
        let pattern = matrix.symbolic();
        if let Some(known) = &self.0
            && known.columns == pattern.col_ptr()
            && known.rows == pattern.row_idx()
        {
            return Some(known.order.clone());
        }
        let order = SymbolicLu::try_new(pattern).ok()?;
        let (columns, rows) = (pattern.col_ptr().to_vec(), pattern.row_idx().to_vec());
        self.0 = Some(Known { columns, rows, order: order.clone() });
        Some(order)
    }
}

/// Sorts entries by columns, within a column by rows, by counting (rows first), and adds repeated entries.
fn by_columns(size: usize, entries: &[(usize, usize, f64)]) -> SparseColMat<usize, f64> {
    let starts = |of: fn(&(usize, usize, f64)) -> usize| {
        let mut start = vec![0; size + 1];
        entries.iter().for_each(|entry| start[of(entry) + 1] += 1);
        (0..size).for_each(|i| start[i + 1] += start[i]);
        start
    };
    let by_rows: Entries;
    let sorted = if entries.is_sorted_by_key(|entry| entry.0) {
        entries
    } else {
        let mut next = starts(|entry| entry.0);
        let mut sorted = vec![(0, 0, 0.0); entries.len()];
        for entry in entries {
            sorted[next[entry.0]] = *entry;
            next[entry.0] += 1;
        }
        by_rows = sorted;
        &by_rows
    };
    let start = starts(|entry| entry.1);
    let mut end = start[..size].to_vec();
    let (mut rows, mut values) = (vec![0; entries.len()], vec![0.0; entries.len()]);
    for &(i, j, value) in sorted {
        let at = end[j];
        if at > start[j] && rows[at - 1] == i {
            values[at - 1] += value;
        } else {
            (rows[at], values[at]) = (i, value);
            end[j] += 1;
        }
    }
    // Close the gaps of repeated entries.
    let mut columns = vec![0; size + 1];
    let mut at = 0;
    for j in 0..size {
        for from in start[j]..end[j] {
            (rows[at], values[at]) = (rows[from], values[from]);
            at += 1;
        }
        columns[j + 1] = at;
    }
    rows.truncate(at);
    values.truncate(at);
    SparseColMat::new(SymbolicSparseColMat::new_checked(size, size, columns, None, rows), values)
}

impl SparseLu {
    /// Factorises a matrix. `None` if it is sparse and its pattern is singular; [`SparseLu::solve`] finds other singular matrices.
    pub fn new(size: usize, entries: &Entries) -> Option<Self> {
        SparseLu::analysed(size, entries, &mut Analysis::default())
    }

    /// Factorises a matrix with the analysis of one of the same pattern; if the pattern differs, the analysis is
    /// replaced. `None` as for [`SparseLu::new`].
    pub fn analysed(size: usize, entries: &Entries, analysis: &mut Analysis) -> Option<Self> {
        SparseLu::ordered(by_columns(size, entries), |matrix| analysis.of(matrix))
    }

    /// Factorises a matrix with an analysis that several threads share; it is locked only while it is read. `None` as for
    /// [`SparseLu::new`].
    pub fn analysed_together(size: usize, entries: &Entries, analysis: &Mutex<Analysis>) -> Option<Self> {
        // A thread that has panicked cannot leave half an analysis: the analysis is replaced as a whole.
        SparseLu::ordered(by_columns(size, entries), |matrix| {
            analysis.lock().unwrap_or_else(PoisonError::into_inner).of(matrix)
        })
    }

    fn ordered(
        matrix: SparseColMat<usize, f64>,
        order: impl FnOnce(&SparseColMat<usize, f64>) -> Option<SymbolicLu<usize>>,
    ) -> Option<Self> {
        let factors = if FULL * matrix.val().len() > matrix.nrows() * matrix.ncols() {
            Factors::Full(matrix.to_dense().partial_piv_lu())
        } else {
            Factors::Sparse(Lu::try_new_with_symbolic(order(&matrix)?, matrix.as_ref()).ok()?)
        };
        Some(SparseLu { matrix, factors })
    }

    /// Factorises a matrix plus a shift that refinement removes again, for singular matrices with consistent right-hand
    /// sides. `None` as for [`SparseLu::new`].
    pub fn shifted(size: usize, entries: &Entries, shift: &Entries) -> Option<Self> {
        let all: Entries = entries.iter().chain(shift).copied().collect();
        let factors = SparseLu::new(size, &all)?.factors;
        Some(SparseLu { matrix: by_columns(size, entries), factors })
    }

    /// Solves for several right-hand sides (columns), each with `refinements` steps of iterative refinement. `None` if
    /// the matrix is singular within rounding.
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

    /// Returns b − A x.
    pub fn left(&self, right: &[f64], x: &[f64]) -> Vec<f64> {
        let pattern = self.matrix.symbolic();
        let (columns, rows, values) = (pattern.col_ptr(), pattern.row_idx(), self.matrix.val());
        let mut left = right.to_vec();
        for (j, x) in x.iter().enumerate() {
            (columns[j]..columns[j + 1]).for_each(|at| left[rows[at]] -= values[at] * x);
        }
        left
    }

    fn in_place(&self, x: MatMut<'_, f64>) {
        match &self.factors {
            Factors::Sparse(factors) => factors.solve_in_place(x),
            Factors::Full(factors) => factors.solve_in_place(x),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Repeated entries in any order are added, full and sparse matrices are solved, and matrices with one sparse pattern share
    /// its analysis.
    #[test]
    fn entries_add_up_and_a_pattern_is_analysed_once() {
        let entries = |scale: f64, size: usize| -> Entries {
            let three = [
                (2, 0, 1.0),
                (0, 0, scale),
                (1, 2, 4.0),
                (0, 2, 0.5),
                (0, 0, 1.0),
                (2, 1, -2.0),
                (1, 2, -1.0),
                (2, 0, 1.5),
                (1, 1, 1.0),
            ];
            three.into_iter().chain((3..size).map(|i| (i, i, 1.0))).collect()
        };
        for (size, pattern) in [(3, None), (24, Some(6 + 21))] {
            let stored = |analysis: &Analysis| analysis.0.as_ref().map(|known| known.rows.len());
            let mut analysis = Analysis::default();
            let padded = |three: [f64; 3]| three.into_iter().chain((3..size).map(|_| 0.0)).collect::<Vec<f64>>();
            for scale in [2.0, -0.25] {
                let factors = SparseLu::analysed(size, &entries(scale, size), &mut analysis).unwrap();
                assert_eq!(stored(&analysis), pattern);
                let x = factors.solve(&[padded([1.0, 2.0, 3.0])], 1).unwrap().swap_remove(0);
                let rows =
                    [(scale + 1.0) * x[0] + 0.5 * x[2] - 1.0, x[1] + 3.0 * x[2] - 2.0, 2.5 * x[0] - 2.0 * x[1] - 3.0];
                assert!(rows.iter().all(|r| r.abs() < 1e-14), "{rows:?}");
                let left = factors.left(&padded([1.0, 2.0, 3.0]), &padded([1.0, -1.0, 2.0]));
                assert_eq!(left, padded([1.0 - (scale + 1.0) - 1.0, 2.0 + 1.0 - 6.0, 3.0 - 2.5 - 2.0]));
            }
            let mut other = entries(1.0, size);
            other.push((0, 1, 1.0));
            assert!(SparseLu::analysed(size, &other, &mut analysis).is_some());
            assert_eq!(stored(&analysis), pattern.map(|count| count + 1));
        }
    }
}
