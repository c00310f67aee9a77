//! Functions that use the vector instructions of the processor.
//!
//! A closure is not enough: unless it is inlined, it is compiled for the baseline processor.

pub use faer::traits::pulp::{Arch, Simd, WithSimd};

/// `with_vectors!('a, function(name: type, …) -> type)` calls a function marked `#[inline(always)]` with the vector
/// instructions of the present processor. Its arguments are local variables of these names. The order of operations
/// does not depend on the processor.
#[macro_export]
macro_rules! with_vectors {
    ($life:lifetime, $function:ident($($name:ident: $kind:ty),+) -> $output:ty) => {{
        struct Call<$life> {
            $($name: $kind),+
        }
        impl<$life> $crate::linear::vectors::WithSimd for Call<$life> {
            type Output = $output;
            #[inline(always)]
            fn with_simd<S: $crate::linear::vectors::Simd>(self, simd: S) -> $output {
                $function(simd, $(self.$name),+)
            }
        }
        $crate::linear::vectors::Arch::new().dispatch(Call { $($name),+ })
    }};
}

/// Computes out += (a w + b x) + (c y + d z).
#[inline(always)]
pub fn add_four<S: Simd>(simd: S, out: &mut [f64], columns: [&[f64]; 4], factors: [f64; 4]) {
    let n = out.len();
    let [(a, p), (b, q), (c, r), (d, s)] = columns.map(|column| S::as_simd_f64s(&column[..n]));
    let [w, x, y, z] = factors.map(|factor| simd.splat_f64s(factor));
    let (whole, rest) = S::as_mut_simd_f64s(out);
    for (out, ((a, b), (c, d))) in whole.iter_mut().zip(a.iter().zip(b).zip(c.iter().zip(d))) {
        let first = simd.add_f64s(simd.mul_f64s(*a, w), simd.mul_f64s(*b, x));
        let second = simd.add_f64s(simd.mul_f64s(*c, y), simd.mul_f64s(*d, z));
        *out = simd.add_f64s(*out, simd.add_f64s(first, second));
    }
    let [w, x, y, z] = factors;
    for (out, ((a, b), (c, d))) in rest.iter_mut().zip(p.iter().zip(q).zip(r.iter().zip(s))) {
        *out += (a * w + b * x) + (c * y + d * z);
    }
}

/// Computes out += A x with A stored column by column, over the first `out.len()` of `rows` rows and as many columns as
/// x has entries, within vectorised code. Zeros of x are skipped.
#[inline(always)]
pub fn add_columns<S: Simd>(simd: S, out: &mut [f64], rows: usize, a: &[f64], x: &[f64]) {
    let (a4, x4) = (a.chunks_exact(4 * rows), x.chunks_exact(4));
    let whole = (a.len() / (4 * rows)).min(x.len() / 4);
    let (a1, x1) = (&a[4 * rows * whole..], &x[4 * whole..]);
    for (a, x) in a4.zip(x4).filter(|(_, x)| **x != [0.0; 4]) {
        let (a, b) = a.split_at(2 * rows);
        let ((a, b), (c, d)) = (a.split_at(rows), b.split_at(rows));
        add_four(simd, out, [a, b, c, d], [x[0], x[1], x[2], x[3]]);
    }
    for (a, x) in a1.chunks_exact(rows).zip(x1).filter(|(_, x)| **x != 0.0) {
        out.iter_mut().zip(a).for_each(|(out, a)| *out += a * x);
    }
}

/// Calls [`add_columns`] from code that is not vectorised.
pub fn add_product(out: &mut [f64], rows: usize, a: &[f64], x: &[f64]) {
    if !out.is_empty() {
        with_vectors!('a, add_columns(out: &'a mut [f64], rows: usize, a: &'a [f64], x: &'a [f64]) -> ());
    }
}

/// Returns the greatest absolute value; NaN does not count.
pub fn largest(values: &[f64]) -> f64 {
    with_vectors!('a, largest_of(values: &'a [f64]) -> f64)
}

#[inline(always)]
fn largest_of<S: Simd>(_: S, values: &[f64]) -> f64 {
    // `f64::max` takes several instructions, because either number may be NaN.
    let greater = |a: f64, b: f64| if b > a { b } else { a };
    let (eights, rest) = values.as_chunks::<8>();
    let mut lanes = [0.0; 8];
    for eight in eights {
        (0..8).for_each(|i| lanes[i] = greater(lanes[i], eight[i].abs()));
    }
    lanes.into_iter().chain(rest.iter().map(|v| v.abs())).fold(0.0, greater)
}
