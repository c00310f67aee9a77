//! Mechanisms in the relative interior of all optimal mechanisms, for degenerate optima.

use super::simplex::{Column, Program};
use crate::limit::settings::SETTINGS;
use crate::limit::systems::PIVOTS;
use crate::optimise::dense_simplex::{Equations, Feasibility};
use nalgebra::{DMatrix, DVector};

/// Returns the analytic centre of all optimal multipliers {y ≥ 0 : Σ y_i a_i = c} over the rows active at `point`, and
/// true if there is only one. `found` is one of them. The centre does not depend on the scale of rows and is symmetric
/// if the scene is.
pub fn centre(program: &Program, point: &[f64], found: Vec<(Column, f64)>) -> (Vec<(Column, f64)>, bool) {
    let mut columns: Vec<Column> = found.iter().map(|(column, _)| *column).collect();
    for column in program.active(point) {
        if column != Column::Cap && !columns.iter().any(|other| same(*other, column)) {
            columns.push(column);
        }
    }
    let gradients: Vec<DVector<f64>> = columns.iter().map(|&column| program.gradient(column)).collect();
    let matrix = DMatrix::from_columns(&gradients);
    if rank(&matrix) == columns.len() {
        return (found, true);
    }
    let mut start = DVector::zeros(columns.len());
    found.iter().enumerate().for_each(|(i, (_, weight))| start[i] = *weight);
    let Some(interior) = interior_point(&matrix, &start) else {
        return (found, false);
    };
    let scale = interior.amax();
    let support: Vec<usize> = (0..columns.len()).filter(|&i| interior[i] > SETTINGS.active * scale).collect();
    let reduced = matrix.select_columns(&support);
    if rank(&reduced) == support.len() {
        return (found, true);
    }
    let weights = analytic_centre(&reduced, interior.select_rows(&support));
    (support.iter().zip(weights.iter()).map(|(&i, &weight)| (columns[i], weight)).collect(), false)
}

fn same(a: Column, b: Column) -> bool {
    match (a, b) {
        (Column::Tangent { joint, end, .. }, Column::Tangent { joint: j, end: e, .. }) => (joint, end) == (j, e),
        _ => a == b,
    }
}

fn rank(matrix: &DMatrix<f64>) -> usize {
    if matrix.is_empty() {
        return 0;
    }
    let mut scaled = matrix.clone();
    for mut column in scaled.column_iter_mut() {
        let norm = column.norm();
        if norm > 0.0 {
            column /= norm;
        }
    }
    if clearly_independent(&scaled) { matrix.ncols() } else { scaled.svd(false, false).rank(SETTINGS.active) }
}

/// Returns true if columns of length one have no singular value below a thousand times `active`, by their volume: the
/// product of k singular values, each at most √k. If it returns false, nothing is known.
fn clearly_independent(columns: &DMatrix<f64>) -> bool {
    let k = columns.ncols();
    let mut rest = columns.clone();
    let mut volume = 1.0;
    for j in 0..k {
        let norm = rest.column(j).norm();
        volume *= norm;
        if volume.is_nan() || volume <= 1e3 * SETTINGS.active * (k as f64).powf((k - 1) as f64 / 2.0) {
            return false;
        }
        let (before, mut after) = rest.columns_range_pair_mut(j..j + 1, j + 1..);
        let unit = before.column(0) / norm;
        for mut column in after.column_iter_mut() {
            let along = unit.dot(&column);
            column.axpy(-along, &unit, 1.0);
        }
    }
    true
}

/// Returns a point of {y ≥ 0 : A y = A start} with the greatest number of positive entries: the mean of points that
/// each increase one entry as far as possible. `None` if an entry has no bound, or if rounding prevents an answer.
fn interior_point(matrix: &DMatrix<f64>, start: &DVector<f64>) -> Option<DVector<f64>> {
    let k = matrix.ncols();
    let rows = matrix.row_iter().map(|row| row.iter().copied().collect()).collect();
    let right = (matrix * start).as_slice().to_vec();
    let mut program = Equations { free: 0, variables: k, rows, right }.dictionary()?;
    if program.feasible() != Feasibility::Point {
        return None;
    }
    let (mut sum, mut count) = (start.clone(), 1.0);
    for target in 0..k {
        if sum[target] <= SETTINGS.active * sum.amax() {
            program.minimise(&[(target, -1.0)], PIVOTS)?;
            sum += DVector::from_fn(k, |i, _| program.value(i).max(0.0));
            count += 1.0;
        }
    }
    Some(sum / count)
}

/// Newton's method on max Σ log y_i with A y fixed, from a positive start.
fn analytic_centre(matrix: &DMatrix<f64>, start: DVector<f64>) -> DVector<f64> {
    let target = matrix * &start;
    let mut y = start;
    for _ in 0..100 {
        // Step d = Y² (g − Aᵀ ν) with g = 1/y and A d = target − A y.
        let squared = DMatrix::from_diagonal(&y.map(|v| v * v));
        let normal = matrix * &squared * matrix.transpose();
        let residual = &target - matrix * &y;
        let Ok(nu) = normal.svd(true, true).solve(&(matrix * &y - residual), SETTINGS.rounding) else {
            break;
        };
        let step = &y - &squared * matrix.transpose() * nu;
        let largest = (0..y.len()).map(|i| -step[i] / y[i]).fold(0.0, f64::max);
        let length = if largest > 0.9 { 0.9 / largest } else { 1.0 };
        y += &step * length;
        if (0..y.len()).all(|i| step[i].abs() <= SETTINGS.pivot * y[i]) {
            break;
        }
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Columns that the volume bound calls independent have full rank by their singular values.
    #[test]
    fn clearly_independent_columns_have_full_rank() {
        let column =
            |k: usize, seed: f64| DVector::from_fn(4, |i, _| (seed * (7 * i * i + 3 * k + 1) as f64).sin()).normalize();
        for seed in 1..50 {
            let mut columns: Vec<_> = (0..4).map(|k| column(k, seed as f64)).collect();
            for near in [1.0, 1e-3, 1e-7, 1e-12, 0.0] {
                columns[3] = (&columns[0] * 0.3 + &columns[1] + column(3, seed as f64) * near).normalize();
                let matrix = DMatrix::from_columns(&columns);
                let least = matrix.clone().svd(false, false).singular_values.min();
                assert!(!clearly_independent(&matrix) || least > 1e-6, "{seed} {near}: {least}");
                assert!(near > 1e-9 || !clearly_independent(&matrix));
            }
            assert!(clearly_independent(&DMatrix::identity(4, 4)));
        }
        assert!(!clearly_independent(&DMatrix::from_element(3, 4, 0.5)));
    }

    /// The rank is the number of independent directions for all sizes of columns.
    #[test]
    fn the_rank_does_not_depend_on_sizes() {
        let (a, b) = (DVector::from_vec(vec![1.0, 2.0, 0.5]), DVector::from_vec(vec![-1.0, 0.3, 4.0]));
        for size in [1e-9, 1.0, 1e9] {
            let columns = [a.clone(), &b * size, (&a + &b * 2.0) * size];
            assert_eq!(rank(&DMatrix::from_columns(&columns)), 2, "{size}");
        }
        assert_eq!(rank(&DMatrix::zeros(0, 0)), 0);
    }

    /// On y_1 + … + y_n = 1 an interior point has only positive entries, and the analytic centre is 1/n.
    #[test]
    fn the_centre_of_a_simplex_is_its_middle() {
        let matrix = DMatrix::from_element(1, 4, 1.0);
        let corner = DVector::from_vec(vec![0.0, 1.0, 0.0, 0.0]);
        let interior = interior_point(&matrix, &corner).expect("a point");
        assert!(interior.min() > 0.1 && (interior.sum() - 1.0).abs() < 1e-12, "{interior}");
        let centre = analytic_centre(&matrix, interior);
        assert!(centre.iter().all(|y| (y - 0.25).abs() < 1e-9), "{centre}");
    }
}
