//! The finished cases of a study in order of id. Only a few are in memory at a time.

use super::case_result::CaseResult;
use std::collections::BTreeSet;
use std::io;

/// Receives a few cases at a time.
pub type TakeCases<'a> = &'a mut dyn FnMut(&[CaseResult]) -> io::Result<()>;

/// Finished cases.
pub trait FinishedCases {
    /// Passes all cases to `take`, a few at a time.
    ///
    /// # Errors
    /// If the cases cannot be read, or if `take` returns an error.
    fn each(&self, take: TakeCases) -> io::Result<()>;

    /// Passes the cases with these ids to `take`, a few at a time.
    ///
    /// # Errors
    /// If the cases cannot be read, or if `take` returns an error.
    fn each_of(&self, ids: &BTreeSet<usize>, take: TakeCases) -> io::Result<()> {
        if ids.is_empty() {
            return Ok(());
        }
        let mut one = |case: &CaseResult| ids.contains(&case.label.id).then(|| take(std::slice::from_ref(case)));
        self.each(&mut |cases| cases.iter().filter_map(&mut one).collect())
    }
}

impl FinishedCases for [CaseResult] {
    fn each(&self, take: TakeCases) -> io::Result<()> {
        take(self)
    }
}
