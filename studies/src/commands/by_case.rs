//! Solves the cases of a study and writes each as a line of a journal. Finished cases need no memory, and they survive
//! an interrupted run.

use super::case_lines::{CaseLines, LineHead};
use super::error::CliError;
use super::folder::{JOURNAL, ResultFolder};
use super::options::{Options, useful_jobs};
use super::progress::Progress;
use serde::Deserialize;
use std::collections::BTreeSet;
use std::io::{self, Write};
use voussoir_core::limit::Status;
use voussoir_report::kinds::read_stored_cases;
use voussoir_report::writers::files::OutputFile;
use voussoir_study::results::CaseResult;
use voussoir_study::results::case_with_path::{CaseWithPath, read_case};
use voussoir_study::results::sealed_line::sealed;
use voussoir_study::results::stored_path::PATH_PROOFS;
use voussoir_study::side_by_side::{in_order, side_by_side, threads};
use voussoir_study::study::Study;
use voussoir_verify::backing;
use voussoir_verify::path_proofs::PathProofLines;
use voussoir_verify::{Backing, BackingCount, resumed};

/// The cases of a result folder after a run.
pub struct Solved {
    /// All cases, in order of id.
    pub lines: CaseLines,
    /// Remarks on stored cases for the user, one per line.
    pub remarks: Vec<String>,
    /// Number of stored cases that were not requested and are kept.
    pub others: usize,
}

/// Solves cases; with `--resume`, only those that are not finished in the folder. With `--case`, the other cases of the
/// folder are kept.
pub fn solve_into_journal(
    study: &Study,
    ids: &[usize],
    folder: &ResultFolder,
    options: &Options,
    progress: &Progress,
) -> Result<Solved, CliError> {
    let path = folder.path().join(JOURNAL);
    let unusable = |error: io::Error| CliError::of_file(&path, error);
    let keep = options.case.is_some();
    let mut lines = CaseLines::default();
    let mut remarks = Vec::new();
    let journal = folder.journal(options.resume || keep).map_err(unusable)?;
    let mut own = journal.try_clone().map_err(unusable)?;
    let before = journal.metadata().map_err(unusable)?.len();
    let wanted = |id: usize| ids.binary_search(&id).is_ok();
    if options.resume || keep {
        // A finished case does not show which further cases its kind made from it.
        let resume = options.resume && !study.makes_cases();
        let mut take = |head: &LineHead| match wanted(head.id) {
            true => resume && head.status != Status::Stalled,
            false => keep,
        };
        let damaged = lines.add(&path, 0, &mut take).map_err(unusable)?;
        remarks = keep_proved(study, &mut lines, damaged, useful_jobs(options.jobs)).map_err(unusable)?;
    }
    let finished: BTreeSet<usize> = lines.ids().collect();
    let others = finished.iter().filter(|id| !wanted(**id)).count();
    let rest: Vec<usize> = ids.iter().copied().filter(|id| !finished.contains(id)).collect();
    progress.writes(journal);
    let mut failed = None;
    study.solve(&rest, useful_jobs(options.jobs), progress, &mut |case| {
        // The cases of the study itself are in the journal already.
        if case.label.id >= study.count() {
            let line = sealed(&CaseWithPath(&case)).map_err(io::Error::from);
            failed = line.and_then(|line| own.write_all(&line)).err().or(failed.take());
        }
    });
    progress.written().map_err(unusable)?;
    if let Some(error) = failed {
        return Err(unusable(error));
    }
    lines.add(&path, before, &mut |_| true).map_err(unusable)?;
    lines.sort();
    Ok(Solved { lines, remarks, others })
}

/// Writes the cases of results.json as lines before those of the journal, so that one file contains all finished cases
/// of a folder. Ignores a file that is not a valid results.json, and any unreadable part of it.
pub fn refill(folder: &ResultFolder) -> Result<(), CliError> {
    let Some(results) = folder.opened("results.json") else { return Ok(()) };
    let proofs = folder.opened(PATH_PROOFS).map(|file| Box::new(file) as Box<dyn io::Read>);
    let mut paths = PathProofLines::new(proofs);
    let mut aside = folder.aside(JOURNAL).map_err(CliError::of_io)?;
    let mut written = Ok(());
    let read = read_stored_cases(results, &mut |_, entry| {
        let Ok(case) = CaseResult::deserialize(&entry) else { return };
        if written.is_ok() {
            let case = paths.attached_to(case);
            written = sealed(&CaseWithPath(&case)).map_err(io::Error::from).and_then(|line| aside.write_all(&line));
        }
    });
    drop(read);
    let written = written.and_then(|()| match folder.opened(JOURNAL) {
        Some(mut journal) => io::copy(&mut journal, &mut aside).map(drop),
        None => Ok(()),
    });
    written.and_then(|()| Box::new(aside).done()).map_err(CliError::of_io)
}

/// Number of stored cases that each thread checks at once.
const AT_ONCE: usize = 64;

/// Checks each stored case by its own proof, on `jobs` threads.
pub fn backings(study: &Study, lines: &CaseLines, jobs: usize) -> io::Result<Vec<Result<Backing, Vec<String>>>> {
    let count = lines.ids().count();
    side_by_side(jobs, || {
        let mut found = Vec::with_capacity(count);
        for from in (0..count).step_by(AT_ONCE * threads()) {
            let texts = (from..count.min(from + AT_ONCE * threads())).map(|index| lines.line(index));
            found.extend(in_order(&texts.collect::<io::Result<Vec<_>>>()?, |text| match read_case(text) {
                Ok(case) => backing(study, &case),
                Err(error) => Err(vec![error.to_string()]),
            }));
        }
        Ok(found)
    })
}

/// Keeps the cases that their own proof confirms. Returns remarks with their number and the number of cases to solve
/// again.
fn keep_proved(study: &Study, lines: &mut CaseLines, damaged: usize, jobs: usize) -> io::Result<Vec<String>> {
    lines.sort();
    let found = backings(study, lines, jobs)?;
    lines.retain(&found.iter().map(Result::is_ok).collect::<Vec<_>>());
    let mut count = BackingCount::default();
    found.iter().flatten().for_each(|backing| count.add(*backing));
    let refused = found.iter().filter(|backing| backing.is_err()).count();
    let mut told = resumed(found.len() - refused, count, refused);
    told.extend(
        (damaged > 0).then(|| format!("{damaged} lines of the journal are damaged; their cases are solved again")),
    );
    Ok(told)
}
