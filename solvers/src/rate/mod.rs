//! The rate problem of both path solvers: the modes that contact points take next. [`problem`] holds its data;
//! [`answer`] finds the rate that continues a path, or proves that no rate does.

pub(crate) mod admits;
pub(crate) mod answer;
pub(crate) mod arrival;
pub(crate) mod choice;
pub(crate) mod counts;
pub(crate) mod lcp;
pub(crate) mod mechanism;
pub(crate) mod neighbours;
pub(crate) mod order;
pub(crate) mod problem;
pub(crate) mod proof;
pub(crate) mod stability;
#[cfg(test)]
mod tests;
pub(crate) mod tree;
