//! Tables of very many cases, row by row, beside results.json.

use super::by_case::no_access;
use super::folder::{Aside, ResultFolder};
use crate::results::CaseResult;
use crate::study::Sweep;
use crate::writers::results_parquet::{FILE, ParquetRows, TAG};
use crate::writers::stream::CsvStream;
use std::io;

const CSV: &str = "results.csv";

/// The tables that a study asks for.
pub struct Tables<'a> {
    folder: &'a ResultFolder,
    csv: Option<CsvStream<Aside>>,
    parquet: Option<ParquetRows<Aside>>,
}

impl<'a> Tables<'a> {
    /// Begins the tables; those of an earlier run that are not wanted now are removed at the end.
    pub fn begin(sweep: &Sweep, folder: &'a ResultFolder) -> Result<Self, u8> {
        let wants = |tag: &str, by_default| {
            sweep.output.writers.as_ref().map_or(by_default, |tags| tags.iter().any(|wanted| wanted == tag))
        };
        let failed = |name: &str, error| no_access(&folder.path().join(name), error);
        let csv = match wants("results_csv", true) {
            true => Some(CsvStream::new(folder.aside(CSV)?, sweep.keys()).map_err(|error| failed(CSV, error))?),
            false => None,
        };
        let parquet = match wants(TAG, false) {
            true => {
                let rows = ParquetRows::new(folder.aside(FILE)?, sweep.expansion.number_keys(), false);
                Some(rows.map_err(|error| failed(FILE, error))?)
            }
            false => None,
        };
        Ok(Tables { folder, csv, parquet })
    }

    /// Adds the row of a case.
    pub fn add(&mut self, case: &CaseResult) -> io::Result<()> {
        self.csv.as_mut().map_or(Ok(()), |csv| csv.add(case))?;
        self.parquet.as_mut().map_or(Ok(()), |rows| rows.add(case))?;
        Ok(())
    }

    /// Gives the tables their names.
    pub fn done(self) -> Result<(), u8> {
        let folder = self.folder;
        let named = |name: &str, whole: Option<io::Result<Aside>>| match whole {
            Some(whole) => whole.map_err(|error| no_access(&folder.path().join(name), error))?.done(Ok(())),
            None => {
                folder.remove(name);
                Ok(())
            }
        };
        named(CSV, self.csv.map(CsvStream::finish))?;
        named(FILE, self.parquet.map(ParquetRows::finish))?;
        Ok(())
    }
}
