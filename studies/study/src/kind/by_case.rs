//! The cases of a study, solved one after another or in parts whose results are merged.

use crate::cases::Observer;
use crate::kind::kind;
use crate::results::{CaseLabel, CaseResult};
use crate::side_by_side::side_by_side;
use crate::study::{Case, Study};
use std::borrow::Cow;

/// Number of cases, for each parallel job, that are solved before their results are passed on.
const AT_ONCE: usize = 64;

impl Study {
    /// Returns the case of a result, found by the study's kind.
    pub fn case_of(&self, label: &CaseLabel) -> Option<Cow<'_, Case>> {
        kind(&self.kind)?.case(self, label)
    }

    /// Returns true if the study's kind makes cases besides the cases in the file.
    pub fn makes_cases(&self) -> bool {
        kind(&self.kind).is_some_and(|kind| kind.makes_cases())
    }

    /// Returns the parts of a result that the study's kind needs for its additions.
    pub fn needed(&self, result: &CaseResult) -> CaseResult {
        kind(&self.kind).map_or_else(|| result.brief(), |kind| kind.needed(result))
    }

    /// Returns the part, from 0, of `count` parts of the study in which a case is solved. It depends only on the hash of the
    /// resolved case.
    pub fn part(&self, id: usize, count: usize) -> Option<usize> {
        let hash = u128::from_str_radix(&self.case(id)?.hash(), 16).ok()?;
        // The high bits of FNV-1a are mixed best.
        Some(((hash >> 64) % count as u128) as usize)
    }

    /// Solves cases, `jobs` of them in parallel, and passes the results on in groups: the results of a few cases in order of id,
    /// with the cases that the study's kind makes from them, then the next group. Only one group is in memory.
    pub fn solve(
        &self,
        ids: &[usize],
        jobs: usize,
        observer: &dyn Observer,
        take: &mut (dyn FnMut(CaseResult) + Send),
    ) {
        observer.begins(ids.len());
        self.solve_quietly(ids, jobs, observer, take);
    }

    /// Like [`solve`](Self::solve), without reporting the number of cases to the observer.
    pub fn solve_quietly(
        &self,
        ids: &[usize],
        jobs: usize,
        observer: &dyn Observer,
        take: &mut (dyn FnMut(CaseResult) + Send),
    ) {
        let Some(kind) = kind(&self.kind) else { return };
        // A kind that makes cases solves the cases made from one case in parallel.
        let at_once = if kind.makes_cases() { 1 } else { AT_ONCE * jobs.max(1) };
        side_by_side(jobs, || {
            for ids in ids.chunks(at_once) {
                kind.solve(self, ids, jobs, observer).into_iter().for_each(&mut *take);
            }
        });
    }
}
