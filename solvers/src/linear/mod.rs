//! Sparse rows, rows in blocks, factorisations that follow changes of few rows, small dense products, equations bordered by a control.

pub(crate) mod blocks;
pub(crate) mod bordered;
pub(crate) mod chain;
pub(crate) mod condensed;
pub(crate) mod csr;
pub(crate) mod dense;
pub(crate) mod factorised;
pub(crate) mod updated;
pub(crate) mod updated_inverse;

/// a · b.
pub(crate) fn inner(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
