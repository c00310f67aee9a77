//! `verify` of a study with cases: results.json is read from its beginning to its end, and only the cases that are checked at
//! the same time are in memory. If they pass, the other files are made again from it and compared.

use super::outputs::write_files;
use super::stored_cases::read_stored_cases;
use super::stored_results::Comparison;
use serde::Deserialize;
use serde_json::{Map, Value as Json, json};
use std::collections::{BTreeMap, BTreeSet, VecDeque};
use std::io;
use voussoir_core::limit::Status;
use voussoir_study::cases::{Observer, solve_followed};
use voussoir_study::caught::caught;
use voussoir_study::checks::Agreement;
use voussoir_study::kind::{RESULTS, StoredResults};
use voussoir_study::kind::{RunRequest, Verification};
use voussoir_study::results::stored_path::PATH_PROOFS;
use voussoir_study::results::{CaseResult, FinishedCases, HEAD, Origin, TakeCases};
use voussoir_study::side_by_side::{in_order, side_by_side};
use voussoir_study::study::Study;
use voussoir_verify::path_proofs::{NumberedLine, PathProofLines, ProvedCase};
use voussoir_verify::{COMPARISON, CheckedCase, added, against, by_itself};

/// Number of cases, for each parallel job, that are checked at once.
const AT_ONCE: usize = 16;

/// Describes how `verify` has checked each case.
const HOW: &str = "checked: what the stored forces and motions prove, from the scene and without a solver (nothing where [output] fields = false has left them out); then every number \
and word against solving the case again, unless the states in path_proofs.jsonl prove its path; tables and figures against results.json. \
Not checked: counters, seconds, version";

/// Keys of results.json that are neither its origin nor added by a study kind.
const OWN_KEYS: [&str; 6] = ["study", "version", "date", "only_cases", "files", "comparison"];

/// The state of a check.
struct Check<'a> {
    study: &'a Study,
    observer: &'a dyn Observer,
    jobs: usize,
    waiting: Vec<Json>,
    paths: PathProofLines<'a>,
    agreement: Option<Agreement>,
    origin: Origin,
    found: Verification,
    /// Ids of the study's own cases that were found, in order.
    ids: Vec<usize>,
    missing: Vec<usize>,
    /// The results from which the additions of the study's kind are made.
    brief: Vec<CaseResult>,
    made: MadeCases,
}

/// The cases that the study's kind makes, solved again separately for each case of the study.
#[derive(Default)]
struct MadeCases {
    /// Number of the study's own cases in the results from which they were made.
    bases: usize,
    expected: VecDeque<CaseResult>,
}

/// Checks results case by case.
pub(super) fn verify_study(
    study: &Study,
    stored: &StoredResults,
    observer: &dyn Observer,
) -> Result<Verification, String> {
    observer.begins(study.count());
    let mut check = Check {
        study,
        observer,
        jobs: stored.jobs,
        waiting: Vec::new(),
        paths: PathProofLines::new((stored.file)(PATH_PROOFS)),
        agreement: None,
        origin: Origin::default(),
        found: Verification { of: study.count(), how: HOW, ..Verification::default() },
        ids: Vec::new(),
        missing: Vec::new(),
        brief: Vec::new(),
        made: MadeCases::default(),
    };
    let mut unread = None;
    let beside = read_stored_cases(stored.results()?, &mut |head, entry| {
        check.begin(head);
        check.waiting.push(entry);
        if check.waiting.len() >= AT_ONCE * check.jobs.max(1) {
            unread = check.checked().err().or(unread.take());
        }
    })?;
    check.begin(&beside);
    check.checked()?;
    if let Some(why) = unread {
        return Err(why);
    }
    let mut found = check.end(&beside);
    if observer.cancelled() {
        return Err("the check was cancelled".into());
    }
    // Stored results are drawn only if they are confirmed: every number was then solved again.
    if found.findings.is_empty() {
        compare_files(study, stored, &beside, &mut found);
    }
    Ok(found)
}

impl Check<'_> {
    /// Reads the origin of the results from their head.
    fn begin(&mut self, head: &Map<String, Json>) {
        if self.agreement.is_none() {
            self.agreement = Some(Agreement::of_head(head, &self.study.resolved));
            self.origin = Origin::deserialize(Json::Object(head.clone())).unwrap_or_default();
        }
    }

    /// Checks the collected cases.
    fn checked(&mut self) -> Result<(), String> {
        let entries = std::mem::take(&mut self.waiting);
        let read = |entry: &Json| CaseResult::deserialize(entry).map_err(|error| error.to_string());
        let results = entries.iter().map(read).collect::<Result<Vec<_>, _>>()?;
        let pairs: Vec<(&Json, &CaseResult)> = entries.iter().zip(&results).collect();
        let (own, made): (Vec<_>, Vec<_>) =
            pairs.into_iter().partition(|(_, result)| result.label.id < self.study.count());
        self.own_cases(&own);
        self.made_cases(&made);
        self.found.cases += results.len();
        self.found.stalled += results.iter().filter(|case| case.status == Status::Stalled).count();
        if self.study.kind != "run" {
            self.brief.extend(results.iter().map(|result| self.study.needed(result)));
        }
        Ok(())
    }

    fn how(&self) -> How<'_> {
        let agreement = self.agreement.unwrap_or_default();
        How { study: self.study, agreement, origin: &self.origin }
    }

    /// Checks cases of the study.
    fn own_cases(&mut self, pairs: &[(&Json, &CaseResult)]) {
        let lines: Vec<_> = pairs.iter().map(|(_, result)| (*result, self.paths.of(result.label.id))).collect();
        let how = self.how();
        let checked =
            side_by_side(self.jobs, || in_order(&lines, |(result, line)| how.by_itself(result, line.as_ref())));
        let unproved = lines.iter().zip(&checked).filter(|(_, checked)| checked.is_case && checked.instead.is_none());
        let unproved: BTreeSet<usize> = unproved.map(|((result, _), _)| result.label.id).collect();
        let again = self.solved_again(&unproved.into_iter().collect::<Vec<_>>());
        let how = self.how();
        let triples: Vec<_> = pairs.iter().zip(&checked).collect();
        let differences = side_by_side(self.jobs, || {
            in_order(&triples, |((entry, result), checked)| match (&checked.instead, again.get(&result.label.id)) {
                (Some(proved), _) => how.against((entry, result), proved, Agreement::Processor),
                (None, Some(again)) => how.against((entry, result), again, how.agreement),
                (None, None) if checked.is_case => vec!["the check was cancelled".into()],
                (None, None) => Vec::new(),
            })
        });
        for (((_, case), checked), differences) in pairs.iter().zip(checked).zip(differences) {
            self.found.paths[0] += usize::from(checked.proved);
            self.found.paths[1] += usize::from(checked.instead.is_some());
            let wrong = checked.wrong.into_iter().chain(differences);
            self.found.findings.extend(wrong.map(|why| (case.label.id, why)));
            self.place(case.label.id);
        }
    }

    /// Solves cases of the study again. Cases that its kind makes from them are collected and compared later.
    fn solved_again(&mut self, ids: &[usize]) -> BTreeMap<usize, CaseResult> {
        let mut again = Vec::new();
        if self.study.makes_cases() {
            // The kind solves them again for its search.
            let one = |id: &usize| solve_followed(&*self.study.case(*id)?, self.observer);
            again = side_by_side(self.jobs, || in_order(ids, one)).into_iter().flatten().collect();
        } else {
            self.study.solve_quietly(ids, self.jobs, self.observer, &mut |case| again.push(case));
        }
        let (own, made): (Vec<_>, Vec<_>) = again.into_iter().partition(|case| case.label.id < self.study.count());
        self.made.expected.extend(made);
        own.into_iter().map(|case| (case.label.id, case)).collect()
    }

    /// A case of the study with this id is next.
    fn place(&mut self, id: usize) {
        let next = self.ids.last().map_or(0, |last| last + 1);
        if id < next || self.made.bases > 0 {
            let appears = if self.ids.binary_search(&id).is_ok() {
                "appears twice"
            } else {
                "the entries of cases are not in the order of their ids"
            };
            self.found.findings.push((id, appears.into()));
        } else {
            self.missing.extend(next..id);
            self.ids.push(id);
        }
    }

    /// Checks cases that the study's kind makes against the cases that it makes again.
    fn made_cases(&mut self, pairs: &[(&Json, &CaseResult)]) {
        for (entry, result) in pairs {
            let id = result.label.id;
            let line = self.paths.of(id);
            let checked = self.how().by_itself(result, line.as_ref());
            while self.next_made().is_some_and(|next| next < id) {
                let absent = self.made.expected.pop_front();
                self.found.findings.extend(absent.map(|case| (case.label.id, "is missing".into())));
            }
            let again = match self.made.expected.front() {
                Some(case) if case.label.id == id => self.made.expected.pop_front(),
                _ => None,
            };
            let differences = match again {
                Some(again) => self.how().against((entry, result), &again, self.how().agreement),
                None => vec!["is in the results, but the study does not make this case, or it appears twice".into()],
            };
            self.found.paths[0] += usize::from(checked.proved);
            self.found.findings.extend(checked.wrong.into_iter().chain(differences).map(|why| (id, why)));
        }
    }

    /// Returns the id of the next case that the study's kind makes; `None` after the last.
    fn next_made(&mut self) -> Option<usize> {
        while self.made.expected.is_empty() && self.study.makes_cases() && self.made.bases < self.ids.len() {
            let base = self.ids[self.made.bases];
            self.made.bases += 1;
            let (mut made, count) = (Vec::new(), self.study.count());
            let take = &mut |case: CaseResult| made.extend(Some(case).filter(|case| case.label.id >= count));
            self.study.solve_quietly(&[base], self.jobs, self.observer, take);
            made.sort_by_key(|case: &CaseResult| case.label.id);
            self.made.expected.extend(made);
        }
        self.made.expected.front().map(|case| case.label.id)
    }

    /// Checks the entries beside the cases, and finds missing cases.
    fn end(mut self, beside: &Map<String, Json>) -> Verification {
        while self.next_made().is_some() {
            let absent = self.made.expected.pop_front();
            self.found.findings.extend(absent.map(|case| (case.label.id, "is missing".into())));
        }
        let next = self.ids.last().map_or(0, |last| last + 1);
        self.missing.extend(next..self.study.count());
        let agreement = self.agreement.unwrap_or_default();
        let mut wrong: Vec<_> = self.origin.too_new().into_iter().collect();
        let study = beside.get("study").unwrap_or(&Json::Null);
        if study.as_str() != Some(&self.study.name) {
            wrong.push(format!("study is {study}, but the name in resolved.toml is \"{}\"", self.study.name));
        }
        match beside.get("only_cases") {
            None => self.found.findings.extend(self.missing.iter().map(|id| (*id, "is missing".into()))),
            Some(only) if self.missing.is_empty() || *only != Json::from(self.ids.clone()) => {
                wrong.push(
                    "only_cases must list the ids of all entries of cases, and not all cases of the study".into(),
                );
            }
            Some(_) => {}
        }
        match caught(|| self.study.own_results(&self.brief)) {
            Ok(own) => {
                let comparison = own.comparison.map(|own| json!(own)).unwrap_or_default();
                if !agreement.same(beside.get("comparison").unwrap_or(&Json::Null), &comparison) {
                    wrong.push(COMPARISON.into());
                }
                let is_added =
                    |(key, _): &(&String, &Json)| !OWN_KEYS.contains(&key.as_str()) && !HEAD.contains(&key.as_str());
                let stored: Map<String, Json> =
                    beside.iter().filter(is_added).map(|(key, value)| (key.clone(), value.clone())).collect();
                if !agreement.same(&Json::from(stored), &json!(own.entries)) {
                    wrong.push(added(&self.study.kind));
                }
            }
            Err(why) => wrong.push(why),
        }
        self.found.findings.extend(wrong.into_iter().map(|why| (0, why)));
        self.found.agreement = agreement;
        self.found.files.extend(self.paths.finish());
        self.found.own = self.ids.len();
        self.found
    }
}

/// The settings of a check.
#[derive(Clone, Copy)]
struct How<'a> {
    study: &'a Study,
    agreement: Agreement,
    origin: &'a Origin,
}

/// A stored case that was checked without solving it again.
#[derive(Default)]
struct Checked {
    /// True if the study has this case.
    is_case: bool,
    /// True if its path is proved.
    proved: bool,
    /// The proved result, which replaces a second solution.
    instead: Option<CaseResult>,
    wrong: Vec<String>,
}

impl How<'_> {
    /// Checks a stored case by itself and against its stored path.
    fn by_itself(&self, result: &CaseResult, line: Option<&NumberedLine>) -> Checked {
        let check = || {
            let CheckedCase { case, mut wrong } = by_itself(self.study, self.origin, result);
            let Some(case) = case else { return Checked { wrong, ..Checked::default() } };
            let proved = line.map(|line| line.check(&case, result)).transpose().unwrap_or_else(|why| {
                wrong.push(why);
                None
            });
            // A search starts from all cases, so its kind solves them again in any case.
            let is_enough = |own: &ProvedCase| !self.study.makes_cases() && own.is_enough(&case, self.agreement);
            Checked {
                is_case: true,
                proved: proved.is_some(),
                instead: proved.filter(is_enough).map(|own| own.result),
                wrong,
            }
        };
        caught(check).unwrap_or_else(|why| Checked { is_case: true, wrong: vec![why], ..Checked::default() })
    }

    /// Returns the differences between an entry and its case solved again.
    fn against(&self, entry: (&Json, &CaseResult), again: &CaseResult, agreement: Agreement) -> Vec<String> {
        caught(|| against(self.study, agreement, entry, again)).unwrap_or_else(|why| vec![why])
    }
}

/// The cases of a results.json with their stored paths.
struct StoredCases<'a>(&'a StoredResults<'a>);

impl FinishedCases for StoredCases<'_> {
    fn each(&self, take: TakeCases) -> io::Result<()> {
        let (mut few, mut failed) = (Vec::new(), Ok(()));
        let mut paths = PathProofLines::new((self.0.file)(PATH_PROOFS));
        let read = read_stored_cases(self.0.results().map_err(io::Error::other)?, &mut |_, entry| {
            if failed.is_err() {
                return;
            }
            match CaseResult::deserialize(&entry) {
                Ok(case) => few.push(paths.attached_to(case)),
                Err(error) => failed = Err(error.into()),
            }
            if few.len() >= AT_ONCE {
                failed = take(&few);
                few.clear();
            }
        });
        read.map_err(io::Error::other)?;
        failed.and_then(|()| take(&few))
    }
}

/// Makes all files again from confirmed results and compares them with the existing files.
fn compare_files(study: &Study, stored: &StoredResults, beside: &Map<String, Json>, found: &mut Verification) {
    let text = |key: &str| beside.get(key).and_then(Json::as_str).map(String::from);
    let request = RunRequest {
        jobs: stored.jobs,
        version: text("version").unwrap_or_default(),
        date: text("date"),
        quiet: true,
        ..Default::default()
    };
    let files = Comparison::new(stored, found.agreement, Some(PATH_PROOFS));
    let made = caught(|| write_files(study, &request, &StoredCases(stored), &files, &mut |_| Ok(())));
    let names = match made.map(|made| made.map_err(|error| error.to_string())) {
        Ok(Ok(made)) => made.names,
        Ok(Err(why)) | Err(why) => {
            found.files.push(format!("tables and figures cannot be made: {why}"));
            return;
        }
    };
    found.files.extend(files.altered());
    // The lines of the stored paths are checked separately; they are not made from results.json.
    let listed = beside.get("files").and_then(Json::as_array).into_iter().flatten();
    let listed: Vec<&str> = listed.filter_map(Json::as_str).filter(|name| *name != PATH_PROOFS).collect();
    let own = names.iter().filter(|name| *name != PATH_PROOFS);
    if beside.contains_key("format") && !own.eq(listed) {
        found.files.push(format!("the list of files in {RESULTS} does not match the study"));
    }
}
