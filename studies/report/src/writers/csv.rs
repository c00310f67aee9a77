//! `results.csv`: one row per case, units in the names of columns.

use super::csv_table::csv_row;
use super::register::register;
use super::writer::{CaseTable, Writer};
use crate::output::StudyOutput;
use crate::output::columns::Column;
use serde_json::Value as Json;
use std::io::{self, Write};
use voussoir_study::results::CaseResult;

/// Writes `results.csv`.
#[derive(Debug)]
pub struct ResultsCsv;

/// The columns of the table.
struct Rows(Vec<Column>);

impl Writer for ResultsCsv {
    fn table<'a>(&self, study: &StudyOutput<'a>, _options: &Json) -> Option<Box<dyn CaseTable + 'a>> {
        Some(Box::new(Rows(study.file_labels().with_results())))
    }
}

impl CaseTable for Rows {
    fn name(&self) -> String {
        "results.csv".into()
    }

    fn begin(&mut self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(&csv_row(self.0.iter().map(Column::header)))
    }

    fn add(&mut self, case: &CaseResult, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(&csv_row(self.0.iter().map(|column| column.cell(case).text())))
    }
}

/// The whole table of a study.
#[cfg(test)]
pub fn results_csv(study: &StudyOutput) -> String {
    let (mut rows, mut text) = (Rows(study.file_labels().with_results()), Vec::new());
    rows.begin(&mut text).expect("written");
    study.results.cases.iter().try_for_each(|case| rows.add(case, &mut text)).expect("written");
    String::from_utf8(text).expect("text")
}

register!(
    "results_csv",
    ResultsCsv,
    "results.csv: one row per case, units in the column names",
    "# `results_csv`\n\nWrites `results.csv`: one row per case. Swept quantities are numbers in SI units. Empty cells have no value; \
     joints are separated by blanks.\n"
);
