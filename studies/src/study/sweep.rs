//! A study with many cases, which are made one at a time and not kept.

use super::model::Output;
use super::outline::Outline;
use crate::config::checked_keys::CheckedKeys;
use crate::config::expand::Expansion;

/// A study file without mistakes and without its cases: its size in memory does not grow with their number.
#[derive(Debug, Clone)]
pub struct Sweep {
    /// Its name.
    pub name: String,
    /// Tag of the study kind.
    pub kind: String,
    /// Axes of the study and the table of its kind.
    pub outline: Outline,
    /// Output settings.
    pub output: Output,
    /// Different notes of its cases, at most 100.
    pub notes: Vec<String>,
    /// The file with `--set` applied, as in [`super::Study`].
    pub resolved: toml::Value,
    pub(crate) expansion: Expansion,
    pub(super) checked: CheckedKeys,
}

impl Sweep {
    /// Returns the number of cases.
    pub fn count(&self) -> usize {
        self.expansion.count()
    }

    /// Returns the swept keys, outermost first.
    pub fn keys(&self) -> Vec<String> {
        self.expansion.swept().map(String::from).collect()
    }
}
