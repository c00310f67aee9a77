//! The axes of a study and the table of its kind: all that a kind is told before cases are made.

use serde_json::{Map, Value as Json};
use voussoir_core::plugin::Keys;

/// The axes of a study, outermost first, and what its kind is told.
#[derive(Debug, Clone, Default)]
pub struct Outline {
    /// Names of the variants; empty where there are none.
    pub variants: Vec<String>,
    /// Names of the scenes compared; empty where there is only one.
    pub scenes: Vec<String>,
    /// Keys of each axis of the sweep, which change together, and whether the first takes numbers.
    pub axes: Vec<(Vec<String>, bool)>,
    /// The table named after the study's kind; empty where it has none.
    pub table: Map<String, Json>,
}

impl Outline {
    /// The table of the study's kind; `None` if a key is missing in it.
    pub fn read<T: Keys>(&self) -> Option<T> {
        serde_json::from_value(Json::Object(self.table.clone())).ok()
    }

    /// The index of the variant with this name.
    pub fn variant(&self, name: Option<&String>) -> Option<usize> {
        self.variants.iter().position(|variant| Some(variant) == name)
    }
}
