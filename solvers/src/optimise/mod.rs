//! Optimisation methods: dense linear programs, linear complementarity problems, random numbers.

pub(crate) mod dense_simplex;
pub(crate) mod lcg;
pub(crate) mod lcp;
pub(crate) mod line_search;
