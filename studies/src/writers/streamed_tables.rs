//! The files beside results.json of very many cases, row by row: those that a study asks for, by their name.

use super::columns::{Column, Labels};
use super::path_proofs::write_path_proof;
use super::results_parquet::{FILE, ParquetRows, TAG};
use super::stream::CsvStream;
use crate::results::CaseResult;
use crate::results::stored_path::PATH_PROOFS;
use crate::study::Sweep;
use std::io::{self, Write};

const CSV: &str = "results.csv";

/// A table while it is written.
pub enum StreamedTable<W: Write> {
    /// results.csv.
    Csv(Box<CsvStream<W>>),
    /// results.parquet.
    Parquet(Box<ParquetRows<W>>),
    /// path_proofs.jsonl.
    PathProofs(W),
}

/// Names of the tables that a sweep asks for.
pub fn wanted(sweep: &Sweep) -> Vec<&'static str> {
    let wants = |tag: &str, by_default| {
        sweep.output.writers.as_ref().map_or(by_default, |tags| tags.iter().any(|wanted| wanted == tag))
    };
    let proofs = sweep.output.path_proofs == Some(true);
    let tables = [(PATH_PROOFS, proofs), (CSV, wants("results_csv", true)), (FILE, wants(TAG, false))];
    tables.into_iter().filter(|(_, wanted)| *wanted).map(|(name, _)| name).collect()
}

/// The columns of the tables of results.
fn columns(sweep: &Sweep) -> Vec<Column> {
    Labels { swept: &sweep.keys(), keys: &sweep.swept_keys(), variants: true, scenes: false }.with_results()
}

/// Names of all tables.
pub const TABLES: [&str; 3] = [PATH_PROOFS, CSV, FILE];

impl<W: Write> StreamedTable<W> {
    /// Begins the table of this name.
    pub fn new(name: &str, out: W, sweep: &Sweep) -> io::Result<Self> {
        Ok(match name {
            PATH_PROOFS => StreamedTable::PathProofs(out),
            FILE => StreamedTable::Parquet(Box::new(ParquetRows::new(out, columns(sweep))?)),
            _ => StreamedTable::Csv(Box::new(CsvStream::new(out, columns(sweep))?)),
        })
    }

    /// Adds the row of a case.
    pub fn add(&mut self, case: &CaseResult) -> io::Result<()> {
        match self {
            StreamedTable::Csv(rows) => rows.add(case),
            StreamedTable::Parquet(rows) => rows.add(case),
            StreamedTable::PathProofs(out) => write_path_proof(out, case),
        }
    }

    /// Where it was written to, all of it.
    pub fn finish(self) -> io::Result<W> {
        match self {
            StreamedTable::Csv(rows) => rows.finish(),
            StreamedTable::Parquet(rows) => rows.finish(),
            StreamedTable::PathProofs(out) => Ok(out),
        }
    }
}
