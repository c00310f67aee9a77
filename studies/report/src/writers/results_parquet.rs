//! `results.parquet`: the rows of results.csv with types, for pandas, polars, DuckDB and other programs.

use super::parquet::Parquet;
use super::register::register;
use super::writer::{CaseTable, Writer};
use crate::output::StudyOutput;
use crate::output::columns::Column;
use serde_json::Value as Json;
use std::io::{self, Write};
use voussoir_study::results::CaseResult;

/// Writes `results.parquet`.
#[derive(Debug)]
pub struct ResultsParquet;

/// The table with its columns.
struct Rows {
    table: Parquet,
    columns: Vec<Column>,
}

impl Writer for ResultsParquet {
    fn table<'a>(&self, study: &StudyOutput<'a>, _options: &Json) -> Option<Box<dyn CaseTable + 'a>> {
        if !study.output.writers.iter().flatten().any(|tag| tag == "results_parquet") || study.totals.cases == 0 {
            return None;
        }
        let columns = study.file_labels().with_results();
        let table = Parquet::new(columns.iter().map(|column| (column.header(), column.kind)));
        Some(Box::new(Rows { table, columns }))
    }
}

impl CaseTable for Rows {
    fn name(&self) -> String {
        "results.parquet".into()
    }

    fn begin(&mut self, out: &mut dyn Write) -> io::Result<()> {
        self.table.begin(out)
    }

    fn add(&mut self, case: &CaseResult, out: &mut dyn Write) -> io::Result<()> {
        self.table.add(self.columns.iter().map(|column| column.cell(case)).collect(), out)
    }

    fn end(&mut self, out: &mut dyn Write) -> io::Result<()> {
        self.table.end(out)
    }
}

register!(
    "results_parquet",
    ResultsParquet,
    "results.parquet: the rows of results.csv with types, on request",
    "# `results_parquet`\n\nWrites `results.parquet`: the columns of `results.csv` as texts, numbers, counts and truths, a value that is \
     not there as null; numbers keep every bit. pandas, polars and DuckDB read it. It writes only where it is named:\n\n\
     ```toml\n[output]\nwriters = [\"results_csv\", \"results_parquet\"]\n```\n"
);
