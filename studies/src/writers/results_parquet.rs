//! `results.parquet`: the rows of results.csv with types, for pandas, polars, DuckDB and others.

use super::columns::Column;
use super::parquet::Parquet;
use super::register::register;
use super::study_output::StudyOutput;
use super::writer::Writer;
use crate::results::CaseResult;
use serde_json::Value as Json;
use std::io::{self, Write};

/// Writes `results.parquet`.
#[derive(Debug)]
pub struct ResultsParquet;

/// Tag of the writer.
pub const TAG: &str = "results_parquet";
/// Name of the file.
pub const FILE: &str = "results.parquet";

impl Writer for ResultsParquet {
    fn files(&self, study: &StudyOutput, _options: &Json) -> Vec<(String, Vec<u8>)> {
        let cases = &study.results.cases;
        if !study.output.writers.iter().flatten().any(|tag| tag == TAG) || cases.is_empty() {
            return Vec::new();
        }
        let whole = || -> io::Result<Vec<u8>> {
            let mut rows = ParquetRows::new(Vec::new(), study.file_labels().with_results())?;
            cases.iter().try_for_each(|case| rows.add(case))?;
            rows.finish()
        };
        vec![(FILE.into(), whole().expect("memory takes what is written"))]
    }
}

/// `results.parquet`, row by row.
pub struct ParquetRows<W: Write> {
    table: Parquet<W>,
    columns: Vec<Column>,
}

impl<W: Write> ParquetRows<W> {
    /// Begins the file with these columns.
    pub fn new(out: W, columns: Vec<Column>) -> io::Result<Self> {
        let table = Parquet::new(out, columns.iter().map(|column| (column.header(), column.kind)))?;
        Ok(ParquetRows { table, columns })
    }

    /// Adds the row of a case.
    pub fn add(&mut self, case: &CaseResult) -> io::Result<()> {
        self.table.add(self.columns.iter().map(|column| column.cell(case)).collect())
    }

    /// Where it was written to, all of it.
    pub fn finish(self) -> io::Result<W> {
        self.table.finish()
    }
}

register!(
    "results_parquet",
    ResultsParquet,
    "results.parquet: the rows of results.csv with types, where it is asked for by name",
    "# `results_parquet`\n\nWrites `results.parquet`: the columns of `results.csv` as texts, numbers, counts and truths, a value that is \
     not there as null; numbers keep every bit. pandas, polars and DuckDB read it. It writes only where it is named:\n\n\
     ```toml\n[output]\nwriters = [\"results_csv\", \"results_parquet\"]\n```\n\nStudies of more than 5000 cases write it row by row.\n"
);
