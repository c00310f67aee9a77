//! The work of rate problems, and the part of the search that decided each of them.

/// Part of the search that decides a rate problem.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Algorithm {
    /// The cells next to the arrival.
    Neighbours,
    /// Lemke's pivoting.
    Pivoting,
    /// The complete search over modes.
    Tree,
}

/// Numbers of decisions of each part, of linear systems and of programs.
#[derive(Debug, Clone, Default)]
pub struct RateCounts {
    /// Linear systems, pivots, programs.
    pub trials: u64,
    /// Problems decided.
    pub decided: std::collections::BTreeMap<Algorithm, u64>,
}

impl Algorithm {
    /// Its name among the counters of an answer.
    pub fn name(self) -> &'static str {
        match self {
            Algorithm::Neighbours => "rates_by_neighbours",
            Algorithm::Pivoting => "rates_by_pivoting",
            Algorithm::Tree => "rates_by_tree",
        }
    }
}
