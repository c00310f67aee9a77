//! Functions with the vectors of the processor.
//!
//! A closure does not do: it is compiled by itself, for any processor, wherever it is not taken into its caller.

pub use faer::traits::pulp::{Arch, Simd, WithSimd};

/// `with_vectors!('a, function(name: type, …) -> type)`: calls a function marked `#[inline(always)]` with the vectors of
/// the processor at hand and local variables of these names. The order of operations does not depend on them.
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

/// out += (a w + b x) + (c y + d z).
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
