//! The options of `voussoir run`.

use super::progress::Shown;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::str::FromStr;

/// Reads a whole number of at least 1.
///
/// # Errors
/// The reason why it is not one.
pub fn at_least_one(text: &str) -> Result<usize, String> {
    text.parse().ok().filter(|count| *count > 0).ok_or("give a whole number of at least 1".into())
}

/// Reads the id of a case.
///
/// # Errors
/// The reason why it is not one.
pub fn case_id(text: &str) -> Result<usize, String> {
    text.parse()
        .map_err(|_| "give the id of a case, a whole number from 0; `voussoir run STUDY --list` shows them".into())
}

/// Options of `voussoir run`.
#[derive(Debug, Default)]
pub struct Options {
    /// The folder for the results.
    pub out: Option<PathBuf>,
    /// KEY=VALUE overrides.
    pub set: Vec<String>,
    /// Number of cases that are solved in parallel.
    pub jobs: usize,
    /// Solve only this case.
    pub case: Option<usize>,
    /// Continue from finished cases.
    pub resume: bool,
    /// Print nothing but errors.
    pub quiet: bool,
    /// Solve only this part of the study.
    pub shard: Option<Shard>,
    /// Print each solved case as a line of JSON, and nothing else, on standard output.
    pub json: bool,
    /// List the cases and solve none.
    pub list: bool,
    /// Open the report after it is written.
    pub open: bool,
    /// The arguments that continue this run after an interruption.
    pub again: Vec<String>,
}

impl Options {
    /// The progress display.
    pub fn shown(&self) -> Shown {
        match (self.json, self.quiet) {
            (true, _) => Shown::Lines,
            (false, true) => Shown::Nothing,
            (false, false) => Shown::Bar,
        }
    }
}

/// The number of a part and the number of all parts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// Number of this part, from 1.
    pub number: usize,
    /// Number of parts.
    pub of: usize,
}

impl FromStr for Shard {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts =
            text.split_once('/').and_then(|(number, of)| Some((number.trim().parse().ok()?, of.trim().parse().ok()?)));
        match parts {
            Some((number, of)) if (1..=of).contains(&number) => Ok(Shard { number, of }),
            _ => Err("write M/N with M from 1 to N: --shard 1/3, 2/3 and 3/3 are the whole study".into()),
        }
    }
}

impl Shard {
    /// Name of the folder of this part, in the folder of the results.
    pub fn folder(&self) -> String {
        format!("shard-{}-of-{}", self.number, self.of)
    }
}

/// Limits the number of parallel cases to the number of processors.
pub fn useful_jobs(jobs: usize) -> usize {
    jobs.clamp(1, std::thread::available_parallelism().map_or(1, usize::from))
}
