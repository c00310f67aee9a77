//! results.csv from cases that come one at a time and are not held: the same bytes as from results that are.

use super::csv::{header, row};
use super::csv_table::CsvRows;
use crate::results::CaseResult;
use std::io::{self, Write};

/// results.csv of a study without scenes to compare, row by row.
pub struct CsvStream<W: Write> {
    rows: CsvRows<W>,
    keys: Vec<String>,
}

impl<W: Write> CsvStream<W> {
    /// Writes the header; `keys` are those that are swept.
    pub fn new(out: W, keys: Vec<String>) -> io::Result<Self> {
        Ok(CsvStream { rows: CsvRows::new(out, header(&keys, false))?, keys })
    }

    /// Writes the row of a case.
    pub fn add(&mut self, case: &CaseResult) -> io::Result<()> {
        self.rows.add(row(case, false, &self.keys))
    }

    /// Where it was written to, all of it.
    pub fn finish(self) -> io::Result<W> {
        self.rows.finish()
    }
}
