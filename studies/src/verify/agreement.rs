//! The comparison of results with a second run: bit by bit if both come from the same program and the same kind of processor,
//! by their claims otherwise.

use super::{meaning, repeat, texts};
use crate::results::{Origin, words};
use serde::Serialize;
use serde_json::{Map, Value as Json};

/// The way in which two runs are compared.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Agreement {
    /// Every number and word must be the same.
    Bits,
    /// The same program on another kind of processor: claims must be the same, numbers within the tolerances of
    /// [`super::tolerances`].
    Processor,
    /// Another program: the same, and its tables and figures are not compared.
    #[default]
    Program,
}

impl Agreement {
    /// The comparison of results of this origin, of a study that is given as resolved.toml, with this program.
    pub fn of(stored: &Origin, study: &toml::Value) -> Agreement {
        let here = Origin::here(&words(study));
        match (stored.agrees(&here), stored.program() == here.program()) {
            (true, _) => Agreement::Bits,
            (false, true) => Agreement::Processor,
            (false, false) => Agreement::Program,
        }
    }

    /// The comparison of a results.json whose entries beside the cases are given.
    pub fn of_head(head: &Map<String, Json>, study: &toml::Value) -> Agreement {
        let origin = serde_json::from_value(Json::Object(head.clone()));
        Agreement::of(&origin.unwrap_or_default(), study)
    }

    /// The differences between a stored value and the value of a second run, in words.
    pub fn differences(self, stored: &Json, again: &Json) -> Vec<String> {
        match self {
            Agreement::Bits => repeat::differences(stored, again),
            Agreement::Processor | Agreement::Program => meaning::differences(stored, again),
        }
    }

    /// Returns true if two values that are no cases are the same.
    pub fn same<T: Serialize>(self, stored: &T, again: &T) -> bool {
        match (serde_json::to_value(stored), serde_json::to_value(again)) {
            (Ok(stored), Ok(again)) if self == Agreement::Bits => repeat::differences(&stored, &again).is_empty(),
            (Ok(stored), Ok(again)) => meaning::same(&stored, &again),
            _ => false,
        }
    }

    /// Returns true if two files are the same.
    pub fn same_file(self, stored: &[u8], made: &[u8]) -> bool {
        match self {
            Agreement::Bits => stored == made,
            Agreement::Processor => texts::same_but_rounding(stored, made),
            Agreement::Program => true,
        }
    }

    /// The comparison in words.
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
