//! Dense operations on three columns at a time, with vector instructions of the processor.
//!
//! Columns of a panel are stored one after the other; each has the height of the panel.

use super::vectors::Simd;

/// Number of unknowns of a node.
pub const NODE: usize = 3;
/// Numbers that [`outer_products`] may read and write beyond `count`: the length of a vector minus one.
pub const SPARE: usize = 7;

/// For each of the first three rows of a panel, sums over its columns the entry in that row times `count` rows of the
/// column. Columns are `height` numbers apart. The result is three columns of `count` + [`SPARE`] numbers.
#[inline(always)]
pub fn outer_products<S: Simd>(
    simd: S,
    out: &mut [f64],
    panel: &[f64],
    (height, columns): (usize, usize),
    count: usize,
) {
    let width = size_of::<S::f64s>() / size_of::<f64>();
    let mut row = 0;
    while row + 2 * width < count {
        products_of_rows::<S, 3>(simd, out, panel, (height, columns), (row, count));
        row += 3 * width;
    }
    if row + width < count {
        products_of_rows::<S, 2>(simd, out, panel, (height, columns), (row, count));
    } else if row < count {
        products_of_rows::<S, 1>(simd, out, panel, (height, columns), (row, count));
    }
}

/// The same for a number of vectors of rows.
#[inline(always)]
fn products_of_rows<S: Simd, const VECTORS: usize>(
    simd: S,
    out: &mut [f64],
    panel: &[f64],
    (height, columns): (usize, usize),
    (row, count): (usize, usize),
) {
    let rows = row..row + VECTORS * (size_of::<S::f64s>() / size_of::<f64>());
    let mut sums = [[simd.splat_f64s(0.0); VECTORS]; NODE];
    for column in 0..columns {
        let panel = &panel[column * height..];
        let (own, _) = S::as_simd_f64s(&panel[rows.clone()]);
        for (sums, by) in sums.iter_mut().zip(&panel[..NODE]) {
            let by = simd.splat_f64s(*by);
            sums.iter_mut().zip(own).for_each(|(sum, own)| *sum = simd.mul_add_e_f64s(*own, by, *sum));
        }
    }
    for (out, sums) in out.chunks_exact_mut(count + SPARE).zip(&sums) {
        let (out, _) = S::as_mut_simd_f64s(&mut out[rows.clone()]);
        out.iter_mut().zip(sums).for_each(|(out, sum)| *out = *sum);
    }
}

/// Computes L of three columns from their diagonal on. The diagonal of the result holds reciprocals, computed by
/// `reciprocal` from the pivots. Returns true if all of them are finite and positive.
#[inline(always)]
pub fn eliminate<S: Simd>(simd: S, columns: [&mut [f64]; NODE], reciprocal: impl Fn(f64) -> f64) -> bool {
    let [a, b, c] = columns;
    let r0 = reciprocal(a[0]);
    let (l10, l20) = (a[1] * r0, a[2] * r0);
    let r1 = reciprocal(b[1] - l10 * l10);
    let l21 = (b[2] - l20 * l10) * r1;
    let r2 = reciprocal(c[2] - l20 * l20 - l21 * l21);
    (a[0], a[1], a[2], b[1], b[2], c[2]) = (r0, l10, l20, r1, l21, r2);
    let ((a, p), (b, q), (c, r)) =
        (S::as_mut_simd_f64s(&mut a[NODE..]), S::as_mut_simd_f64s(&mut b[NODE..]), S::as_mut_simd_f64s(&mut c[NODE..]));
    let [s0, s1, s2, t10, t20, t21] = [r0, r1, r2, l10, l20, l21].map(|v| simd.splat_f64s(v));
    for ((a, b), c) in a.iter_mut().zip(b).zip(c) {
        *a = simd.mul_f64s(*a, s0);
        *b = simd.mul_f64s(simd.negate_mul_add_e_f64s(*a, t10, *b), s1);
        let rest = simd.negate_mul_add_e_f64s(*a, t20, *c);
        *c = simd.mul_f64s(simd.negate_mul_add_e_f64s(*b, t21, rest), s2);
    }
    for ((a, b), c) in p.iter_mut().zip(q).zip(r) {
        *a *= r0;
        *b = (*b - *a * l10) * r1;
        *c = (*c - *a * l20 - *b * l21) * r2;
    }
    [r0, r1, r2].iter().all(|r| r.is_finite() && *r > 0.0)
}

/// Computes out −= a x + b y + c z.
#[inline(always)]
pub fn subtract<S: Simd>(simd: S, out: &mut [f64], columns: [&[f64]; NODE], by: [f64; NODE]) {
    let count = out.len();
    let [(a, p), (b, q), (c, r)] = columns.map(|column| S::as_simd_f64s(&column[..count]));
    let [x, y, z] = by.map(|by| simd.splat_f64s(by));
    let (whole, rest) = S::as_mut_simd_f64s(out);
    for (out, ((a, b), c)) in whole.iter_mut().zip(a.iter().zip(b).zip(c)) {
        let first = simd.negate_mul_add_e_f64s(*a, x, *out);
        *out = simd.negate_mul_add_e_f64s(*c, z, simd.negate_mul_add_e_f64s(*b, y, first));
    }
    let [x, y, z] = by;
    for (out, ((a, b), c)) in rest.iter_mut().zip(p.iter().zip(q).zip(r)) {
        *out -= a * x + b * y + c * z;
    }
}

/// Returns a · x, b · x and c · x.
#[inline(always)]
pub fn inner_products<S: Simd>(simd: S, x: &[f64], columns: [&[f64]; NODE]) -> [f64; NODE] {
    let count = x.len();
    let [(a, p), (b, q), (c, r)] = columns.map(|column| S::as_simd_f64s(&column[..count]));
    let (whole, rest) = S::as_simd_f64s(x);
    let mut sums = [simd.splat_f64s(0.0); NODE];
    for (x, ((a, b), c)) in whole.iter().zip(a.iter().zip(b).zip(c)) {
        let [p, q, r] = sums;
        sums = [simd.mul_add_e_f64s(*a, *x, p), simd.mul_add_e_f64s(*b, *x, q), simd.mul_add_e_f64s(*c, *x, r)];
    }
    let mut out = sums.map(|sum| simd.reduce_sum_f64s(sum));
    for (x, ((a, b), c)) in rest.iter().zip(p.iter().zip(q).zip(r)) {
        out = [out[0] + a * x, out[1] + b * x, out[2] + c * x];
    }
    out
}
