//! Functions with the vectors of the processor.
//!
//! A closure does not do: it is compiled by itself, for any processor, wherever it is not taken into its caller.

pub use faer::traits::pulp::{Arch, NullaryFnOnce};

/// `with_vectors!('a, function(name: type, …) -> type)`: calls a function marked `#[inline(always)]` with local variables
/// of these names, compiled for the vectors of the processor at hand. The order of operations does not depend on them.
#[macro_export]
macro_rules! with_vectors {
    ($life:lifetime, $function:ident($($name:ident: $kind:ty),+) -> $output:ty) => {{
        struct Call<$life> {
            $($name: $kind),+
        }
        impl<$life> $crate::linear::vectors::NullaryFnOnce for Call<$life> {
            type Output = $output;
            #[inline(always)]
            fn call(self) -> $output {
                $function($(self.$name),+)
            }
        }
        $crate::linear::vectors::Arch::new().dispatch(Call { $($name),+ })
    }};
}
