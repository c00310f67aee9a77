//! Writes the files of a run from its finished cases.

use super::case_lines::CaseLines;
use super::error::{CliError, Verdict};
use super::folder::{JOURNAL, ResultFolder};
use super::options::useful_jobs;
use super::today::today;
use std::cell::Cell;
use std::io::{self, Write};
use voussoir_report::kinds::Made;
use voussoir_report::kinds::write_files;
use voussoir_report::writers::files::{Files, OutputFile};
use voussoir_study::kind::RunRequest;
use voussoir_study::results::format::{format_number, format_value, status_word};
use voussoir_study::results::{FinishedCases, Totals};
use voussoir_study::study::Study;

/// A folder in which the resolved study is written together with the results.
struct RunFiles<'a> {
    folder: &'a ResultFolder,
    resolved: &'a str,
}

/// results.json; the resolved study is written directly after it.
struct ResultsFile<'a> {
    file: Box<dyn OutputFile + 'a>,
    files: &'a RunFiles<'a>,
}

impl Write for ResultsFile<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    #[inline]
    fn write_all(&mut self, bytes: &[u8]) -> io::Result<()> {
        self.file.write_all(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

impl OutputFile for ResultsFile<'_> {
    fn done(self: Box<Self>) -> io::Result<()> {
        self.file.done()?;
        Files::write(self.files.folder, "resolved.toml", self.files.resolved.as_bytes())
    }
}

impl Files for RunFiles<'_> {
    fn begin(&self, name: &str) -> io::Result<Option<Box<dyn OutputFile + '_>>> {
        let Some(file) = self.folder.begin(name)? else { return Ok(None) };
        Ok(Some(if name == "results.json" { Box::new(ResultsFile { file, files: self }) } else { file }))
    }
}

/// Writes results.json, the resolved study and all other files of finished cases, and removes the journal.
pub fn write_outputs(
    study: &Study,
    folder: &ResultFolder,
    resolved: &str,
    lines: &CaseLines,
    (jobs, quiet): (usize, bool),
) -> Result<Made, CliError> {
    let request = RunRequest {
        jobs: useful_jobs(jobs),
        version: env!("CARGO_PKG_VERSION").into(),
        date: Some(today()),
        quiet,
        ..Default::default()
    };
    let files = RunFiles { folder, resolved };
    let made = write_files(study, &request, lines, &files, &mut |names| folder.make_room(names));
    let made = made.map_err(CliError::of_io)?;
    folder.remove(JOURNAL);
    Ok(made)
}

/// Returns the verdict on all cases.
pub fn verdict(totals: &Totals) -> Verdict {
    Verdict::of(totals.certified == totals.cases)
}

/// Returns a summary if there are more cases than the table shows; otherwise an empty text. A study that `searches` has a
/// table of its optima instead of the least load factor.
pub fn tally(totals: &Totals, lines: &CaseLines, searches: bool) -> String {
    if totals.all_shown() {
        return String::new();
    }
    let of = |(status, count): &(_, usize)| format!("{count} {}", status_word(*status));
    let statuses: Vec<String> = totals.statuses.iter().map(of).collect();
    let mut text = format!(
        "\n{} cases: {}; {} certified. The table and the report show {} of them, results.csv all\n",
        totals.cases,
        statuses.join(", "),
        totals.certified,
        totals.shown().len()
    );
    let found = Cell::new(String::new());
    let least = totals.least().into_iter().filter(|_| !searches).collect();
    drop(lines.each_of(&least, &mut |cases| {
        let Some(case) = cases.first() else { return Ok(()) };
        let swept = case.label.parameters.iter().map(|(key, value)| format!(", {key} = {}", format_value(value)));
        let factor = case.load_factor.map_or("-".into(), |factor| format_number(factor, 7));
        let id = case.label.id;
        found.set(format!("least load factor: {factor} (case {id}{})\n", swept.collect::<String>()));
        Ok(())
    }));
    text += &found.take();
    if totals.snapping > 0 {
        let count = totals.snapping;
        text += &format!("{count} snap before they reach their load factor: first_limit_point in results.csv\n");
    }
    text
}
