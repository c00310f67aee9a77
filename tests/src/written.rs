//! Results as written to files, and the findings of `verify`.

use crate::gates::above_gates;
use crate::study;
use serde_json::Value;
use std::collections::HashMap;
use std::sync::{Arc, LazyLock, Mutex};
use voussoir::kinds::kind;
use voussoir::results::{CaseResult, StudyResults};
use voussoir::solve::Unobserved;
use voussoir::study::{Study, load};
use voussoir::verify::{solve_again, verify_against};

/// Returns the study as read back from resolved.toml, and its results as written to a file.
pub fn results(text: &str) -> (Study, Value) {
    let original = study(text);
    let resolved = toml::to_string(&original.resolved).expect("a study can be written");
    let again = load(&resolved, "resolved.toml", &[]).unwrap_or_else(|m| panic!("{m}\n{resolved}"));
    let (kind, wanted) =
        (kind(&original.kind).expect("a registered kind"), (0..original.cases.len()).collect::<Vec<_>>());
    let results = original.results("test", kind.solve(&original, &wanted, 1, &Unobserved));
    for case in &results.cases {
        assert_eq!(above_gates(case, 1e-9, 0.0), Vec::<String>::new());
    }
    (again, serde_json::to_value(&results).expect("results can be written"))
}

/// Solves the cases of a study again, once for all changes of its results that a test tries.
fn again(study: &Study, results: &StudyResults) -> Arc<Vec<CaseResult>> {
    static SOLVED: LazyLock<Mutex<HashMap<String, Arc<Vec<CaseResult>>>>> = LazyLock::new(Mutex::default);
    let key = format!("{} {:?}", study.resolved, results.only_cases);
    if let Some(found) = SOLVED.lock().expect("no test has panicked here").get(&key) {
        return found.clone();
    }
    let solved = Arc::new(solve_again(study, results, 1, &Unobserved));
    SOLVED.lock().expect("no test has panicked here").entry(key).or_insert(solved).clone()
}

/// Returns the findings of `verify` for results, also if they cannot be read.
pub fn findings(study: &Study, results: &Value) -> Vec<String> {
    let read = match serde_json::from_value::<StudyResults>(results.clone()) {
        Ok(read) => read,
        Err(why) => return vec![why.to_string()],
    };
    match verify_against(study, results, &again(study, &read)) {
        Ok(found) => found.into_iter().map(|(_, why)| why).collect(),
        Err(why) => vec![why],
    }
}
