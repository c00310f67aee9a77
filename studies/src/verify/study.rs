//! All results of a study.

use super::case::verify_case;
use crate::kinds::kind;
use crate::results::StudyResults;
use crate::study::Study;

/// What is wrong with a set of results, by case; empty when everything is confirmed.
pub fn verify(study: &Study, results: &StudyResults) -> Vec<(usize, String)> {
    let mut wrong = Vec::new();
    if results.study != study.name {
        wrong.push((0, format!("results of \"{}\", study \"{}\"", results.study, study.name)));
    }
    let kind = kind(&study.kind);
    let mut seen = std::collections::BTreeSet::new();
    for result in &results.cases {
        if !seen.insert(result.label.id) {
            wrong.push((result.label.id, "appears twice".into()));
        }
        match kind.and_then(|kind| kind.case(study, &result.label)) {
            Some(case) => wrong.extend(verify_case(&case, result).into_iter().map(|why| (result.label.id, why))),
            None => wrong.push((result.label.id, "the study has no such case".into())),
        }
    }
    let own = kind.map(|kind| kind.own_results(study, &results.cases)).unwrap_or_default();
    if own.comparison != results.comparison {
        wrong.push((0, "the comparison is not that of the cases".into()));
    }
    if own.other != results.own {
        wrong.push((0, format!("what kind = \"{}\" adds is not that of the cases", study.kind)));
    }
    wrong
}
