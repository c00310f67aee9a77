//! Sparse rows, rows in blocks, factorisations with changes of few rows, dense products, equations with a control row.

pub(crate) mod blocks;
pub(crate) mod bordered;
pub(crate) mod chain;
pub(crate) mod condensed;
pub(crate) mod csr;
pub(crate) mod dense;
pub(crate) mod factorised;
pub(crate) mod null_space;
#[cfg(test)]
mod tests;
pub(crate) mod updated;

/// Returns a · b.
pub(crate) fn inner(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// Returns the greatest absolute value.
pub(crate) fn largest(values: &[f64]) -> f64 {
    let eights = values.chunks_exact(8);
    let rest = eights.remainder().iter().fold(0.0, |a: f64, b| a.max(b.abs()));
    let mut lanes = [0.0f64; 8];
    for eight in eights {
        lanes.iter_mut().zip(eight).for_each(|(lane, value)| *lane = lane.max(value.abs()));
    }
    lanes.into_iter().fold(rest, f64::max)
}
