//! Optimisation methods: dense linear programs and linear complementarity problems.

pub(crate) mod dense_simplex;
pub(crate) mod lcp;
pub(crate) mod line_search;
