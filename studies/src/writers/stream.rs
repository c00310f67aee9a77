//! results.csv from cases that come one at a time and are not held: the same bytes as from results that are.

use super::columns::Column;
use super::csv::row;
use super::csv_table::CsvRows;
use crate::results::CaseResult;
use std::io::{self, Write};

/// results.csv of a study without scenes to compare, row by row.
pub struct CsvStream<W: Write> {
    rows: CsvRows<W>,
    columns: Vec<Column>,
}

impl<W: Write> CsvStream<W> {
    /// Writes the header.
    pub fn new(out: W, columns: Vec<Column>) -> io::Result<Self> {
        Ok(CsvStream { rows: CsvRows::new(out, columns.iter().map(Column::header).collect())?, columns })
    }

    /// Writes the row of a case.
    pub fn add(&mut self, case: &CaseResult) -> io::Result<()> {
        self.rows.add(row(&self.columns, case))
    }

    /// Where it was written to, all of it.
    pub fn finish(self) -> io::Result<W> {
        self.rows.finish()
    }
}
