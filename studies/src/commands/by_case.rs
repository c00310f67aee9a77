//! Solving the cases of a study into lines of a journal, so that nothing is held and nothing finished is lost.

use super::case_lines::CaseLines;
use super::codes::{NO_ACCESS, complain};
use super::folder::{JOURNAL, ResultFolder};
use super::options::{Options, useful_jobs};
use super::progress::Progress;
use crate::kinds::{CasesOf, kind};
use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;
use voussoir_core::limit::Status;

/// Says that a file cannot be read or written.
pub fn no_access(path: &Path, why: impl std::fmt::Display) -> u8 {
    complain(format_args!("voussoir: {}: {why}", path.display()));
    NO_ACCESS
}

/// Solves cases; with `--resume` only those that are not finished in the journal. The lines of all of them, in order.
pub fn solve_into_journal(
    cases: &CasesOf<'_>,
    name: &str,
    ids: &[usize],
    folder: &ResultFolder,
    options: &Options,
) -> Result<CaseLines, u8> {
    let path = folder.path().join(JOURNAL);
    let journal = folder.journal(options.resume).ok_or(NO_ACCESS)?;
    let mut own = journal.try_clone().map_err(|error| no_access(&path, error))?;
    let before = journal.metadata().map_err(|error| no_access(&path, error))?.len();
    let mut lines = CaseLines::default();
    if options.resume {
        let wanted = |id: usize| ids.binary_search(&id).is_ok();
        let same = |id: usize, hash: &str| cases.case(id).is_some_and(|case| case.hash() == hash);
        let mut take = |head: &super::case_lines::LineHead| {
            wanted(head.id) && head.status != Status::Stalled && !makes_cases(cases) && same(head.id, &head.case_hash)
        };
        lines.add(&path, 0, &mut take).map_err(|error| no_access(&path, error))?;
    }
    let finished: BTreeSet<usize> = lines.ids().collect();
    let rest: Vec<usize> = ids.iter().copied().filter(|id| !finished.contains(id)).collect();
    let progress = Progress::new(name, options.shown(), Some(journal));
    let mut failed = None;
    cases.solve(&rest, useful_jobs(options.jobs), &progress, &mut |case| {
        // Those of the study are in the journal since they were answered.
        if case.label.id >= cases.count() {
            let line = serde_json::to_string(&case).map_err(std::io::Error::from);
            failed = line.and_then(|line| own.write_all(format!("{line}\n").as_bytes())).err().or(failed.take());
        }
    });
    progress.finish();
    if let Some(error) = failed {
        return Err(no_access(&path, error));
    }
    lines.add(&path, before, &mut |_| true).map_err(|error| no_access(&path, error))?;
    lines.sort();
    Ok(lines)
}

/// Whether the study's kind makes cases besides those of the file: then a finished case does not tell which of them are.
fn makes_cases(cases: &CasesOf<'_>) -> bool {
    match cases {
        CasesOf::Held(study) => kind(&study.kind).is_some_and(|kind| kind.makes_cases()),
        CasesOf::Streamed(_) => false,
    }
}
