//! One rate problem for both path solvers: which modes contact points take next. The problem is data
//! ([`problem`]); algorithms are free functions; [`solve`] puts them in order and counts who decided.

pub(crate) mod active_set;
pub(crate) mod admits;
// Until a path solver asks it.
#[allow(dead_code)]
pub(crate) mod answer;
pub(crate) mod arrival;
pub(crate) mod branching;
pub(crate) mod choice;
pub(crate) mod cone;
pub(crate) mod enumerate;
pub(crate) mod homotopy;
pub(crate) mod lcp;
pub(crate) mod line_search;
pub(crate) mod mechanism;
pub(crate) mod neighbours;
pub(crate) mod order;
pub(crate) mod problem;
pub(crate) mod proof;
pub(crate) mod solve;
pub(crate) mod stability;
#[cfg(test)]
mod tests;
pub(crate) mod tree;
