//! Products of small dense matrices with few columns, with SIMD instructions.

use nalgebra::DMatrix;
use voussoir_core::linear::vectors::{self, Simd, add_columns, add_four};
use voussoir_core::with_vectors;

/// Computes out += A x over the first rows and columns of A, four columns at a time; zero entries of x are skipped.
pub fn add_product(out: &mut [f64], a: &DMatrix<f64>, x: &[f64]) {
    vectors::add_product(out, a.nrows(), a.as_slice(), x);
}

/// Computes out += A x, A stored column by column, and adds the absolute values of the terms to `sizes`.
pub fn add_block_and_sizes((out, sizes): (&mut [f64], &mut [f64]), a: &[f64], x: &[f64]) {
    if !out.is_empty() {
        with_vectors!('a, add_columns_and_sizes(out: &'a mut [f64], sizes: &'a mut [f64], a: &'a [f64], x: &'a [f64]) -> ());
    }
}

#[inline(always)]
fn add_columns_and_sizes<S: Simd>(_: S, out: &mut [f64], sizes: &mut [f64], a: &[f64], x: &[f64]) {
    let height = out.len();
    let sizes = &mut sizes[..height];
    let (a2, x2) = (a.chunks_exact(2 * height), x.chunks_exact(2));
    let (a1, x1) = (a2.remainder(), x2.remainder());
    for (a, x) in a2.zip(x2) {
        let ((a, b), (x, y)) = (a.split_at(height), (x[0], x[1]));
        let b = &b[..height];
        for i in 0..height {
            let (p, q) = (a[i] * x, b[i] * y);
            out[i] += p + q;
            sizes[i] += p.abs() + q.abs();
        }
    }
    for (i, a) in a1.iter().enumerate() {
        let p = a * x1[0];
        out[i] += p;
        sizes[i] += p.abs();
    }
}

/// Adds A x and A y to two vectors; each entry of A is read once.
#[inline(always)]
fn add_to_two<S: Simd>(simd: S, (first, second): (&mut [f64], &mut [f64]), a: &[f64], (x, y): (&[f64], &[f64])) {
    let height = first.len();
    let second = &mut second[..height];
    let mut columns = a.chunks_exact(height).zip(x.iter().zip(y)).filter(|(_, (x, y))| **x != 0.0 || **y != 0.0);
    loop {
        let next: [_; 4] = std::array::from_fn(|_| columns.next());
        if let [Some((a, p)), Some((b, q)), Some((c, r)), Some((d, s))] = next {
            let columns = [a, b, c, d];
            add_four(simd, first, columns, [*p.0, *q.0, *r.0, *s.0]);
            add_four(simd, second, columns, [*p.1, *q.1, *r.1, *s.1]);
            continue;
        }
        for (a, (x, y)) in next.into_iter().flatten() {
            for ((first, second), a) in first.iter_mut().zip(second.iter_mut()).zip(a) {
                *first += a * x;
                *second += a * y;
            }
        }
        return;
    }
}

/// Returns a dot product, computed in four sums.
#[inline(always)]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let ((a4, a1), (b4, b1)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    let rest: f64 = a1.iter().zip(b1).map(|(a, b)| a * b).sum();
    for (a, b) in a4.iter().zip(b4) {
        (0..4).for_each(|k| sums[k] += a[k] * b[k]);
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// Returns some columns of a matrix.
pub fn columns_of(a: &DMatrix<f64>, first: usize, count: usize) -> DMatrix<f64> {
    DMatrix::from_column_slice(a.nrows(), count, &a.as_slice()[a.nrows() * first..][..a.nrows() * count])
}

/// Returns A times the first entries of columns.
pub fn product(a: &DMatrix<f64>, columns: &DMatrix<f64>) -> DMatrix<f64> {
    let mut all = DMatrix::zeros(a.nrows(), columns.ncols());
    if all.is_empty() || columns.is_empty() {
        return all;
    }
    let out = &mut all;
    with_vectors!('a, add_matrix(out: &'a mut DMatrix<f64>, a: &'a DMatrix<f64>, columns: &'a DMatrix<f64>) -> ());
    all
}

#[inline(always)]
fn add_matrix<S: Simd>(simd: S, out: &mut DMatrix<f64>, a: &DMatrix<f64>, columns: &DMatrix<f64>) {
    let (rows, entries) = (a.nrows(), columns.nrows());
    let pairs = out.as_mut_slice().chunks_mut(2 * rows).zip(columns.as_slice().chunks(2 * entries));
    for (out, x) in pairs {
        if x.len() == 2 * entries {
            add_to_two(simd, out.split_at_mut(rows), a.as_slice(), x.split_at(entries));
        } else {
            add_columns(simd, out, rows, a.as_slice(), x);
        }
    }
}

/// Returns rows times A. Both are stored as columns; only as many rows of A are used as `rows` has entries.
pub fn row_product(rows: &DMatrix<f64>, a: &DMatrix<f64>) -> DMatrix<f64> {
    let mut all = DMatrix::zeros(a.ncols(), rows.ncols());
    if all.is_empty() || rows.is_empty() {
        return all;
    }
    let out = &mut all;
    with_vectors!('a, set_row_product(out: &'a mut DMatrix<f64>, rows: &'a DMatrix<f64>, a: &'a DMatrix<f64>) -> ());
    all
}

#[inline(always)]
fn set_row_product<S: Simd>(_: S, out: &mut DMatrix<f64>, rows: &DMatrix<f64>, a: &DMatrix<f64>) {
    let each = out.as_mut_slice().chunks_exact_mut(a.ncols()).zip(rows.as_slice().chunks_exact(rows.nrows()));
    for (out, row) in each {
        for (out, column) in out.iter_mut().zip(a.as_slice().chunks_exact(a.nrows())) {
            *out = dot(row, &column[..row.len()]);
        }
    }
}

/// Computes out += f a.
#[inline(always)]
fn add_one<S: Simd>(simd: S, out: &mut [f64], a: &[f64], f: f64) {
    let (a, last) = S::as_simd_f64s(&a[..out.len()]);
    let (whole, rest) = S::as_mut_simd_f64s(out);
    let factor = simd.splat_f64s(f);
    for (out, a) in whole.iter_mut().zip(a) {
        *out = simd.add_f64s(*out, simd.mul_f64s(*a, factor));
    }
    rest.iter_mut().zip(last).for_each(|(out, a)| *out += a * f);
}

/// Computes A += a bᵀ.
pub fn add_outer(target: &mut DMatrix<f64>, a: &DMatrix<f64>, b: &DMatrix<f64>) {
    with_vectors!('a, add_dyads(target: &'a mut DMatrix<f64>, a: &'a DMatrix<f64>, b: &'a DMatrix<f64>) -> ());
}

#[inline(always)]
fn add_dyads<S: Simd>(simd: S, target: &mut DMatrix<f64>, a: &DMatrix<f64>, b: &DMatrix<f64>) {
    let (height, width) = target.shape();
    for (a, b) in a.as_slice().chunks_exact(a.nrows()).zip(b.as_slice().chunks_exact(width)) {
        for (column, f) in target.as_mut_slice().chunks_exact_mut(height).zip(b).filter(|(_, f)| **f != 0.0) {
            add_one(simd, column, a, *f);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Products by pairs of columns (odd numbers and zeros included) and by rows agree with the definition.
    #[test]
    fn products_are_those_of_the_definition() {
        let a = DMatrix::from_fn(7, 9, |i, j| ((3 * i + 5 * j * j + 1) as f64).sin());
        let b = DMatrix::from_fn(9, 3, |i, j| if (i + j) % 3 == 0 { 0.0 } else { ((i * j + 2) as f64).cos() });
        let close = |x: &DMatrix<f64>, y: DMatrix<f64>| (x - y).amax() < 1e-14;
        assert!(close(&product(&a, &b), &a * &b));
        assert!(close(&row_product(&a.columns(0, 3).clone_owned(), &a), a.transpose() * a.columns(0, 3)));
        let empty = DMatrix::zeros(0, 3);
        assert_eq!(product(&a.columns(0, 0).clone_owned(), &empty), DMatrix::zeros(7, 3));
        assert_eq!(product(&a.rows(0, 0).clone_owned(), &b), empty);
        assert_eq!(row_product(&empty, &a.rows(0, 0).clone_owned()), DMatrix::zeros(9, 3));
        let mut sum = a.clone();
        add_outer(&mut sum, &a.columns(0, 2).clone_owned(), &b.columns(0, 2).clone_owned());
        assert!(close(&sum, &a + a.columns(0, 2) * b.columns(0, 2).transpose()));
    }
}
