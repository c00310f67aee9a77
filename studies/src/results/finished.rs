//! Finished cases of a study in order of id, wherever they are: none is held longer than it is needed.

use super::case_result::CaseResult;
use std::collections::BTreeSet;
use std::io;

/// Receives a few cases.
pub type TakeCases<'a> = &'a mut dyn FnMut(&[CaseResult]) -> io::Result<()>;

/// Finished cases.
pub trait FinishedCases {
    /// Hands all cases over, a few at a time.
    ///
    /// # Errors
    /// If they cannot be read, and the errors of `take`.
    fn each(&self, take: TakeCases) -> io::Result<()>;

    /// Hands the cases with these ids over, a few at a time.
    ///
    /// # Errors
    /// If they cannot be read, and the errors of `take`.
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
