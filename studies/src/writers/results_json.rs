//! `results.json`: everything, to the last bit.

use super::json_layout::write_results;
use super::register::register;
use super::study_output::StudyOutput;
use super::writer::Writer;
use serde_json::Value as Json;

/// Writes `results.json`.
#[derive(Debug)]
pub struct ResultsJson;

impl Writer for ResultsJson {
    fn files(&self, study: &StudyOutput, _options: &Json) -> Vec<(String, Vec<u8>)> {
        let mut bytes = Vec::new();
        write_results(&mut bytes, study.results, study.results.cases.len())
            .expect("results hold no map with other keys than text");
        vec![("results.json".into(), bytes)]
    }
}

register!(
    "results_json",
    ResultsJson,
    "results.json: every number of every case, with what proves it",
    "# `results_json`\n\nWrites `results.json`, of more than 50 cases with each on a line of its own. Numbers read back to the last bit; `null` is no number.\n"
);
