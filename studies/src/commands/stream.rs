//! A run of so many cases that none is held: from the journal to results.json and results.csv, case by case.

use super::by_case::solve_into_journal;
use super::case_lines::CaseLines;
use super::error::{CliError, Outcome, Verdict};
use super::folder::{Aside, JOURNAL, ResultFolder};
use super::options::Options;
use super::print::say;
use super::refill::refill;
use super::tables::Tables;
use super::today::today;
use crate::figures::format::{format_number, format_value, status_word};
use crate::kinds::CasesOf;
use crate::results::case_with_path::read_case;
use crate::results::{CaseResult, Origin, words};
use crate::side_by_side::in_order;
use crate::study::Sweep;
use crate::writers::results_text::{ResultsHead, ResultsText, case_text};
use crate::writers::streamed_tables::wanted;
use serde_json::Map;
use std::collections::BTreeMap;
use std::io;
use std::path::Path;
use voussoir_core::limit::Status;

/// Cases that are read again before they are written, for each of those side by side.
const AT_ONCE: usize = 64;

/// What is told of very many cases.
#[derive(Debug, Default)]
struct Tally {
    count: usize,
    certified: usize,
    statuses: BTreeMap<&'static str, usize>,
    least: Option<(f64, String)>,
    /// Cases whose first limit point is not their load factor.
    snapping: usize,
}

impl Tally {
    fn add(&mut self, case: &CaseResult) {
        self.count += 1;
        self.certified += usize::from(case.certificate.passed);
        *self.statuses.entry(status_word(case.status)).or_default() += 1;
        self.snapping += usize::from(case.snaps_from().is_some());
        let Some(factor) = case.load_factor.filter(|_| case.status != Status::Unbounded) else { return };
        if self.least.as_ref().is_none_or(|(least, _)| factor < *least) {
            let swept = case.label.parameters.iter().map(|(key, value)| format!(", {key} = {}", format_value(value)));
            self.least = Some((factor, format!("case {}{}", case.label.id, swept.collect::<String>())));
        }
    }

    fn text(&self) -> String {
        let of = |(status, count): (&&str, &usize)| format!("{count} {status}");
        let mut text = format!("{} cases: ", self.count);
        text += &self.statuses.iter().map(of).collect::<Vec<_>>().join(", ");
        text += &format!("; {} certified\n", self.certified);
        if let Some((factor, place)) = &self.least {
            text += &format!("least load factor: {} ({place})\n", format_number(*factor, 7));
        }
        if self.snapping > 0 {
            text += &format!(
                "{} snap before they reach their load factor: first_limit_point in results.csv\n",
                self.snapping
            );
        }
        text
    }
}

/// Solves a study whose cases are streamed.
pub fn run(sweep: &Sweep, dir: &Path, resolved: &str, options: &Options) -> Outcome {
    if options.case.is_some() && dir.join("results.json").exists() {
        return Err(CliError::wrong_input(format_args!(
            "voussoir: {}: of so many cases one cannot be replaced; write it into a folder of its own with --out",
            dir.display()
        )));
    }
    let folder = ResultFolder::open(dir)?;
    folder.write("resolved.toml", resolved.as_bytes())?;
    if options.resume {
        refill(&folder)?;
    }
    let ids = options.case.map_or_else(|| (0..sweep.count()).collect(), |id| vec![id]);
    let lines = solve_into_journal(&CasesOf::Streamed(sweep), &sweep.name, &ids, &folder, options)?;
    finish(sweep, &folder, &lines, options.case.map(|id| vec![id]), options.quiet || options.json)
}

/// Writes results.json from lines of all cases, each of which `take` is shown.
fn write(
    out: &mut Aside,
    head: &ResultsHead,
    lines: &CaseLines,
    take: &mut dyn FnMut(&CaseResult) -> io::Result<()>,
) -> io::Result<()> {
    let mut text = ResultsText::begin(out, head)?;
    let count = lines.ids().count();
    for from in (0..count).step_by(AT_ONCE) {
        let chunk = (from..count.min(from + AT_ONCE)).map(|index| lines.line(index)).collect::<io::Result<Vec<_>>>()?;
        let made = in_order(&chunk, |line| {
            let case = read_case(line)?;
            let text = case_text(&case)?;
            Ok((case, text))
        });
        for case in made {
            let (case, own): (CaseResult, Vec<u8>) = case.map_err(|error: io::Error| error)?;
            take(&case)?;
            text.add(&own)?;
        }
    }
    text.finish(None, &Map::new())?;
    Ok(())
}

/// Writes results.json and the tables from lines of all cases, and says what they hold.
pub fn finish(
    sweep: &Sweep,
    folder: &ResultFolder,
    lines: &CaseLines,
    only_cases: Option<Vec<usize>>,
    quiet: bool,
) -> Outcome {
    let mut tally = Tally::default();
    let mut json = folder.aside("results.json")?;
    let mut tables = Tables::begin(sweep, folder)?;
    let version = env!("CARGO_PKG_VERSION").to_string();
    let origin = Origin::here(&words(&sweep.resolved));
    let files = wanted(sweep).into_iter().map(String::from).collect();
    let head = ResultsHead { study: sweep.name.clone(), version, origin, date: Some(today()), only_cases, files };
    let written = write(&mut json, &head, lines, &mut |case| {
        tally.add(case);
        tables.add(case)
    });
    json.done(written)?;
    folder.remove_drawn();
    tables.done()?;
    folder.remove(JOURNAL);
    if !quiet {
        say(tally.text());
        say(format!("results.json and results.csv in {}; so many cases are not drawn", folder.path().display()));
    }
    Ok(Verdict::of(tally.certified == tally.count))
}
