//! Runs a study from a program: typed results, an observer, no files.

use crate::cases::{Observer, Unobserved};
use crate::results::{CaseResult, StudyResults};
use crate::study::Study;

/// Options of a run.
#[derive(Clone, Copy)]
pub struct RunOptions<'a> {
    /// Ids of the cases; `None` for all.
    pub cases: Option<&'a [usize]>,
    /// Number of cases in parallel; results do not depend on it.
    pub jobs: usize,
    /// Observer, which may cancel.
    pub observer: &'a dyn Observer,
}

impl Default for RunOptions<'_> {
    fn default() -> Self {
        RunOptions { cases: None, jobs: 1, observer: &Unobserved }
    }
}

impl Study {
    /// Solves every case, one after the other. The outcome of a case is its [status](crate::results::CaseResult::status), never
    /// an error.
    pub fn run(&self) -> StudyResults {
        self.run_with(&RunOptions::default())
    }

    /// Solves the requested cases; ids that the study does not have are ignored.
    pub fn run_with(&self, options: &RunOptions) -> StudyResults {
        let known = |id: &usize| *id < self.count();
        let mut wanted: Vec<usize> = match options.cases {
            Some(ids) => ids.iter().copied().filter(known).collect(),
            None => (0..self.count()).collect(),
        };
        wanted.sort_unstable();
        wanted.dedup();
        let mut cases = Vec::new();
        self.solve(&wanted, options.jobs, options.observer, &mut |case| cases.push(case));
        cases.sort_by_key(|case: &CaseResult| case.label.id);
        self.results(env!("CARGO_PKG_VERSION"), cases)
    }
}
