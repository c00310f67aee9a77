//! The cases of a study, one by one: solved in parts whose results are put together again.

use super::kind::{CasesOf, kind};
use crate::results::{CaseLabel, CaseResult};
use crate::side_by_side::{in_order, side_by_side};
use crate::solve::{Observer, solve_followed};
use crate::study::Case;
use std::borrow::Cow;

/// Streamed cases that are solved before their results are handed over, for each of those side by side.
const AT_ONCE: usize = 64;

impl<'a> CasesOf<'a> {
    /// Number of cases.
    pub fn count(&self) -> usize {
        match self {
            CasesOf::Held(study) => study.cases.len(),
            CasesOf::Streamed(sweep) => sweep.count(),
        }
    }

    /// The case with this id; `None` beyond the last.
    pub fn case(&self, id: usize) -> Option<Cow<'a, Case>> {
        match self {
            CasesOf::Held(study) => study.cases.get(id).map(Cow::Borrowed),
            CasesOf::Streamed(sweep) if id < sweep.count() => sweep.case(id).ok().map(Cow::Owned),
            CasesOf::Streamed(_) => None,
        }
    }

    /// The case that a result belongs to, also one that the study's kind has made.
    pub fn case_of(&self, label: &CaseLabel) -> Option<Cow<'a, Case>> {
        match self {
            CasesOf::Held(study) => study.case_of(label),
            CasesOf::Streamed(_) => self.case(label.id),
        }
    }

    /// Of `count` parts of the study the one, from 0, in which a case is solved: by the hash of the resolved case, so
    /// that it depends on nothing else.
    pub fn part(&self, id: usize, count: usize) -> Option<usize> {
        let hash = u128::from_str_radix(&self.case(id)?.hash(), 16).ok()?;
        // The high bits of FNV-1a are mixed best.
        Some(((hash >> 64) % count as u128) as usize)
    }

    /// Solves cases, `jobs` of them side by side, and hands the results over in order of id, with those of cases that
    /// the study's kind makes besides. Of streamed cases no more are held than are solved at once.
    pub fn solve(
        &self,
        ids: &[usize],
        jobs: usize,
        observer: &dyn Observer,
        take: &mut (dyn FnMut(CaseResult) + Send),
    ) {
        observer.begins(ids.len());
        match self {
            CasesOf::Held(study) => {
                let mut results =
                    kind(&study.kind).map(|kind| kind.solve(study, ids, jobs, observer)).unwrap_or_default();
                results.sort_by_key(|case| case.label.id);
                results.into_iter().for_each(take);
            }
            CasesOf::Streamed(sweep) => side_by_side(jobs, || {
                for chunk in ids.chunks(AT_ONCE * jobs.max(1)) {
                    let one = |id: &usize| solve_followed(&sweep.case(*id).ok()?, observer);
                    in_order(chunk, one).into_iter().flatten().for_each(&mut *take);
                }
            }),
        }
    }
}
