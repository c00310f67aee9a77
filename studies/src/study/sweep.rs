//! A study of so many cases that they are made one at a time, and none is kept.

use super::model::Output;
use super::outline::Outline;
use crate::config::checked_keys::CheckedKeys;
use crate::config::expand::Expansion;

/// A study file that holds no mistake, without its cases: what it takes does not grow with their number.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// Its name.
    pub name: String,
    /// What is done with the cases: the tag of a study kind.
    pub kind: String,
    /// Its axes and the table of its kind.
    pub outline: Outline,
    /// What is written.
    pub output: Output,
    /// Different notes of its cases, up to a hundred.
    pub notes: Vec<String>,
    /// The file with `--set` applied, as of [`super::Study`].
    pub resolved: toml::Value,
    pub(crate) expansion: Expansion,
    pub(super) checked: CheckedKeys,
}

impl Sweep {
    /// Number of cases.
    pub fn count(&self) -> usize {
        self.expansion.count()
    }

    /// Swept keys, outermost first.
    pub fn keys(&self) -> Vec<String> {
        self.expansion.swept().map(String::from).collect()
    }
}
