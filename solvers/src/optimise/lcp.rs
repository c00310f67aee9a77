//! Lemke's pivoting for linear complementarity problems: w = q + M z ≥ 0, z ≥ 0, z·w = 0.
//!
//! Lemke (1965), with a lexicographic ratio test, so that degenerate ties cannot cycle. A secondary ray proves that no
//! solution exists only for copositive-plus matrices.

use nalgebra::{DMatrix, DVector};

/// w = `constant` + `matrix` z, w ≥ 0, z ≥ 0, z·w = 0.
#[derive(Debug, Clone)]
pub struct Lcp {
    /// M.
    pub matrix: DMatrix<f64>,
    /// q.
    pub constant: DVector<f64>,
}

/// The result of Lemke's algorithm.
#[derive(Debug, Clone, PartialEq)]
pub enum LemkeResult {
    /// A solution z.
    Solution(Vec<f64>),
    /// A secondary ray: the direction in z along which almost complementary solutions continue.
    Ray(Vec<f64>),
    /// Too many pivots.
    Unfinished,
}

/// Runs Lemke's algorithm and counts its `pivots`.
pub fn lemke(problem: &Lcp, pivots: &mut u64) -> LemkeResult {
    let Lcp { matrix: m, constant: q } = problem;
    let n = q.len();
    let scale = q.amax();
    if q.iter().all(|v| *v >= 0.0) || scale == 0.0 {
        return LemkeResult::Solution(vec![0.0; n]);
    }
    // Tableau [I, −M, −1 | q] in the order w (0..n), z (n..2n), z_0 (2n), right-hand side (2n + 1). The columns of w
    // are the inverse of the basis, which the lexicographic rule uses.
    let last = 2 * n + 1;
    let mut t = DMatrix::<f64>::zeros(n, last + 1);
    for i in 0..n {
        t[(i, i)] = 1.0;
        for j in 0..n {
            t[(i, n + j)] = -m[(i, j)];
        }
        t[(i, 2 * n)] = -1.0;
        t[(i, last)] = q[i] / scale;
    }
    let mut basis: Vec<usize> = (0..n).collect();
    let mut row = (0..n).min_by(|a, b| t[(*a, last)].total_cmp(&t[(*b, last)])).unwrap_or(0);
    let mut entering = 2 * n;
    for _ in 0..50 * n + 100 {
        let pivot_row = t.row(row) / t[(row, entering)];
        let column = t.column(entering).clone_owned();
        for i in (0..n).filter(|i| *i != row && column[*i] != 0.0) {
            for j in 0..=last {
                t[(i, j)] -= column[i] * pivot_row[j];
            }
        }
        t.set_row(row, &pivot_row);
        *pivots += 1;
        let leaving = std::mem::replace(&mut basis[row], entering);
        if leaving == 2 * n {
            let mut z = vec![0.0; n];
            for (i, variable) in basis.iter().enumerate().filter(|(_, v)| (n..2 * n).contains(*v)) {
                z[variable - n] = t[(i, last)].max(0.0) * scale;
            }
            return LemkeResult::Solution(z);
        }
        entering = if leaving < n { leaving + n } else { leaving - n };
        let size = t.column(entering).amax();
        let candidates: Vec<usize> = (0..n).filter(|i| t[(*i, entering)] > 1e-11 * size.max(1.0)).collect();
        if candidates.is_empty() {
            let mut z = vec![0.0; n];
            if entering >= n {
                z[entering - n] = 1.0;
            }
            for (i, variable) in basis.iter().enumerate().filter(|(_, v)| (n..2 * n).contains(*v)) {
                z[variable - n] = -t[(i, entering)];
            }
            return LemkeResult::Ray(z);
        }
        row = least_ratio(&t, &candidates, entering, &basis);
    }
    LemkeResult::Unfinished
}

/// Returns the row with the least ratio; ties are decided by the lexicographic order of the rows of the basis inverse.
/// The artificial variable leaves as soon as possible.
fn least_ratio(t: &DMatrix<f64>, candidates: &[usize], entering: usize, basis: &[usize]) -> usize {
    let n = basis.len();
    let ratio = |row: usize, column: usize| t[(row, column)] / t[(row, entering)];
    let differs = |a: f64, b: f64| (a - b).abs() > 1e-12 * a.abs().max(b.abs()).max(1e-3);
    let mut best = candidates[0];
    for &i in &candidates[1..] {
        let (a, b) = (ratio(i, 2 * n + 1), ratio(best, 2 * n + 1));
        if differs(a, b) {
            if a < b {
                best = i;
            }
        } else if basis[i] == 2 * n {
            best = i;
        } else if basis[best] != 2 * n
            && let Some(column) = (0..n).find(|column| differs(ratio(i, *column), ratio(best, *column)))
            && ratio(i, column) < ratio(best, column)
        {
            best = i;
        }
    }
    best
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_monotone_problem_is_solved_and_an_infeasible_one_ends_in_a_ray() {
        let m = DMatrix::from_row_slice(2, 2, &[2.0, 1.0, 1.0, 2.0]);
        let LemkeResult::Solution(z) = lemke(&Lcp { matrix: m, constant: DVector::from_vec(vec![-5.0, -6.0]) }, &mut 0)
        else {
            panic!()
        };
        assert!((z[0] - 4.0 / 3.0).abs() < 1e-14 && (z[1] - 7.0 / 3.0).abs() < 1e-14);
        let flat = DMatrix::from_row_slice(1, 1, &[0.0]);
        assert_eq!(
            lemke(&Lcp { matrix: flat, constant: DVector::from_vec(vec![-1.0]) }, &mut 0),
            LemkeResult::Ray(vec![1.0])
        );
    }
}
