//! L U factors of small dense matrices with partial pivoting, for A x = b and Aᵀ x = b, without allocation.

use crate::linear::inner;

/// Calls a function with a size and its other arguments. The sizes of an arch (three redundants with a factor, a margin
/// or both) are constants, so that the compiler unrolls the loops.
macro_rules! of_size {
    ($size:expr, $function:ident($($argument:ident),+)) => {
        match $size {
            4 => $function(4, $($argument),+),
            5 => $function(5, $($argument),+),
            n => $function(n, $($argument),+),
        }
    };
}

/// Factors of one matrix; all matrices have the same size.
#[derive(Debug, Clone)]
pub struct SmallLu {
    size: usize,
    /// U, and L below the diagonal, stored by rows.
    values: Vec<f64>,
    /// Rows of the matrix in the order of pivots.
    order: Vec<usize>,
    /// Work copy of a right-hand side.
    copy: Vec<f64>,
}

impl SmallLu {
    /// Creates factors for matrices of this size.
    pub fn new(size: usize) -> Self {
        SmallLu { size, values: vec![0.0; size * size], order: (0..size).collect(), copy: vec![0.0; size] }
    }

    /// Factorises a matrix given by columns. Returns true if it has an inverse.
    pub fn factorise(&mut self, columns: &[f64]) -> bool {
        self.order.iter_mut().enumerate().for_each(|(i, row)| *row = i);
        let (values, order) = (self.values.as_mut_slice(), self.order.as_mut_slice());
        of_size!(self.size, factorise(values, order, columns))
    }

    /// Solves A x = b in place.
    pub fn solve(&mut self, b: &mut [f64]) {
        self.copy.copy_from_slice(b);
        let (values, order, right) = (self.values.as_slice(), self.order.as_slice(), self.copy.as_slice());
        of_size!(self.size, solve(values, order, right, b));
    }

    /// Solves Aᵀ x = b in place.
    pub fn solve_transposed(&mut self, b: &mut [f64]) {
        self.copy.copy_from_slice(b);
        let (values, order, y) = (self.values.as_slice(), self.order.as_slice(), self.copy.as_mut_slice());
        of_size!(self.size, solve_transposed(values, order, y, b));
    }
}

#[inline(always)]
fn factorise(n: usize, values: &mut [f64], order: &mut [usize], columns: &[f64]) -> bool {
    let (values, order) = (&mut values[..n * n], &mut order[..n]);
    for (j, column) in columns.chunks_exact(n).enumerate() {
        column.iter().enumerate().for_each(|(i, v)| values[i * n + j] = *v);
    }
    for k in 0..n {
        let size = |row: usize| values[row * n + k].abs();
        let pivot = (k..n).fold(k, |best, row| if size(row) > size(best) { row } else { best });
        if pivot != k {
            let (upper, lower) = values.split_at_mut(pivot * n);
            upper[k * n..(k + 1) * n].swap_with_slice(&mut lower[..n]);
            order.swap(k, pivot);
        }
        let (upper, lower) = values.split_at_mut((k + 1) * n);
        let row = &upper[k * n..];
        if row[k] == 0.0 || !row[k].is_finite() {
            return false;
        }
        for below in lower.chunks_exact_mut(n) {
            let factor = below[k] / row[k];
            below[k] = factor;
            below[k + 1..].iter_mut().zip(&row[k + 1..n]).for_each(|(b, r)| *b -= factor * r);
        }
    }
    true
}

#[inline(always)]
fn solve(n: usize, values: &[f64], order: &[usize], right: &[f64], b: &mut [f64]) {
    let (values, order, right, b) = (&values[..n * n], &order[..n], &right[..n], &mut b[..n]);
    for i in 0..n {
        let row = &values[i * n..(i + 1) * n];
        let known = inner(&row[..i], &b[..i]);
        b[i] = right[order[i]] - known;
    }
    for i in (0..n).rev() {
        let row = &values[i * n..(i + 1) * n];
        let known = inner(&row[i + 1..], &b[i + 1..]);
        b[i] = (b[i] - known) / row[i];
    }
}

#[inline(always)]
fn solve_transposed(n: usize, values: &[f64], order: &[usize], y: &mut [f64], b: &mut [f64]) {
    let (values, order, y, b) = (&values[..n * n], &order[..n], &mut y[..n], &mut b[..n]);
    for i in 0..n {
        let row = &values[i * n..(i + 1) * n];
        let x = y[i] / row[i];
        y[i] = x;
        y[i + 1..].iter_mut().zip(&row[i + 1..]).for_each(|(y, u)| *y -= u * x);
    }
    for i in (0..n).rev() {
        let x = y[i];
        let row = &values[i * n..i * n + i];
        y[..i].iter_mut().zip(row).for_each(|(y, l)| *y -= l * x);
    }
    order.iter().zip(y.iter()).for_each(|(row, x)| b[*row] = *x);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The products with both solutions give the right-hand sides; a singular matrix is detected.
    #[test]
    fn both_systems_are_solved() {
        for n in [3, 4, 5, 6] {
            is_solved(n);
        }
        let singular = |n: usize| {
            let mut columns = vec![1.0; n * n];
            columns[0] = 2.0;
            let mut lu = SmallLu::new(n);
            !lu.factorise(&columns) || lu.values[n * n - 1].abs() < 1e-15
        };
        assert!([3, 4, 5, 6].into_iter().all(singular) && !SmallLu::new(2).factorise(&[0.0; 4]));
    }

    fn is_solved(n: usize) {
        // Sines of k² are used because sines of k give rank two.
        let columns: Vec<f64> = (0..n * n).map(|k| ((k * k) as f64 * 0.7 + 0.3).sin()).collect();
        let mut lu = SmallLu::new(n);
        assert!(lu.factorise(&columns));
        let right: Vec<f64> = (0..n).map(|k| (k as f64 + 0.5).cos()).collect();
        let (mut x, mut y) = (right.clone(), right.clone());
        lu.solve(&mut x);
        lu.solve_transposed(&mut y);
        for i in 0..n {
            let own: f64 = (0..n).map(|j| columns[j * n + i] * x[j]).sum();
            let transposed: f64 = (0..n).map(|j| columns[i * n + j] * y[j]).sum();
            assert!((own - right[i]).abs() < 1e-13 && (transposed - right[i]).abs() < 1e-13);
        }
    }
}
