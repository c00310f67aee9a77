//! Sparse rows, rows in blocks, factorisations with changes of few rows, dense products, equations with a control row.
//!
//! Three methods solve equations of which a few rows have changed since they were factorised. They differ in the
//! knowledge of the new rows:
//!
//! - [`updated`]: the new rows are not known. The right-hand sides of the old rows are the unknowns of a rate problem,
//!   which is a complementarity problem (`event_path`).
//! - `path::newton::solve::nearby`: the new rows are known, but all other rows have changed slightly, too. A small
//!   linear system gives the effect of the new rows, and refinement the effect of the others (`newton_path`, chains).
//! - `path::event::joint_chain::factors`: the inverses of the joints are stored and changed themselves. Later changes
//!   start from the changed inverses, up to a thousand times (`event_path`, chains).
//!
//! [`bordered`] replaces one dense row, which is never part of the factors. In a simplex method each pivot exchanges a
//! column of the basis, so that `optimise::dense_simplex` and `limit::chain` have their own small matrices.

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

pub(crate) use voussoir_core::linear::vectors::largest;

/// Returns a · b.
pub(crate) fn inner(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}
