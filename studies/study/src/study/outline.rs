//! The axes of a study and the table of its kind: the data that a kind gets before cases are made.

use serde_json::{Map, Value as Json};
use voussoir_core::plugin::Keys;

/// The axes of a study, outermost first, and the table of its kind.
#[derive(Debug, Clone, Default)]
pub struct Outline {
    /// Names of the variants; empty if there are none.
    pub variants: Vec<String>,
    /// Names of the compared scenes; empty if there is only one.
    pub scenes: Vec<String>,
    /// Keys of each axis of the sweep, which change together, with true if the values of the first key are numbers.
    pub axes: Vec<(Vec<String>, bool)>,
    /// The table of the study's kind; empty if it has none.
    pub table: Map<String, Json>,
}

impl Outline {
    /// Reads the table of the study's kind; `None` if a key is missing.
    pub fn read<T: Keys>(&self) -> Option<T> {
        serde_json::from_value(Json::Object(self.table.clone())).ok()
    }

    /// Returns the index of the variant with this name.
    pub fn variant(&self, name: Option<&String>) -> Option<usize> {
        self.variants.iter().position(|variant| Some(variant) == name)
    }
}
