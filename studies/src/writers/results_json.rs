//! `results.json`: everything, to the last bit.

use super::register::register;
use super::study_output::StudyOutput;
use super::writer::Writer;
use serde_json::Value as Json;

/// Writes `results.json`.
#[derive(Debug)]
pub struct ResultsJson;

impl Writer for ResultsJson {
    fn files(&self, study: &StudyOutput, _options: &Json) -> Vec<(String, Vec<u8>)> {
        let text = serde_json::to_string_pretty(study.results).expect("results hold no map with other keys than text");
        vec![("results.json".into(), (text + "\n").into_bytes())]
    }
}

register!(
    "results_json",
    ResultsJson,
    "results.json: every number of every case, with what proves it",
    "# `results_json`\n\nWrites `results.json`. Numbers read back to the last bit; `null` is no number.\n"
);
