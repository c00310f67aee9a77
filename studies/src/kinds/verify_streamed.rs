//! `verify` of a study of very many cases: results.json is read from its beginning to its end, and no more of its cases are held
//! than are checked at once.

use super::case_study::HOW;
use super::kind::{CasesOf, StoredResults, Verification, not_made};
use super::same_bytes::SameBytes;
use super::stored_cases::read_cases;
use crate::caught::caught;
use crate::results::stored_path::PATH_PROOFS;
use crate::results::{CaseResult, HEAD, Origin};
use crate::side_by_side::side_by_side;
use crate::solve::{Observer, solve_followed};
use crate::study::Sweep;
use crate::verify::Agreement;
use crate::verify::case::verify_case;
use crate::verify::hash_finding;
use crate::verify::path_proofs::{NumberedLine, PathProofLines};
use crate::writers::streamed_tables::{StreamedTable, wanted};
use rayon::prelude::*;
use serde::Deserialize;
use serde_json::{Map, Value as Json};
use std::io::Read;
use voussoir_core::limit::Status;

/// Cases that are checked at once, for each of those side by side.
const AT_ONCE: usize = 16;
/// A table as it should be, against the one that is there.
type Compared = StreamedTable<SameBytes<Box<dyn Read>>>;

/// What a check has come to so far.
struct Check<'a> {
    sweep: &'a Sweep,
    observer: &'a dyn Observer,
    jobs: usize,
    waiting: Vec<Json>,
    paths: PathProofLines<'a>,
    agreement: Option<Agreement>,
    origin: Origin,
    found: Verification,
    ids: Vec<usize>,
    missing: Vec<usize>,
    /// Those that are wanted and there, until one turns out to be another.
    tables: Vec<(&'static str, Compared)>,
}

/// Checks results case by case.
pub(super) fn verify(sweep: &Sweep, stored: &StoredResults, observer: &dyn Observer) -> Result<Verification, String> {
    observer.begins(sweep.count());
    let made = wanted(sweep).into_iter().map(String::from).collect();
    let mut check = Check {
        sweep,
        observer,
        jobs: stored.jobs,
        waiting: Vec::new(),
        paths: PathProofLines::new((stored.file)(PATH_PROOFS)),
        agreement: None,
        origin: Origin::default(),
        found: Verification { of: sweep.count(), how: HOW, made, ..Verification::default() },
        ids: Vec::new(),
        missing: Vec::new(),
        tables: Vec::new(),
    };
    for name in wanted(sweep).into_iter().filter(|name| *name != PATH_PROOFS) {
        match (stored.file)(name).map(|file| StreamedTable::new(name, SameBytes::new(file), sweep)) {
            Some(Ok(table)) => check.tables.push((name, table)),
            Some(Err(_)) => check.found.files.push(not_made(name)),
            None => {}
        }
    }
    let mut unread = None;
    let beside = read_cases(stored.results()?, &mut |head, entry| {
        check.begin(head);
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
    /// Reads the origin of the results from their head.
    fn begin(&mut self, head: &Map<String, Json>) {
        if self.agreement.is_none() {
            self.agreement = Some(Agreement::of_head(head, &self.sweep.resolved));
            self.origin = Origin::deserialize(Json::Object(head.clone())).unwrap_or_default();
        }
    }

    /// Checks the cases that wait.
    fn checked(&mut self) -> Result<(), String> {
        let entries = std::mem::take(&mut self.waiting);
        let read = |entry: &Json| CaseResult::deserialize(entry).map_err(|error| error.to_string());
        let results = entries.iter().map(read).collect::<Result<Vec<_>, _>>()?;
        let (sweep, observer) = (self.sweep, self.observer);
        let how = (self.agreement.unwrap_or_default(), &self.origin);
        let lines: Vec<_> = results.iter().map(|result| self.paths.of(result.label.id)).collect();
        let triples = entries.par_iter().zip(&results).zip(&lines);
        let check = |((entry, result), line): ((&Json, &CaseResult), &Option<NumberedLine>)| {
            let found = caught(|| differs((sweep, observer), how, (entry, result), line.as_ref()));
            found.unwrap_or_else(|why| (vec![why], [0, 0]))
        };
        let wrong: Vec<(Vec<String>, [usize; 2])> = side_by_side(self.jobs, || triples.map(check).collect());
        for (case, (wrong, proved)) in results.iter().zip(wrong) {
            (0..2).for_each(|i| self.found.paths[i] += proved[i]);
            self.found.findings.extend(wrong.into_iter().map(|why| (case.label.id, why)));
            self.place(case.label.id);
            self.found.cases += 1;
            self.found.stalled += usize::from(case.status == Status::Stalled);
            let others = self.tables.extract_if(.., |(_, table)| table.add(case).is_err());
            self.found.files.extend(others.map(|(name, _)| not_made(name)));
        }
        Ok(())
    }

    /// A case with this id stands next.
    fn place(&mut self, id: usize) {
        let next = self.ids.last().map_or(0, |last| last + 1);
        if id >= self.sweep.count() {
            return;
        }
        if id < next {
            self.found.findings.push((id, "stands twice, or after a later case".into()));
        } else {
            self.missing.extend(next..id);
            self.ids.push(id);
        }
    }

    /// What stands beside the cases, the cases that are missing, and the ends of the tables.
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
        let listed: Vec<&str> = wanted(self.sweep);
        if self.origin.format > 0 && beside.get("files") != Some(&Json::from(listed)) {
            self.found.findings.push((0, "the list of files does not match the study".into()));
        }
        self.found.agreement = self.agreement.unwrap_or_default();
        let known = ["study", "version", "date", "only_cases", "files"];
        let foreign = beside.keys().filter(|key| !known.contains(&key.as_str()) && !HEAD.contains(&key.as_str()));
        self.found.findings.extend(foreign.map(|key| (0, format!("{key} is not in what solving again gives"))));
        let others = self.tables.into_iter().filter_map(|(name, table)| {
            let same = table.finish().is_ok_and(SameBytes::ended);
            (!same).then(|| not_made(name))
        });
        self.found.files.extend(others);
        self.found.files.extend(self.paths.finish());
        self.found.own = self.ids.len();
        self.found
    }
}

/// Checks a stored case by itself and against its stored path or solving again. Returns the findings; 1 if its path is proved, and 1 if
/// it was not solved again for that.
fn differs(
    (sweep, observer): (&Sweep, &dyn Observer),
    (agreement, origin): (Agreement, &Origin),
    (entry, result): (&Json, &CaseResult),
    line: Option<&NumberedLine>,
) -> (Vec<String>, [usize; 2]) {
    let Some(case) = CasesOf::Streamed(sweep).case(result.label.id) else {
        return (vec!["the study has no such case".into()], [0, 0]);
    };
    let mut found = verify_case(&case, result);
    found.extend(hash_finding(&case, result, origin));
    let proved = line.map(|line| line.check(&case, result)).transpose();
    let proved = proved.unwrap_or_else(|why| {
        found.push(why);
        None
    });
    let count = usize::from(proved.is_some());
    let enough = proved.filter(|proved| proved.is_enough(&case, agreement));
    let counts = [count, usize::from(enough.is_some())];
    let (again, agreement) = match enough {
        Some(proved) => (Some(proved.result), Agreement::Processor),
        None => (solve_followed(&case, observer), agreement),
    };
    match again.map(serde_json::to_value) {
        Some(Ok(again)) => found.extend(agreement.differences(entry, &again)),
        Some(Err(why)) => found.push(why.to_string()),
        None => found.push("the check was cancelled".into()),
    }
    (found, counts)
}
