//! `results.csv`: one row per case, units in the names of columns.

use super::columns::Column;
use super::csv_table::csv_table;
use super::register::register;
use super::study_output::StudyOutput;
use super::writer::Writer;
use crate::results::CaseResult;
use serde_json::Value as Json;

/// Writes `results.csv`.
#[derive(Debug)]
pub struct ResultsCsv;

impl Writer for ResultsCsv {
    fn files(&self, study: &StudyOutput, _options: &Json) -> Vec<(String, Vec<u8>)> {
        vec![("results.csv".into(), results_csv(study).into_bytes())]
    }
}

/// The table of a study: a cell is empty where a case has no such value; lists are separated by
/// blanks, notes by ` | `.
pub fn results_csv(study: &StudyOutput) -> String {
    let columns = study.file_labels().with_results();
    let rows = study.results.cases.iter().map(|case| row(&columns, case));
    csv_table(columns.iter().map(Column::header).collect(), rows)
}

/// The row of a case under these columns.
pub(super) fn row(columns: &[Column], case: &CaseResult) -> Vec<String> {
    columns.iter().map(|column| column.cell(case).text()).collect()
}

register!(
    "results_csv",
    ResultsCsv,
    "results.csv: one row per case, units in the column names",
    "# `results_csv`\n\nWrites `results.csv`: one row per case. Swept quantities are numbers in SI units. Empty cells have no value; \
     joints are separated by blanks.\n"
);
