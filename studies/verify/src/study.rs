//! Checks all results of a study: first the proofs from the stored numbers, then every number against solving again.

use serde::Deserialize;
use serde_json::{Value as Json, json};
use std::borrow::Cow;
use std::collections::BTreeSet;
use voussoir_study::cases::{Observer, Unobserved, solve_case};
use voussoir_study::caught::caught;
use voussoir_study::checks::Agreement;
use voussoir_study::checks::case::verify_case;
use voussoir_study::checks::findings::mismatch;
use voussoir_study::kind::kind;
use voussoir_study::results::{CaseResult, Origin, StudyResults};
use voussoir_study::study::{Case, Study};

/// The finding about a wrong comparison.
pub const COMPARISON: &str = "comparison: its entries differ from those that the stored cases give";

/// The finding about wrong entries that a kind of study makes from its cases.
pub fn added(kind: &str) -> String {
    format!("the entries of kind = \"{kind}\" beside the cases differ from those that the stored cases give")
}

/// Solves all cases again and returns the findings by case; empty if all results are confirmed.
pub fn verify(study: &Study, results: &StudyResults) -> Vec<(usize, String)> {
    let again = solve_again(study, results, 1, &Unobserved);
    match serde_json::to_value(results) {
        Ok(stored) => verify_against(study, &stored, &again).unwrap_or_else(|why| vec![(0, why)]),
        Err(why) => vec![(0, why.to_string())],
    }
}

/// Solves the cases again that a set of results must contain.
pub fn solve_again(study: &Study, results: &StudyResults, jobs: usize, observer: &dyn Observer) -> Vec<CaseResult> {
    let wanted = match &results.only_cases {
        // Each case is solved once, even if an id is repeated in the list.
        Some(ids) => ids.iter().copied().filter(|id| *id < study.count()).collect::<BTreeSet<_>>(),
        None => (0..study.count()).collect(),
    };
    let (wanted, mut again) = (wanted.into_iter().collect::<Vec<_>>(), Vec::new());
    study.solve(&wanted, jobs, observer, &mut |case| again.push(case));
    again.sort_by_key(|case: &CaseResult| case.label.id);
    again
}

/// Compares stored results with the cases solved `again` and returns the findings. Returns an error if the text is not
/// a result file.
pub fn verify_against(study: &Study, stored: &Json, again: &[CaseResult]) -> Result<Vec<(usize, String)>, String> {
    let results = StudyResults::deserialize(stored).map_err(|error| error.to_string())?;
    let entries = stored.get("cases").and_then(Json::as_array).ok_or("there is no list of cases")?;
    let agreement = Agreement::of(&results.origin, &study.resolved);
    let mut wrong = study_findings(study, &results, agreement);
    wrong.extend(id_findings(study, &results, again));
    for (entry, result) in entries.iter().zip(&results.cases) {
        let id = result.label.id;
        let differs = || {
            let mut found = by_itself(study, &results.origin, result);
            if let Some(again) = again.iter().find(|case| case.label.id == id).filter(|_| found.case.is_some()) {
                found.wrong.extend(against(study, agreement, (entry, result), again));
            }
            found.wrong
        };
        let found = caught(differs).unwrap_or_else(|why| vec![why]);
        wrong.extend(found.into_iter().map(|why| (id, why)));
    }
    Ok(wrong)
}

/// A stored case that was checked by itself.
pub struct CheckedCase<'a> {
    /// The case of the study that it belongs to.
    pub case: Option<Cow<'a, Case>>,
    /// The findings.
    pub wrong: Vec<String>,
}

/// Checks a stored case by itself, without a solver.
pub fn by_itself<'a>(study: &'a Study, origin: &Origin, result: &CaseResult) -> CheckedCase<'a> {
    let case = study.case_of(&result.label);
    let wrong = match &case {
        Some(case) => verify_case(case, result).into_iter().chain(hash_finding(case, result, origin)).collect(),
        None => vec!["the study has no case with this id, variant and these parameters".into()],
    };
    CheckedCase { case, wrong }
}

/// The differences of the entry of a case from the same case solved again.
pub fn against(
    study: &Study,
    agreement: Agreement,
    (entry, result): (&Json, &CaseResult),
    again: &CaseResult,
) -> Vec<String> {
    let mut found = Vec::new();
    let mut at_stored_values = None;
    // Searches of two processors choose values that differ by rounding: the stored ones are solved again.
    if agreement != Agreement::Bits && result.label.parameters != again.label.parameters {
        let parameters = |case: &CaseResult| json!({ "parameters": case.label.parameters });
        if !agreement.differences(&parameters(result), &parameters(again)).is_empty() {
            found.push("the search of the study does not try these parameters".into());
        }
        at_stored_values = study.case_of(&result.label).map(|case| solve_case(&case));
    }
    match serde_json::to_value(at_stored_values.as_ref().unwrap_or(again)) {
        Ok(again) => found.extend(agreement.differences(entry, &again)),
        Err(why) => found.push(why.to_string()),
    }
    found
}

/// Finds a wrong hash of a case in results of this origin. Results of another origin have another hash.
fn hash_finding(case: &Case, result: &CaseResult, origin: &Origin) -> Option<String> {
    let fine = origin.format == 0 || case.hash_in(origin) == result.label.case_hash;
    (!fine).then(|| "case_hash differs from the hash of this case of the study".into())
}

/// Checks the entries beside the cases.
fn study_findings(study: &Study, results: &StudyResults, agreement: Agreement) -> Vec<(usize, String)> {
    let mut wrong: Vec<_> = results.origin.too_new().map(|why| (0, why)).into_iter().collect();
    if results.study != study.name {
        wrong.push((0, mismatch("study", (&results.study, "the name in resolved.toml is", &study.name))));
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
        wrong.push((0, COMPARISON.into()));
    }
    if !agreement.same(&results.own, &own.entries) {
        wrong.push((0, added(&study.kind)));
    }
    wrong
}

/// Checks that every case of the study is present once, in order, and no other. A run of some cases must have only
/// these.
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
        wrong.push((ids[0], "the entries of cases are not in the order of their ids".into()));
    }
    let missing = again.iter().map(|case| case.label.id).filter(|id| !seen.contains(id));
    wrong.extend(missing.map(|id| (id, "is missing".into())));
    let expected: BTreeSet<usize> = again.iter().map(|case| case.label.id).collect();
    wrong.extend(
        seen.difference(&expected)
            .map(|id| (*id, "is in the results, but the study or only_cases does not have it".into())),
    );
    if let Some(only) = &results.only_cases {
        let ordered = only.windows(2).all(|pair| pair[0] < pair[1]);
        let whole = only.is_empty() || only.len() >= study.count();
        if whole || !ordered || only.iter().any(|id| *id >= study.count()) {
            wrong.push((0, "only_cases must list some, not all, ids of the study in rising order".into()));
        }
    }
    wrong
}
