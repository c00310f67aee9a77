//! results.csv from cases that come one at a time and are not held: the same bytes as from results that are.

use super::csv::{header, row};
use super::csv_table::CsvRows;
use crate::results::CaseResult;
use crate::study::Sweep;
use std::io::{self, Write};

/// results.csv of a study without scenes to compare, row by row.
pub struct CsvStream<W: Write> {
    rows: CsvRows<W>,
    keys: Vec<String>,
}

impl<W: Write> CsvStream<W> {
    /// Writes the header.
    pub fn new(out: W, sweep: &Sweep) -> io::Result<Self> {
        let (keys, meanings) = (sweep.keys(), sweep.swept_keys());
        let columns = header(keys.iter().map(|key| meanings.column(key)), false);
        Ok(CsvStream { rows: CsvRows::new(out, columns)?, keys })
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
