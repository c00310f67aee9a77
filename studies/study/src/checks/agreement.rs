//! Chooses how results are compared with a second run: bit by bit if both were made by the same program on the same
//! kind of processor, otherwise by their claims.

use crate::checks::{meaning, repeat, texts};
use crate::results::{Origin, words};
use serde::Serialize;
use serde_json::{Map, Value as Json};

/// The kind of comparison of two runs.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Agreement {
    /// Every number and word must be the same.
    Bits,
    /// The same program on another kind of processor: claims must be the same, numbers within the tolerances of
    /// [`super::tolerances`].
    Processor,
    /// Another program: like `Processor`, but tables and figures are not compared.
    #[default]
    Program,
}

impl Agreement {
    /// Returns the comparison for stored results with this origin and for a study that is given as resolved.toml.
    pub fn of(stored: &Origin, study: &toml::Value) -> Agreement {
        let here = Origin::here(&words(study));
        match (stored.agrees(&here), stored.program() == here.program()) {
            (true, _) => Agreement::Bits,
            (false, true) => Agreement::Processor,
            (false, false) => Agreement::Program,
        }
    }

    /// Returns the comparison for a results.json whose head is given.
    pub fn of_head(head: &Map<String, Json>, study: &toml::Value) -> Agreement {
        let origin = serde_json::from_value(Json::Object(head.clone()));
        Agreement::of(&origin.unwrap_or_default(), study)
    }

    /// Returns the differences between a stored value and the value of a second run.
    pub fn differences(self, stored: &Json, again: &Json) -> Vec<String> {
        match self {
            Agreement::Bits => repeat::differences(stored, again),
            Agreement::Processor | Agreement::Program => meaning::differences(stored, again),
        }
    }

    /// Returns true if two values other than cases agree.
    pub fn same<T: Serialize>(self, stored: &T, again: &T) -> bool {
        match (serde_json::to_value(stored), serde_json::to_value(again)) {
            (Ok(stored), Ok(again)) if self == Agreement::Bits => repeat::differences(&stored, &again).is_empty(),
            (Ok(stored), Ok(again)) => meaning::same(&stored, &again),
            _ => false,
        }
    }

    /// Returns true if two files agree.
    pub fn same_file(self, stored: &[u8], made: &[u8]) -> bool {
        match self {
            Agreement::Bits => stored == made,
            Agreement::Processor => texts::same_but_rounding(stored, made),
            Agreement::Program => true,
        }
    }

    /// Describes the comparison.
    pub fn words(self) -> &'static str {
        match self {
            Agreement::Bits => "compared bit by bit: this program on this kind of processor has written them",
            Agreement::Processor => {
                "compared by claims, within the tolerances of docs/theory/verifying.md: another kind of processor has written them"
            }
            Agreement::Program => {
                "compared by claims, within the tolerances of docs/theory/verifying.md: another program has written them; its tables and \
                 figures were not compared"
            }
        }
    }
}
