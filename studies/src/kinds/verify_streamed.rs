//! `verify` of a study of very many cases: results.json is read from its beginning to its end, and no more of its cases are held
//! than are checked at once.

use super::case_study::HOW;
use super::kind::{StoredResults, Verification, not_made};
use super::same_bytes::SameBytes;
use super::stored_cases::read_cases;
use crate::results::CaseResult;
use crate::solve::{Observer, side_by_side, solve_followed};
use crate::study::Sweep;
use crate::verify::case::verify_case;
use crate::verify::repeat::differences;
use crate::writers::stream::CsvStream;
use rayon::prelude::*;
use serde::Deserialize;
use serde_json::{Map, Value as Json};
use std::io::Read;
use voussoir_core::limit::Status;

/// Cases that are checked at once, for each of those side by side.
const AT_ONCE: usize = 16;
/// The table beside results.json.
const TABLE: &str = "results.csv";

/// What a check has come to so far.
struct Check<'a> {
    sweep: &'a Sweep,
    observer: &'a dyn Observer,
    jobs: usize,
    waiting: Vec<Json>,
    found: Verification,
    ids: Vec<usize>,
    missing: Vec<usize>,
    /// results.csv as it should be, against the one that is there; `None` where there is none, or it is another one.
    table: Option<CsvStream<SameBytes<Box<dyn Read>>>>,
}

/// Checks results case by case.
pub(super) fn verify(sweep: &Sweep, stored: &StoredResults, observer: &dyn Observer) -> Result<Verification, String> {
    observer.begins(sweep.count());
    let table = (stored.file)(TABLE).map(|file| CsvStream::new(SameBytes::new(file), sweep.keys()));
    let mut check = Check {
        sweep,
        observer,
        jobs: stored.jobs,
        waiting: Vec::new(),
        found: Verification { of: sweep.count(), how: HOW, made: vec![TABLE.into()], ..Verification::default() },
        ids: Vec::new(),
        missing: Vec::new(),
        table: None,
    };
    match table {
        Some(Ok(table)) => check.table = Some(table),
        Some(Err(_)) => check.found.files.push(not_made(TABLE)),
        None => {}
    }
    let mut unread = None;
    let beside = read_cases(stored.results()?, &mut |entry| {
        check.waiting.push(entry);
        if check.waiting.len() >= AT_ONCE * check.jobs.max(1) {
            unread = check.checked().err().or(unread.take());
        }
    })?;
    check.checked()?;
    match unread {
        Some(why) => Err(why),
        None if observer.cancelled() => Err("the check was cancelled".into()),
        None => Ok(check.end(&beside)),
    }
}

impl Check<'_> {
    /// Checks the cases that wait.
    fn checked(&mut self) -> Result<(), String> {
        let entries = std::mem::take(&mut self.waiting);
        let read = |entry: &Json| CaseResult::deserialize(entry).map_err(|error| error.to_string());
        let results = entries.iter().map(read).collect::<Result<Vec<_>, _>>()?;
        let (sweep, observer) = (self.sweep, self.observer);
        let pairs = entries.par_iter().zip(&results);
        let check = |(entry, result): (&Json, &CaseResult)| differs(sweep, observer, entry, result);
        let wrong: Vec<Vec<String>> = side_by_side(self.jobs, || pairs.map(check).collect());
        for (case, wrong) in results.iter().zip(wrong) {
            self.found.findings.extend(wrong.into_iter().map(|why| (case.label.id, why)));
            self.place(case.label.id);
            self.found.cases += 1;
            self.found.stalled += usize::from(case.status == Status::Stalled);
            if self.table.as_mut().is_some_and(|table| table.add(case).is_err()) {
                self.other_table();
            }
        }
        Ok(())
    }

    /// A case with this id stands next.
    fn place(&mut self, id: usize) {
        let next = self.ids.last().map_or(0, |last| last + 1);
        if id < next {
            self.found.findings.push((id, "stands twice, or after a later case".into()));
        } else {
            self.missing.extend(next..id.min(self.sweep.count()));
            self.ids.push(id);
        }
    }

    fn other_table(&mut self) {
        self.table = None;
        self.found.files.push(not_made(TABLE));
    }

    /// What stands beside the cases, the cases that are missing, and the end of the table.
    fn end(mut self, beside: &Map<String, Json>) -> Verification {
        let next = self.ids.last().map_or(0, |last| last + 1);
        self.missing.extend(next..self.sweep.count());
        let (study, only) = (beside.get("study"), beside.get("only_cases"));
        if study.and_then(Json::as_str) != Some(&self.sweep.name) {
            let study = study.unwrap_or(&Json::Null);
            self.found.findings.push((0, format!("results of {study}, study \"{}\"", self.sweep.name)));
        }
        match only {
            None => self.found.findings.extend(self.missing.iter().map(|id| (*id, "is missing".into()))),
            Some(only) if self.missing.is_empty() || *only != Json::from(self.ids.clone()) => {
                self.found.findings.push((0, "only_cases is no choice of the study's cases".into()));
            }
            Some(_) => {}
        }
        let known = ["study", "version", "date", "only_cases"];
        let foreign = beside.keys().filter(|key| !known.contains(&key.as_str()));
        self.found.findings.extend(foreign.map(|key| (0, format!("{key} is not in what solving again gives"))));
        if let Some(table) = self.table.take()
            && !table.finish().is_ok_and(SameBytes::ended)
        {
            self.other_table();
        }
        self.found
    }
}

/// What is wrong with a stored case, by itself and against solving again.
fn differs(sweep: &Sweep, observer: &dyn Observer, entry: &Json, result: &CaseResult) -> Vec<String> {
    let Ok(case) = sweep.case(result.label.id) else { return vec!["the study has no such case".into()] };
    let Some(again) = solve_followed(&case, observer) else { return vec!["the check was cancelled".into()] };
    match serde_json::to_value(again) {
        Ok(again) => verify_case(&case, result).into_iter().chain(differences(entry, &again)).collect(),
        Err(why) => vec![why.to_string()],
    }
}
