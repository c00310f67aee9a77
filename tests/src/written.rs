//! Results as they are written, and what `verify` finds in them.

use crate::study;
use serde_json::Value;
use voussoir::results::StudyResults;
use voussoir::solve_case;
use voussoir::study::{Study, load};
use voussoir::verify::verify;

/// Results of a study, as they are written, and the study as it is read back from resolved.toml.
pub fn results(text: &str) -> (Study, Value) {
    let original = study(text);
    let resolved = toml::to_string(&original.resolved).expect("a study can be written");
    let again = load(&resolved, "resolved.toml", &[]).unwrap_or_else(|m| panic!("{}\n{resolved}", m[0]));
    let cases = original.cases.iter().map(solve_case).collect();
    let results =
        StudyResults { study: original.name, version: "test".into(), cases, comparison: None, own: Default::default() };
    (again, serde_json::to_value(&results).expect("results can be written"))
}

/// What `verify` says of results; also where they cannot be read.
pub fn findings(study: &Study, results: &Value) -> Vec<String> {
    let text = serde_json::to_string(results).expect("JSON");
    match serde_json::from_str::<StudyResults>(&text) {
        Ok(results) => verify(study, &results).into_iter().map(|(_, why)| why).collect(),
        Err(why) => vec![why.to_string()],
    }
}
