//! results.json and results.csv from cases that come one at a time and are not held: the same bytes as from results that
//! are.

use super::csv::{header, row};
use super::csv_table::CsvRows;
use crate::results::CaseResult;
use serde::Serialize;
use serde::ser::{Error, SerializeMap, SerializeSeq, Serializer};
use std::cell::RefCell;
use std::io::{self, Write};

/// Cases one after the other, as they are read from a file.
pub type CaseIterator<'a> = dyn Iterator<Item = io::Result<CaseResult>> + 'a;

/// What stands before the cases.
#[derive(Debug, Clone)]
pub struct StreamedResults {
    /// Name of the study.
    pub study: String,
    /// Version of the program.
    pub version: String,
    /// The day of the run.
    pub date: Option<String>,
    /// Ids of the cases, where the run was asked for some of them only.
    pub only_cases: Option<Vec<usize>>,
}

/// Cases that serde may read once.
struct Once<'a, 'b>(RefCell<&'b mut CaseIterator<'a>>);

impl Serialize for Once<'_, '_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut list = serializer.serialize_seq(None)?;
        for case in &mut **self.0.borrow_mut() {
            list.serialize_element(&case.map_err(S::Error::custom)?)?;
        }
        list.end()
    }
}

/// The whole file.
struct Whole<'a, 'b>(&'b StreamedResults, Once<'a, 'b>);

impl Serialize for Whole<'_, '_> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let Whole(head, cases) = self;
        let mut map = serializer.serialize_map(None)?;
        map.serialize_entry("study", &head.study)?;
        map.serialize_entry("version", &head.version)?;
        if let Some(date) = &head.date {
            map.serialize_entry("date", date)?;
        }
        if let Some(only) = &head.only_cases {
            map.serialize_entry("only_cases", only)?;
        }
        map.serialize_entry("cases", cases)?;
        map.end()
    }
}

/// Writes results.json.
pub fn write_json(out: &mut dyn Write, head: &StreamedResults, cases: &mut CaseIterator<'_>) -> io::Result<()> {
    serde_json::to_writer_pretty(&mut *out, &Whole(head, Once(RefCell::new(cases))))?;
    out.write_all(b"\n")
}

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
