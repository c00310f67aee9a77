//! `voussoir run STUDY --shard 2/8`: solves one part of a study on one of several machines.
//!
//! A part is a folder `shard-2-of-8` with the resolved study and `cases.jsonl`. This file has a first line that
//! describes the part, a line for each case in order of id, and a last line with their number, so that a truncated copy
//! is detected.

use super::by_case::{backings, solve_into_journal};
use super::case_lines::CaseLines;
use super::error::{CliError, Outcome, Verdict};
use super::folder::{JOURNAL, ResultFolder};
use super::options::{Options, Shard, useful_jobs};
use super::print::say;
use super::progress::Progress;
use serde::{Deserialize, Serialize};
use std::io::Write;
use std::path::Path;
use voussoir_report::writers::files::OutputFile;
use voussoir_study::kind::LoadedStudy;
use voussoir_study::results::sealed_line::{checksum, sealed_text};
use voussoir_study::study::Study;

/// The file of a part.
pub const PART: &str = "cases.jsonl";

/// The first line of a part.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PartHead {
    /// Name of the study.
    pub study: String,
    /// Version of the program.
    pub version: String,
    /// Hash of the resolved study's text.
    pub study_hash: String,
    /// Number of this part and of all parts.
    pub shard: Shard,
}

/// The last line of a part.
#[derive(Debug, Serialize, Deserialize)]
pub struct PartEnd {
    /// Number of lines between the first and this one.
    pub cases_in_part: usize,
}

/// Identifies a resolved study: 64 bits of FNV-1a over its text, without the name of its file.
pub fn study_hash(resolved: &toml::Value) -> String {
    checksum(toml::to_string(resolved).unwrap_or_default().as_bytes())
}

/// Returns the ids of the cases of a part in order, or of the whole study without a part. Some kinds of studies cannot
/// be divided.
pub fn ids_of(study: &dyn LoadedStudy, shard: Option<Shard>) -> Result<Vec<usize>, CliError> {
    let Some(shard) = shard else { return Ok((0..study.count()).collect()) };
    let cases = cases_of(study)?;
    Ok((0..study.count()).filter(|id| cases.part(*id, shard.of) == Some(shard.number - 1)).collect())
}

/// Returns the cases of a study if it can be solved in parts.
fn cases_of(study: &dyn LoadedStudy) -> Result<&Study, CliError> {
    study.with_cases().ok_or_else(|| {
        let words = "is of a kind that cannot be solved in parts; it costs little";
        CliError::wrong_input(format_args!("--shard: the study \"{}\" {words}", study.name()))
    })
}

/// Returns true if a part contains all its cases, no line is damaged and every case is confirmed by its own proof.
fn finished(path: &Path, cases: &Study, count: usize, jobs: usize) -> bool {
    let mut lines = CaseLines::default();
    let whole = lines.add(path, 0, &mut |_| true).is_ok_and(|damaged| damaged == 0);
    whole
        && lines.sort().is_empty()
        && lines.ids().filter(|id| *id < cases.count()).count() == count
        && backings(cases, &lines, jobs).is_ok_and(|found| found.iter().all(Result::is_ok))
}

/// Solves a part of a study.
pub fn run(study: &dyn LoadedStudy, shard: Shard, dir: &Path, resolved: &str, options: &Options) -> Outcome {
    let ids = ids_of(study, Some(shard))?;
    let cases = cases_of(study)?;
    let folder = ResultFolder::open(&dir.join(shard.folder()))?;
    let path = folder.path().join(PART);
    let head = PartHead {
        study: study.name().into(),
        version: env!("CARGO_PKG_VERSION").into(),
        study_hash: study_hash(study.resolved()),
        shard,
    };
    let first = serde_json::to_string(&head).unwrap_or_default();
    if options.resume && folder.read(PART).lines().next() == Some(first.as_str()) {
        if finished(&path, cases, ids.len(), useful_jobs(options.jobs)) {
            if !options.quiet {
                say(format!("{} is finished", path.display()));
            }
            return Ok(Verdict::Proved);
        }
        // The undamaged cases of a part are kept.
        folder.part_becomes_journal(PART);
    }
    folder.remove(PART);
    folder.write("resolved.toml", resolved.as_bytes())?;
    let progress = Progress::new(study.name(), options.shown());
    let solved = solve_into_journal(cases, &ids, &folder, options, &progress)?;
    progress.finish();
    let mut part = folder.aside(PART).map_err(CliError::of_io)?;
    let (mut count, mut certified) = (0, 0);
    let mut copy = || -> std::io::Result<()> {
        writeln!(part, "{first}")?;
        for index in 0..solved.lines.ids().count() {
            let line = solved.lines.line(index)?;
            let head: super::case_lines::LineHead = serde_json::from_slice(&line)?;
            certified += usize::from(head.certificate.passed);
            count += 1;
            part.write_all(&sealed_text(&line))?;
        }
        writeln!(part, "{}", serde_json::to_string(&PartEnd { cases_in_part: count })?)
    };
    copy().and_then(|()| Box::new(part).done()).map_err(CliError::of_io)?;
    folder.remove(JOURNAL);
    if !options.quiet && !options.json {
        solved.remarks.iter().for_each(say);
        say(format!(
            "{} of {} cases in {}; `voussoir merge {}` puts the parts together",
            ids.len(),
            study.count(),
            path.display(),
            dir.display()
        ));
    }
    Ok(Verdict::of(certified == count))
}
