//! L Lᵀ of symmetric positive definite sparse matrices of one pattern, analysed once.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::SupernodalThreshold;
use faer::sparse::linalg::amd;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::{SparseColMat, SymbolicSparseColMat};
use faer::{Conj, MatMut, Par, Side};

/// Work for each entry of the factor from which columns are taken together in dense kernels, in units of 40 operations. Unknowns
/// come in blocks, so that columns share their rows from the start and this pays sooner than for single unknowns.
const DENSE: f64 = 0.25;

/// An order of elimination that keeps the factors of a graph's matrices sparse (approximate minimum degree):
/// which node comes first, second and so on. `edges` join different nodes and may be repeated.
pub fn elimination_order(nodes: usize, edges: &[(usize, usize)]) -> Option<Vec<usize>> {
    let mut columns: Vec<Vec<usize>> = (0..nodes).map(|node| vec![node]).collect();
    edges.iter().for_each(|&(a, b)| columns[a.max(b)].push(a.min(b)));
    let pattern = upper(columns);
    let scratch = amd::order_maybe_unsorted_scratch::<usize>(nodes, pattern.compute_nnz());
    let mut memory = MemBuffer::try_new(scratch).ok()?;
    let (mut order, mut place) = (vec![0; nodes], vec![0; nodes]);
    let control = amd::Control::default();
    amd::order_maybe_unsorted(&mut order, &mut place, pattern.as_ref(), control, MemStack::new(&mut memory)).ok()?;
    Some(order)
}

/// A pattern by columns of row indices up to the diagonal, in any order.
fn upper(mut columns: Vec<Vec<usize>>) -> SymbolicSparseColMat<usize> {
    let size = columns.len();
    let (mut starts, mut rows) = (vec![0], Vec::new());
    for column in &mut columns {
        column.sort_unstable();
        column.dedup();
        rows.extend_from_slice(column);
        starts.push(rows.len());
    }
    SymbolicSparseColMat::new_checked(size, size, starts, None, rows)
}

/// L Lᵀ of matrices that share a pattern, in the order in which they come. The pattern is analysed once, and no
/// factorisation allocates.
pub struct SparseCholesky {
    matrix: SparseColMat<usize, f64>,
    symbolic: SymbolicCholesky<usize>,
    factor: Vec<f64>,
    memory: MemBuffer,
}

impl SparseCholesky {
    /// Analyses a pattern: for each column its rows up to the diagonal, which must be among them. `None` where
    /// memory is short.
    pub fn new(columns: Vec<Vec<usize>>) -> Option<Self> {
        let pattern = upper(columns);
        let params = CholeskySymbolicParams {
            supernodal_flop_ratio_threshold: SupernodalThreshold(DENSE),
            ..Default::default()
        };
        let symbolic =
            factorize_symbolic_cholesky(pattern.as_ref(), Side::Upper, SymmetricOrdering::Identity, params).ok()?;
        let factorise = symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let solve = symbolic.solve_in_place_scratch::<f64>(2, Par::Seq);
        let memory = MemBuffer::try_new(factorise.or(solve)).ok()?;
        let (entries, factor) = (vec![0.0; pattern.compute_nnz()], vec![0.0; symbolic.len_val()]);
        Some(SparseCholesky { matrix: SparseColMat::new(pattern, entries), symbolic, factor, memory })
    }

    /// Where the entry of a row and a column, not below the diagonal, is in [`SparseCholesky::values`]. The pattern
    /// must have it.
    pub fn place(&self, row: usize, column: usize) -> Option<usize> {
        let range = self.matrix.col_range(column);
        let found = self.matrix.row_idx()[range.clone()].binary_search(&row).ok()?;
        Some(range.start + found)
    }

    /// The entries of the next matrix to factorise.
    pub fn values(&mut self) -> &mut [f64] {
        self.matrix.val_mut()
    }

    /// Factorises the present entries. Pivots that vanish to rounding are replaced by huge ones, which fixes their
    /// unknowns at zero. Whether it went well.
    pub fn factorise(&mut self) -> bool {
        let regularisation =
            LltRegularization { dynamic_regularization_delta: 1e128, dynamic_regularization_epsilon: 1e-30 };
        let stack = MemStack::new(&mut self.memory);
        self.symbolic
            .factorize_numeric_llt(
                &mut self.factor,
                self.matrix.as_ref(),
                Side::Upper,
                regularisation,
                Par::Seq,
                stack,
                Default::default(),
            )
            .is_ok()
    }

    /// Solves for one or two right-hand sides, one after the other in `right`, by the last factorisation.
    pub fn solve(&mut self, right: &mut [f64]) {
        let size = self.matrix.nrows();
        let columns = right.len() / size.max(1);
        let factor = LltRef::new(&self.symbolic, &self.factor);
        let right = MatMut::from_column_major_slice_mut(right, size, columns);
        factor.solve_in_place_with_conj(Conj::No, right, Par::Seq, MemStack::new(&mut self.memory));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The stiffness of a grid of springs: factorised in the order found, it solves; another one of the same
    /// pattern does too.
    #[test]
    fn matrices_of_one_pattern_are_analysed_once() {
        let side = 12;
        let node = |x: usize, y: usize| x * side + y;
        let mut edges = Vec::new();
        for x in 0..side {
            for y in 1..side {
                edges.push((node(x, y - 1), node(x, y)));
                edges.push((node(y, x), node(y - 1, x)));
            }
        }
        let order = elimination_order(side * side, &edges).unwrap();
        let mut place = vec![usize::MAX; order.len()];
        order.iter().enumerate().for_each(|(i, &node)| place[node] = i);
        assert!(place.iter().all(|p| *p != usize::MAX));
        let mut columns: Vec<Vec<usize>> = (0..side * side).map(|i| vec![i]).collect();
        let pairs: Vec<(usize, usize)> = edges.iter().map(|&(a, b)| (place[a], place[b])).collect();
        pairs.iter().for_each(|&(a, b)| columns[a.max(b)].push(a.min(b)));
        let mut cholesky = SparseCholesky::new(columns).unwrap();
        for stiffness in [1.0, 37.0] {
            let size = side * side;
            let mut dense = vec![0.0; size * size];
            cholesky.values().fill(0.0);
            let springs = pairs.iter().map(|&(a, b)| (a, b, stiffness)).chain((0..size).map(|i| (i, i, 0.5)));
            for (a, b, k) in springs {
                let entries =
                    if a == b { vec![(a, a, k)] } else { vec![(a, a, k), (b, b, k), (a.min(b), a.max(b), -k)] };
                for (i, j, k) in entries {
                    let at = cholesky.place(i, j).unwrap();
                    cholesky.values()[at] += k;
                    dense[i * size + j] += k;
                    if i != j {
                        dense[j * size + i] += k;
                    }
                }
            }
            assert!(cholesky.factorise());
            let x: Vec<f64> = (0..2 * size).map(|i| (i as f64 * 0.7).sin()).collect();
            let mut right = vec![0.0; 2 * size];
            for k in 0..2 {
                for i in 0..size {
                    right[k * size + i] = (0..size).map(|j| dense[i * size + j] * x[k * size + j]).sum();
                }
            }
            cholesky.solve(&mut right);
            assert!(right.iter().zip(&x).all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }
}
