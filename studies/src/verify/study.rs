//! All results of a study: proofs from the stored numbers, then every number against solving again.

use super::case::verify_case;
use super::repeat::differences;
use crate::caught::caught;
use crate::kinds::kind;
use crate::results::{CaseResult, StudyResults};
use crate::solve::{Observer, Unobserved};
use crate::study::Study;
use serde::Deserialize;
use serde_json::Value as Json;
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
    let wanted = match &results.only_cases {
        // Each once, however long the list.
        Some(ids) => ids.iter().copied().filter(|id| *id < study.cases.len()).collect::<BTreeSet<_>>(),
        None => (0..study.cases.len()).collect(),
    };
    let wanted: Vec<usize> = wanted.into_iter().collect();
    observer.begins(wanted.len());
    kind(&study.kind).map(|kind| kind.solve(study, &wanted, jobs, observer)).unwrap_or_default()
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
    again: BTreeMap<usize, &'a CaseResult>,
    wrong: Vec<(usize, String)>,
    seen: usize,
}

impl<'a> StoredCheck<'a> {
    /// Of these results, against the same cases solved `again`.
    pub fn new(study: &'a Study, results: &'a StudyResults, again: &'a [CaseResult]) -> Self {
        let mut wrong = study_findings(study, results);
        wrong.extend(id_findings(study, results, again));
        let again = again.iter().map(|case| (case.label.id, case)).collect();
        StoredCheck { study, results, again, wrong, seen: 0 }
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
        match self.again.get(&result.label.id).map(serde_json::to_value) {
            Some(Ok(again)) => found.extend(differences(entry, &again)),
            Some(Err(why)) => found.push(why.to_string()),
            None => {}
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

/// What stands beside the cases.
fn study_findings(study: &Study, results: &StudyResults) -> Vec<(usize, String)> {
    let mut wrong = Vec::new();
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
    if own.comparison != results.comparison {
        wrong.push((0, "the comparison is not that of the cases".into()));
    }
    if own.other != results.own {
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
