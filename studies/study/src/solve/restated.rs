//! A case with some of its keys changed, read again from its own resolved study.

use crate::study::{Case, StudySource};
use serde_json::{Value as Json, json};

/// Returns the case with these dotted keys set; the error lists mistakes in them.
pub fn restated(case: &Case, sets: impl IntoIterator<Item = (String, Json)>) -> Result<Case, String> {
    // The result is a single case, for any kind of study.
    let run = ("kind".to_string(), json!("run"));
    let sets: Vec<_> = [run].into_iter().chain(sets).collect();
    let case = StudySource::of_value(&case.resolved.to_json(), &sets).and_then(Case::from_source);
    case.map_err(|wrong| wrong.mistakes().first().map_or_else(|| wrong.to_string(), |first| first.message.clone()))
}
