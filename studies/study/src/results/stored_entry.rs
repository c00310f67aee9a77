//! The entries of results.json that every kind of study has, read without the rest.

use super::origin::Origin;
use serde::Deserialize;
use serde::de::IgnoredAny;
use serde_json::{Map, Value as Json};

/// The head of results.json, and the heads of its cases.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub struct StoredOutline {
    /// Version of the program.
    pub version: String,
    /// The origin of the results.
    #[serde(flatten)]
    pub origin: Origin,
    /// The day of the run.
    pub date: Option<String>,
    /// Ids of the cases, if the run was limited to some cases.
    pub only_cases: Option<Vec<usize>>,
    /// Cases or driven points, in order.
    pub cases: Vec<StoredEntry>,
}

impl StoredOutline {
    /// Returns the ids of the cases.
    pub fn ids(&self) -> Vec<usize> {
        self.cases.iter().filter_map(|case| case.id).collect()
    }
}

/// The head of an entry: of a case, a driven point, a position of an envelope or an optimum.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(default)]
pub struct StoredEntry {
    /// Id of the case or of the driven point.
    pub id: Option<usize>,
    /// Id of the case of a position or an optimum.
    pub case: Option<usize>,
    /// Name of the variant.
    pub variant: Option<String>,
    /// Swept key → value.
    pub parameters: Map<String, Json>,
    /// The word of its status.
    pub status: Option<String>,
    /// The value of a position or an optimum.
    pub value: Option<f64>,
    /// Wall time \[s\].
    pub seconds: Option<f64>,
    certificate: Option<Passed>,
    mechanism: Option<IgnoredAny>,
}

#[derive(Debug, Clone, Deserialize)]
struct Passed {
    passed: bool,
}

impl StoredEntry {
    /// Reads the head of an entry; empty if it is no entry.
    pub fn of(entry: &Json) -> Self {
        StoredEntry::deserialize(entry).unwrap_or_default()
    }

    /// Returns the word of its status; empty without one.
    pub fn status(&self) -> &str {
        self.status.as_deref().unwrap_or_default()
    }

    /// Returns true if the certificate of the case has passed.
    pub fn certified(&self) -> bool {
        self.certificate.as_ref().is_some_and(|certificate| certificate.passed)
    }

    /// Returns true if it has a mechanism.
    pub fn has_mechanism(&self) -> bool {
        self.mechanism.is_some()
    }
}
