//! The solution of linear equations that is nearest to a start: a correction to rounding.

use crate::limit::settings::SETTINGS;
use voussoir_core::limit::SparseRow;
use voussoir_core::linear::{Entries, SparseLdlt};

/// Returns the solution of J z = h nearest to `start`, and its greatest residual.
pub fn nearest(rows: &[SparseRow], right: &[f64], start: Vec<f64>) -> Option<(Vec<f64>, f64)> {
    let (n, m) = (start.len(), rows.len());
    let factorised = SparseLdlt::new(n + m, n, &saddle(n, rows.iter(), [1.0, SETTINGS.shift]))?;
    let mut z = start;
    let mut best: Option<(Vec<f64>, f64)> = None;
    for _ in 0..12 {
        let residual: Vec<f64> =
            rows.iter().zip(right).map(|(row, h)| row.iter().map(|&(j, v)| v * z[j]).sum::<f64>() - h).collect();
        let worst = residual.iter().fold(0.0f64, |w, r| w.max(r.abs()));
        if best.as_ref().is_none_or(|b| worst < b.1) {
            best = Some((z.clone(), worst));
        }
        if worst < SETTINGS.exhausted {
            break;
        }
        let mut load = vec![0.0; n];
        load.extend(&residual);
        let step = factorised.solve(&load)?;
        (0..n).for_each(|j| z[j] -= step[j]);
    }
    best
}

/// Returns \[a I, Jᵀ; J, −b I\] with n columns in J.
pub fn saddle<'r>(n: usize, rows: impl Iterator<Item = &'r SparseRow>, [a, b]: [f64; 2]) -> Entries {
    let mut entries: Entries = (0..n).map(|j| (j, j, a)).collect();
    for (i, row) in rows.enumerate() {
        entries.push((n + i, n + i, -b));
        for &(j, v) in row {
            entries.push((n + i, j, v));
            entries.push((j, n + i, v));
        }
    }
    entries
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The solution of x + y = 2 nearest to the origin is (1, 1); contradictory equations leave a residual.
    #[test]
    fn the_nearest_solution_is_found() {
        let row: SparseRow = vec![(0, 1.0), (1, 1.0)];
        let (z, worst) = nearest(std::slice::from_ref(&row), &[2.0], vec![0.0; 2]).expect("a solution");
        assert!(z.iter().all(|x| (x - 1.0).abs() < 1e-12) && worst < 1e-12, "{z:?}");
        let (z, worst) = nearest(std::slice::from_ref(&row), &[2.0], vec![3.0, 1.0]).expect("a solution");
        assert!((z[0] - 2.0).abs() < 1e-12 && z[1].abs() < 1e-12 && worst < 1e-12, "{z:?}");
        let (_, worst) = nearest(&[row.clone(), row], &[2.0, 3.0], vec![0.0; 2]).expect("a best attempt");
        assert!(worst > 0.4, "{worst}");
    }

    /// The matrix with its transposed rows is symmetric, with the shift of both diagonals.
    #[test]
    fn the_saddle_matrix_is_symmetric() {
        let rows: [SparseRow; 2] = [vec![(0, 1.0), (2, -3.0)], vec![(1, 2.0)]];
        let entries = saddle(3, rows.iter(), [0.5, 1e-3]);
        let at = |i, j| entries.iter().filter(|entry| (entry.0, entry.1) == (i, j)).map(|entry| entry.2).sum::<f64>();
        assert!((0..5).all(|i| (0..5).all(|j| at(i, j) == at(j, i))));
        assert_eq!((at(0, 0), at(3, 2), at(4, 1), at(3, 3)), (0.5, -3.0, 2.0, -1e-3));
    }
}
