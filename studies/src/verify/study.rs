//! All results of a study: proofs from the stored numbers, then every number against solving again.

use super::agreement::Agreement;
use super::case::verify_case;
use crate::caught::caught;
use crate::kinds::kind;
use crate::results::{CaseResult, FORMAT, Origin, StudyResults};
use crate::solve::{Observer, Unobserved, solve_case};
use crate::study::{Case, Study};
use serde::Deserialize;
use serde_json::{Value as Json, json};
use std::collections::{BTreeMap, BTreeSet};

/// What is wrong with a set of results, by case; empty when everything is confirmed. Solves all its cases again.
pub fn verify(study: &Study, results: &StudyResults) -> Vec<(usize, String)> {
    let again = solve_again(study, results, 1, &Unobserved);
    match serde_json::to_value(results) {
        Ok(stored) => verify_against(study, &stored, &again).unwrap_or_else(|why| vec![(0, why)]),
        Err(why) => vec![(0, why.to_string())],
    }
}

/// The cases that a set of results must hold, solved again.
pub fn solve_again(study: &Study, results: &StudyResults, jobs: usize, observer: &dyn Observer) -> Vec<CaseResult> {
    solve_others_again(study, results, Vec::new(), jobs, observer)
}

/// The same, if some of the cases are `proved` already: their results take the place of solving again.
pub fn solve_others_again(
    study: &Study,
    results: &StudyResults,
    mut proved: Vec<CaseResult>,
    jobs: usize,
    observer: &dyn Observer,
) -> Vec<CaseResult> {
    let kind = kind(&study.kind);
    if kind.is_some_and(|kind| kind.makes_cases()) {
        // Its search starts from all cases.
        proved.clear();
    }
    let wanted = match &results.only_cases {
        // Each once, however long the list.
        Some(ids) => ids.iter().copied().filter(|id| *id < study.cases.len()).collect::<BTreeSet<_>>(),
        None => (0..study.cases.len()).collect(),
    };
    proved.retain(|case| wanted.contains(&case.label.id));
    let done: BTreeSet<usize> = proved.iter().map(|case| case.label.id).collect();
    let rest: Vec<usize> = wanted.difference(&done).copied().collect();
    observer.begins(rest.len());
    let mut again = kind.map(|kind| kind.solve(study, &rest, jobs, observer)).unwrap_or_default();
    again.extend(proved);
    again.sort_by_key(|case| case.label.id);
    again
}

/// What is wrong with results as they are stored, against the same cases solved `again`; an error where they are
/// no results.
pub fn verify_against(study: &Study, stored: &Json, again: &[CaseResult]) -> Result<Vec<(usize, String)>, String> {
    let results = StudyResults::deserialize(stored).map_err(|error| error.to_string())?;
    let entries = stored["cases"].as_array().ok_or("there is no list of cases")?;
    let mut check = StoredCheck::new(study, &results, again);
    entries.iter().for_each(|entry| check.entry(entry));
    check.findings()
}

/// A check of results that have been read, to which their entries are given one after another as they are stored: an
/// entry may hold more than what is read of it.
pub struct StoredCheck<'a> {
    study: &'a Study,
    results: &'a StudyResults,
    agreement: Agreement,
    again: BTreeMap<usize, &'a CaseResult>,
    /// Cases whose results were proved, not solved again.
    proved: BTreeSet<usize>,
    wrong: Vec<(usize, String)>,
    seen: usize,
}

impl<'a> StoredCheck<'a> {
    /// Of these results, against the same cases solved `again`.
    pub fn new(study: &'a Study, results: &'a StudyResults, again: &'a [CaseResult]) -> Self {
        Self::with_proved(study, results, again, BTreeSet::new())
    }

    /// The same, if some of the results `again` were proved by stored paths.
    pub fn with_proved(
        study: &'a Study,
        results: &'a StudyResults,
        again: &'a [CaseResult],
        proved: BTreeSet<usize>,
    ) -> Self {
        let agreement = Agreement::of(&results.origin, &study.resolved);
        let mut wrong = study_findings(study, results, agreement);
        wrong.extend(id_findings(study, results, again));
        let again = again.iter().map(|case| (case.label.id, case)).collect();
        StoredCheck { study, results, agreement, again, proved, wrong, seen: 0 }
    }

    /// The next entry of the list of cases.
    pub fn entry(&mut self, entry: &Json) {
        let Some(result) = self.results.cases.get(self.seen) else { return self.seen += 1 };
        self.seen += 1;
        let found = caught(|| self.differs(entry, result)).unwrap_or_else(|why| vec![why]);
        self.wrong.extend(found.into_iter().map(|why| (result.label.id, why)));
    }

    /// Findings of a case, by itself and against solving again.
    fn differs(&self, entry: &Json, result: &CaseResult) -> Vec<String> {
        let Some(case) = self.study.case_of(&result.label) else { return vec!["the study has no such case".into()] };
        let mut found = verify_case(&case, result);
        found.extend(hash_finding(&case, result, &self.results.origin));
        if let Some(again) = self.again.get(&result.label.id) {
            found.extend(self.against(&case, (entry, result), again));
        }
        found
    }

    /// The differences of an entry from its case solved again.
    fn against(&self, case: &Case, (entry, result): (&Json, &CaseResult), again: &CaseResult) -> Vec<String> {
        let mut found = Vec::new();
        let agreement = match self.proved.contains(&result.label.id) {
            true => Agreement::Processor,
            false => self.agreement,
        };
        let mut at_stored_values = None;
        // Searches of two processors choose values that differ by rounding: the stored ones are solved again.
        if self.agreement != Agreement::Bits && result.label.parameters != again.label.parameters {
            let parameters = |case: &CaseResult| json!({ "parameters": case.label.parameters });
            if !self.agreement.differences(&parameters(result), &parameters(again)).is_empty() {
                found.push("the search does not try this case".into());
            }
            at_stored_values = Some(solve_case(case));
        }
        match serde_json::to_value(at_stored_values.as_ref().unwrap_or(again)) {
            Ok(again) => found.extend(agreement.differences(entry, &again)),
            Err(why) => found.push(why.to_string()),
        }
        found
    }

    /// What is wrong; an error where other entries were given than the results have.
    pub fn findings(self) -> Result<Vec<(usize, String)>, String> {
        match self.seen == self.results.cases.len() {
            true => Ok(self.wrong),
            false => Err("the list of cases has changed while it was read".into()),
        }
    }
}

/// Finds a wrong hash of a case in results of this origin. Results of another origin have another hash.
pub fn hash_finding(case: &Case, result: &CaseResult, origin: &Origin) -> Option<String> {
    let fine = origin.format == 0 || case.hash_in(origin) == result.label.case_hash;
    (!fine).then(|| "case_hash does not match the case".into())
}

/// What stands beside the cases.
fn study_findings(study: &Study, results: &StudyResults, agreement: Agreement) -> Vec<(usize, String)> {
    let mut wrong = Vec::new();
    if results.origin.format > FORMAT {
        wrong.push((0, format!("format {}; this program reads format {FORMAT} and older", results.origin.format)));
    }
    if results.study != study.name {
        wrong.push((0, format!("results of \"{}\", study \"{}\"", results.study, study.name)));
    }
    let own = || kind(&study.kind).map(|kind| kind.own_results(study, &results.cases)).unwrap_or_default();
    let own = match caught(own) {
        Ok(own) => own,
        Err(why) => {
            wrong.push((0, why));
            return wrong;
        }
    };
    if !agreement.same(&results.comparison, &own.comparison) {
        wrong.push((0, "the comparison is not that of the cases".into()));
    }
    if !agreement.same(&results.own, &own.other) {
        wrong.push((0, format!("what kind = \"{}\" adds is not that of the cases", study.kind)));
    }
    wrong
}

/// Every case of the study once, in order, and no other; of a run of some cases only these.
fn id_findings(study: &Study, results: &StudyResults, again: &[CaseResult]) -> Vec<(usize, String)> {
    let mut wrong = Vec::new();
    let mut seen = BTreeSet::new();
    let ids: Vec<usize> = results.cases.iter().map(|case| case.label.id).collect();
    for id in &ids {
        if !seen.insert(*id) {
            wrong.push((*id, "appears twice".into()));
        }
    }
    if !ids.is_sorted() {
        wrong.push((ids[0], "the cases are not in their order".into()));
    }
    let missing = again.iter().map(|case| case.label.id).filter(|id| !seen.contains(id));
    wrong.extend(missing.map(|id| (id, "is missing".into())));
    let expected: BTreeSet<usize> = again.iter().map(|case| case.label.id).collect();
    wrong.extend(seen.difference(&expected).map(|id| (*id, "is not among the cases that were asked for".into())));
    if let Some(only) = &results.only_cases {
        let ordered = only.windows(2).all(|pair| pair[0] < pair[1]);
        let whole = only.is_empty() || only.len() >= study.cases.len();
        if whole || !ordered || only.iter().any(|id| *id >= study.cases.len()) {
            wrong.push((0, "only_cases is no choice of the study's cases".into()));
        }
    }
    wrong
}
