//! One rate problem for both path solvers: which modes contact points take next. The problem is data
//! ([`problem`]); algorithms are free functions; [`solve`] puts them in order and counts who decided.

pub(crate) mod active_set;
pub(crate) mod branching;
pub(crate) mod cone;
pub(crate) mod enumerate;
pub(crate) mod homotopy;
pub(crate) mod lcp;
pub(crate) mod line_search;
pub(crate) mod mechanism;
pub(crate) mod problem;
pub(crate) mod solve;
#[cfg(test)]
mod tests;
