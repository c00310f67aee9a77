//! `results.json`: everything, to the last bit.

use super::register::register;
use super::results_text::{ResultsHead, ResultsText, case_text};
use super::study_output::StudyOutput;
use super::writer::Writer;
use crate::results::StudyResults;
use crate::side_by_side::in_order;
use serde_json::Value as Json;
use std::io;

/// Cases that are made into text before it is put together.
const AT_ONCE: usize = 64;

/// Writes `results.json`.
#[derive(Debug)]
pub struct ResultsJson;

impl Writer for ResultsJson {
    fn files(&self, study: &StudyOutput, _options: &Json) -> Vec<(String, Vec<u8>)> {
        let text = whole(study.results).expect("results hold no map with other keys than text");
        vec![("results.json".into(), text)]
    }
}

fn whole(results: &StudyResults) -> io::Result<Vec<u8>> {
    let StudyResults { study, version, date, only_cases, cases, comparison, own } = results;
    let head = ResultsHead {
        study: study.clone(),
        version: version.clone(),
        date: date.clone(),
        only_cases: only_cases.clone(),
    };
    let mut text = ResultsText::begin(Vec::new(), &head)?;
    for cases in cases.chunks(AT_ONCE) {
        in_order(cases, case_text).into_iter().try_for_each(|case| text.add(&case?))?;
    }
    text.finish(comparison.as_ref(), own)
}

register!(
    "results_json",
    ResultsJson,
    "results.json: every number of every case, with what proves it",
    "# `results_json`\n\nWrites `results.json`. Numbers read back to the last bit; `null` is no number.\n"
);
