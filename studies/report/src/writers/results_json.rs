//! `results.json`: all results, with every bit of each number.

use super::register::register;
use super::results_text::{ResultsText, case_text};
use super::writer::Writer;
use std::io::{self, Write};
use voussoir_study::results::CaseResult;
use voussoir_study::side_by_side::in_order;

/// Number of cases whose texts are in memory at the same time.
const AT_ONCE: usize = 64;

/// Writes `results.json`. Every run writes this file; it names the other files.
#[derive(Debug)]
pub struct ResultsJson;

impl Writer for ResultsJson {}

/// Adds cases to results.json; their texts are made in parallel.
pub fn add_cases<W: Write>(text: &mut ResultsText<W>, cases: &[CaseResult]) -> io::Result<()> {
    if let [case] = cases {
        // A case of a million blocks has half a gigabyte, so its text is not held in memory.
        return text.write(case);
    }
    cases.chunks(AT_ONCE).try_for_each(|few| in_order(few, case_text).into_iter().try_for_each(|case| text.add(&case?)))
}

register!(
    "results_json",
    ResultsJson,
    "results.json: every number of every case, with its certificate",
    "# `results_json`\n\n`results.json` is written by every run. Numbers read back to the last bit; `null` is no number.\n"
);
