//! What `voussoir run` is asked for.

use super::progress::Shown;
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::str::FromStr;

/// Options of `voussoir run`.
#[derive(Debug, Default)]
pub struct Options {
    /// Where results go.
    pub out: Option<PathBuf>,
    /// KEY=VALUE overrides.
    pub set: Vec<String>,
    /// Cases side by side.
    pub jobs: usize,
    /// Only this case.
    pub case: Option<usize>,
    /// Go on from finished cases.
    pub resume: bool,
    /// Print nothing but errors.
    pub quiet: bool,
    /// Only this part of the study.
    pub shard: Option<Shard>,
    /// Answered cases as lines of JSON on standard output, and nothing else there.
    pub json: bool,
    /// Say which cases there are, and solve none.
    pub list: bool,
    /// Open the report when it is written.
    pub open: bool,
    /// The arguments that go on with this run after an interruption.
    pub again: Vec<String>,
}

impl Options {
    /// What is shown meanwhile.
    pub fn shown(&self) -> Shown {
        match (self.json, self.quiet) {
            (true, _) => Shown::Lines,
            (false, true) => Shown::Nothing,
            (false, false) => Shown::Bar,
        }
    }
}

/// Which part of how many.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub struct Shard {
    /// From 1.
    pub number: usize,
    /// All parts.
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
    /// The folder of this part in that of the results.
    pub fn folder(&self) -> String {
        format!("shard-{}-of-{}", self.number, self.of)
    }
}

/// Cases side by side that help: no more than processors.
pub fn useful_jobs(jobs: usize) -> usize {
    jobs.clamp(1, std::thread::available_parallelism().map_or(1, usize::from))
}
