//! Solving the cases of a study into lines of a journal, so that nothing is held and nothing finished is lost.

use super::case_lines::{CaseLines, LineHead};
use super::error::CliError;
use super::folder::{JOURNAL, ResultFolder};
use super::options::{Options, useful_jobs};
use super::print::say;
use super::progress::Progress;
use crate::kinds::{Backing, BackingCount, CasesOf, kind, resumed};
use crate::results::case_with_path::{CaseWithPath, read_case};
use crate::results::sealed_line::sealed;
use crate::side_by_side::{in_order, side_by_side, threads};
use std::collections::BTreeSet;
use std::io::Write;
use voussoir_core::limit::Status;

/// Solves cases; with `--resume` only those that are not finished in the journal. The lines of all of them, in order.
pub fn solve_into_journal(
    cases: &CasesOf<'_>,
    name: &str,
    ids: &[usize],
    folder: &ResultFolder,
    options: &Options,
) -> Result<CaseLines, CliError> {
    let path = folder.path().join(JOURNAL);
    let journal = folder
        .journal(options.resume)
        .ok_or_else(|| CliError::unwritten(&path, "it is no regular file that can be written"))?;
    let mut own = journal.try_clone().map_err(|error| CliError::of_file(&path, error))?;
    let before = journal.metadata().map_err(|error| CliError::of_file(&path, error))?.len();
    let mut lines = CaseLines::default();
    if options.resume {
        let wanted = |id: usize| ids.binary_search(&id).is_ok();
        let mut take = |head: &LineHead| wanted(head.id) && head.status != Status::Stalled && !makes_cases(cases);
        let damaged = lines.add(&path, 0, &mut take).map_err(|error| CliError::of_file(&path, error))?;
        let told = keep_proved(cases, &mut lines, damaged, useful_jobs(options.jobs));
        let told = told.map_err(|error| CliError::of_file(&path, error))?;
        if !options.quiet && !options.json {
            told.into_iter().for_each(say);
        }
    }
    let finished: BTreeSet<usize> = lines.ids().collect();
    let rest: Vec<usize> = ids.iter().copied().filter(|id| !finished.contains(id)).collect();
    let progress = Progress::new(name, options.shown(), Some(journal));
    let mut failed = None;
    cases.solve(&rest, useful_jobs(options.jobs), &progress, &mut |case| {
        // Those of the study are in the journal since they were answered.
        if case.label.id >= cases.count() {
            let line = sealed(&CaseWithPath(&case)).map_err(std::io::Error::from);
            failed = line.and_then(|line| own.write_all(&line)).err().or(failed.take());
        }
    });
    progress.finish();
    if let Some(error) = failed {
        return Err(CliError::of_file(&path, error));
    }
    lines.add(&path, before, &mut |_| true).map_err(|error| CliError::of_file(&path, error))?;
    lines.sort();
    Ok(lines)
}

/// Stored cases that are checked at once, for each of those side by side.
const AT_ONCE: usize = 64;

/// Checks each stored case of lines by its own proof, `jobs` of them side by side.
pub fn backings(
    cases: &CasesOf<'_>,
    lines: &CaseLines,
    jobs: usize,
) -> std::io::Result<Vec<Result<Backing, Vec<String>>>> {
    let count = lines.ids().count();
    side_by_side(jobs, || {
        let mut found = Vec::with_capacity(count);
        for from in (0..count).step_by(AT_ONCE * threads()) {
            let texts = (from..count.min(from + AT_ONCE * threads())).map(|index| lines.line(index));
            found.extend(in_order(&texts.collect::<std::io::Result<Vec<_>>>()?, |text| match read_case(text) {
                Ok(case) => cases.backing(&case),
                Err(error) => Err(vec![error.to_string()]),
            }));
        }
        Ok(found)
    })
}

/// A line about damaged lines of a journal.
pub fn damaged_lines(count: usize) -> String {
    format!("{count} lines of the journal are damaged; their cases are solved again")
}

/// Keeps the lines of cases that hold by their own proof. Prints their number and the number of cases that are solved again.
fn keep_proved(
    cases: &CasesOf<'_>,
    lines: &mut CaseLines,
    damaged: usize,
    jobs: usize,
) -> std::io::Result<Vec<String>> {
    lines.sort();
    let found = backings(cases, lines, jobs)?;
    lines.retain(&found.iter().map(Result::is_ok).collect::<Vec<_>>());
    let mut count = BackingCount::default();
    found.iter().flatten().for_each(|backing| count.add(*backing));
    let refused = found.iter().filter(|backing| backing.is_err()).count();
    let mut told = resumed(found.len() - refused, count, refused);
    told.extend((damaged > 0).then(|| damaged_lines(damaged)));
    Ok(told)
}

/// Whether the study's kind makes cases besides those of the file: then a finished case does not tell which of them are.
fn makes_cases(cases: &CasesOf<'_>) -> bool {
    match cases {
        CasesOf::Held(study) => kind(&study.kind).is_some_and(|kind| kind.makes_cases()),
        CasesOf::Streamed(_) => false,
    }
}
