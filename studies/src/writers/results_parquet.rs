//! `results.parquet`: the rows of results.csv with types, for pandas, polars, DuckDB and others.

use super::parquet::{Cell, Parquet};
use super::register::register;
use super::study_output::StudyOutput;
use super::writer::Writer;
use crate::figures::format::{continuation_word, format_value, kind_word, status_word};
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
        let numeric =
            |key: &String| cases.iter().all(|case| case.label.parameters.get(key).is_some_and(Json::is_number));
        let keys = study
            .sweep_keys
            .iter()
            .zip(study.sweep_columns())
            .map(|(key, name)| SweptColumn { numeric: numeric(key), key: key.clone(), name })
            .collect();
        let whole = || -> io::Result<Vec<u8>> {
            let mut rows = ParquetRows::new(Vec::new(), keys, cases.iter().any(|case| case.label.scene.is_some()))?;
            cases.iter().try_for_each(|case| rows.add(case))?;
            rows.finish()
        };
        vec![(FILE.into(), whole().expect("memory takes what is written"))]
    }
}

fn count(count: Option<usize>) -> Cell {
    Cell::Whole(count.and_then(|count| i64::try_from(count).ok()))
}

fn joints(list: impl Iterator<Item = usize>) -> Option<String> {
    Some(list.map(|joint| joint.to_string()).collect::<Vec<_>>().join(" ")).filter(|text| !text.is_empty())
}

/// The cells of a case in order, each with the name of its column.
fn row(case: &CaseResult, scenes: bool, keys: &[SweptColumn]) -> Vec<(String, Cell)> {
    let word = |word: &str| Cell::Text(Some(word.to_string()).filter(|word| !word.is_empty()));
    let mechanism = case.mechanism.as_ref();
    let residual = case.certificate.residuals.values().copied().reduce(f64::max);
    let mut row = vec![
        ("id".to_string(), count(Some(case.label.id))),
        ("variant".to_string(), Cell::Text(case.label.variant.clone())),
    ];
    row.extend(scenes.then(|| ("scene".to_string(), Cell::Text(case.label.scene.clone()))));
    row.extend(keys.iter().map(|SweptColumn { key, name, numeric }| {
        let value = case.label.parameters.get(key);
        let cell =
            if *numeric { Cell::Number(value.and_then(Json::as_f64)) } else { Cell::Text(value.map(format_value)) };
        (name.clone(), cell)
    }));
    let rest = [
        ("status", word(status_word(case.status))),
        ("load_factor [-]", Cell::Number(case.load_factor)),
        ("first_limit_point [-]", Cell::Number(case.path.first_limit_point)),
        ("continuation", word(case.path.continuation.map_or("", continuation_word))),
        ("lower_bound [-]", Cell::Number(case.bounds.and_then(|bounds| bounds[0]))),
        ("upper_bound [-]", Cell::Number(case.bounds.and_then(|bounds| bounds[1]))),
        ("associated_load_factor [-]", Cell::Number(case.non_associated.associated_load_factor)),
        ("kind", word(mechanism.map_or("", |found| kind_word(found.kind)))),
        ("hinge_count", count(mechanism.map(|found| found.hinge_count))),
        ("hinge_joints", Cell::Text(mechanism.and_then(|found| joints(found.hinges.iter().map(|h| h.joint))))),
        ("sliding_joints", Cell::Text(mechanism.and_then(|found| joints(found.sliding.iter().map(|s| s.joint))))),
        ("crushing_joints", Cell::Text(mechanism.and_then(|found| joints(found.crushing.iter().map(|c| c.joint))))),
        ("unique", Cell::Truth(mechanism.and_then(|found| found.unique))),
        ("flow_read_as", Cell::Text(case.flow_read_as.clone())),
        ("certificate_passed", Cell::Truth(Some(case.certificate.passed))),
        ("largest_residual [-]", Cell::Number(residual)),
        ("solver", word(&case.solver)),
        ("seconds [s]", Cell::Number(Some(case.seconds))),
        ("notes", word(&case.notes.join(" | "))),
    ];
    row.extend(rest.map(|(name, cell)| (name.to_string(), cell)));
    row
}

/// The column of a swept key.
pub struct SweptColumn {
    /// The key.
    pub key: String,
    /// The key with its unit.
    pub name: String,
    /// True if all values are numbers.
    pub numeric: bool,
}

/// `results.parquet`, row by row.
pub struct ParquetRows<W: Write> {
    table: Parquet<W>,
    keys: Vec<SweptColumn>,
    scenes: bool,
}

impl<W: Write> ParquetRows<W> {
    /// Begins the file with columns for the swept keys; `scenes` adds one for the compared scenes.
    pub fn new(out: W, keys: Vec<SweptColumn>, scenes: bool) -> io::Result<Self> {
        let table = Parquet::new(out, &row(&CaseResult::empty(), scenes, &keys))?;
        Ok(ParquetRows { table, keys, scenes })
    }

    /// Adds the row of a case.
    pub fn add(&mut self, case: &CaseResult) -> io::Result<()> {
        self.table.add(row(case, self.scenes, &self.keys).into_iter().map(|(_, cell)| cell).collect())
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
