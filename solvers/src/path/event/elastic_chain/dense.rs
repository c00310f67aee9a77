//! Products of small dense matrices with few columns.

use faer::traits::pulp::Arch;
use nalgebra::DMatrix;

/// out += A x over the first rows and columns of A, four columns at a time; zeros of x cost nothing.
pub fn add_product(out: &mut [f64], a: &DMatrix<f64>, x: &[f64]) {
    Arch::new().dispatch(|| add_columns(out, a.nrows(), a.as_slice(), x));
}

/// The same with the vectors of the processor; the order of operations does not depend on them.
#[inline(always)]
fn add_columns(out: &mut [f64], rows: usize, a: &[f64], x: &[f64]) {
    let height = out.len();
    let mut columns = a.chunks_exact(rows).zip(x).filter(|(_, x)| **x != 0.0);
    loop {
        let next: [Option<(&[f64], &f64)>; 4] = std::array::from_fn(|_| columns.next());
        if let [Some((a, w)), Some((b, x)), Some((c, y)), Some((d, z))] = next {
            let (a, b, c, d) = (&a[..height], &b[..height], &c[..height], &d[..height]);
            for (i, out) in out.iter_mut().enumerate() {
                *out += (a[i] * w + b[i] * x) + (c[i] * y + d[i] * z);
            }
            continue;
        }
        for (a, x) in next.into_iter().flatten() {
            out.iter_mut().zip(a).for_each(|(out, a)| *out += a * x);
        }
        return;
    }
}

/// Dot product in four sums.
#[inline(always)]
pub fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (a4, b4) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = a4.remainder().iter().zip(b4.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a4.zip(b4) {
        for k in 0..4 {
            sums[k] += a[k] * b[k];
        }
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3]) + rest
}

/// A times columns, of which the first entries count.
pub fn product(a: &DMatrix<f64>, columns: &DMatrix<f64>) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(a.nrows(), columns.ncols());
    Arch::new().dispatch(|| {
        let each = out.as_mut_slice().chunks_exact_mut(a.nrows()).zip(columns.as_slice().chunks_exact(columns.nrows()));
        each.for_each(|(out, x)| add_columns(out, a.nrows(), a.as_slice(), x));
    });
    out
}

/// Rows, given as columns, times A, again as columns: of A's rows as many count as they have entries.
pub fn row_product(rows: &DMatrix<f64>, a: &DMatrix<f64>) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(a.ncols(), rows.ncols());
    Arch::new().dispatch(|| {
        let each = out.as_mut_slice().chunks_exact_mut(a.ncols()).zip(rows.as_slice().chunks_exact(rows.nrows()));
        for (out, row) in each {
            for (out, column) in out.iter_mut().zip(a.as_slice().chunks_exact(a.nrows())) {
                *out = dot(row, &column[..row.len()]);
            }
        }
    });
    out
}

/// A += a bᵀ.
pub fn add_outer(target: &mut DMatrix<f64>, a: &DMatrix<f64>, b: &DMatrix<f64>) {
    let (height, rows) = (target.nrows(), a.nrows());
    Arch::new().dispatch(|| {
        let mut factors = vec![0.0; a.ncols()];
        for (j, column) in target.as_mut_slice().chunks_exact_mut(height).enumerate() {
            factors.iter_mut().enumerate().for_each(|(i, f)| *f = b[(j, i)]);
            match factors.as_slice() {
                [0.0, 0.0] => {}
                [f, g] => {
                    let (a, b) = a.as_slice().split_at(height);
                    column.iter_mut().zip(a.iter().zip(b)).for_each(|(t, (a, b))| *t += a * f + b * g);
                }
                _ => add_columns(column, rows, a.as_slice(), &factors),
            }
        }
    });
}
