//! `results.json`: everything, to the last bit.

use super::register::register;
use super::results_text::{ResultsHead, ResultsText, case_text};
use super::study_output::StudyOutput;
use super::writer::Writer;
use crate::results::StudyResults;
use crate::side_by_side::{in_order, threads};
use serde_json::Value as Json;
use std::io::{self, Write};

/// Cases that are made into text before it is put together.
const CASES: usize = 64;
/// Bytes of such text, as long as there is more than a case for each thread in it.
const BYTES: usize = 1 << 20;

/// Writes `results.json`.
#[derive(Debug)]
pub struct ResultsJson;

impl Writer for ResultsJson {
    fn files(&self, study: &StudyOutput, _options: &Json) -> Vec<(String, Vec<u8>)> {
        let text = write_results(Vec::new(), study.results).expect("results hold no map with other keys than text");
        vec![("results.json".into(), text)]
    }
}

/// Writes results.json; where it was written to.
pub fn write_results<W: Write>(out: W, results: &StudyResults) -> io::Result<W> {
    let StudyResults { study, version, origin, date, only_cases, files, cases, comparison, own } = results;
    let head = ResultsHead {
        study: study.clone(),
        version: version.clone(),
        origin: origin.clone(),
        date: date.clone(),
        only_cases: only_cases.clone(),
        files: files.clone(),
    };
    let mut text = ResultsText::begin(out, &head)?;
    let (threads, mut left) = (threads(), cases.as_slice());
    let mut count = threads;
    while !left.is_empty() {
        let (now, later) = left.split_at(count.min(left.len()));
        left = later;
        if let [case] = now {
            text.write(case)?;
            continue;
        }
        let mut longest = 1;
        for case in in_order(now, case_text) {
            let case = case?;
            longest = longest.max(case.len());
            text.add(&case)?;
        }
        // Of long texts no more are held than are made at once.
        count = (BYTES / longest).clamp(threads, CASES.max(threads));
    }
    text.finish(comparison.as_ref(), own)
}

register!(
    "results_json",
    ResultsJson,
    "results.json: every number of every case, with what proves it",
    "# `results_json`\n\nWrites `results.json`. Numbers read back to the last bit; `null` is no number.\n"
);
