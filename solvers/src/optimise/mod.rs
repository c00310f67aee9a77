//! Optimisation methods: dense linear programs, linear complementarity problems, cutting planes.

pub mod cutting_planes;
pub(crate) mod dense_simplex;
pub(crate) mod lcp;
