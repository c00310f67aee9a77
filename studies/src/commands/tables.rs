//! Tables of very many cases, row by row, beside results.json.

use super::error::CliError;
use super::folder::{Aside, ResultFolder};
use crate::results::CaseResult;
use crate::study::Sweep;
use crate::writers::streamed_tables::{StreamedTable, TABLES, wanted};
use std::io;

/// The tables that a study asks for.
pub struct Tables<'a> {
    folder: &'a ResultFolder,
    tables: Vec<(&'static str, StreamedTable<Aside>)>,
}

impl<'a> Tables<'a> {
    /// Begins the tables.
    pub fn begin(sweep: &Sweep, folder: &'a ResultFolder) -> Result<Self, CliError> {
        let begun = |name: &'static str| {
            let table = StreamedTable::new(name, folder.aside(name)?, sweep);
            Ok((name, table.map_err(|error| CliError::of_file(&folder.path().join(name), error))?))
        };
        Ok(Tables { folder, tables: wanted(sweep).into_iter().map(begun).collect::<Result<_, CliError>>()? })
    }

    /// Adds the row of a case.
    pub fn add(&mut self, case: &CaseResult) -> io::Result<()> {
        self.tables.iter_mut().try_for_each(|(_, table)| table.add(case))
    }

    /// Gives the tables their names; those of an earlier run that are not wanted now are removed.
    pub fn done(self) -> Result<(), CliError> {
        let folder = self.folder;
        let unwanted = |name: &&&str| self.tables.iter().all(|(own, _)| own != *name);
        TABLES.iter().filter(unwanted).for_each(|name| folder.remove(name));
        self.tables.into_iter().try_for_each(|(name, table)| {
            table.finish().map_err(|error| CliError::of_file(&folder.path().join(name), error))?.done(Ok(()))
        })
    }
}
