//! The results of a study, as they stand in `results.json`.

use super::case_result::CaseResult;
use super::comparison::Comparison;
use super::origin::Origin;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json};

/// All results of a study.
#[derive(Debug, Clone, Default, Serialize, Deserialize)]
pub struct StudyResults {
    /// Name of the study.
    pub study: String,
    /// Version of the program.
    pub version: String,
    /// The origin of the results.
    #[serde(flatten)]
    pub origin: Origin,
    /// The day of the run.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub date: Option<String>,
    /// Ids of the cases, where the run was asked for some of them only.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub only_cases: Option<Vec<usize>>,
    /// Names of the files that the run wrote beside results.json and resolved.toml, sorted.
    #[serde(default)]
    pub files: Vec<String>,
    /// One entry per case, by `id`.
    pub cases: Vec<CaseResult>,
    /// Of `kind = "compare"` and `"map"`: the cases beside each other.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub comparison: Option<Comparison>,
    /// What other study kinds add, by name.
    #[serde(flatten)]
    pub own: Map<String, Json>,
}

impl StudyResults {
    /// The result of a case by its id; `None` where it was not asked for, or not answered before the run was cancelled.
    pub fn case(&self, id: usize) -> Option<&CaseResult> {
        self.cases.iter().find(|case| case.label.id == id)
    }

    /// Whether every case that is here is answered and its certificate passed.
    pub fn certified(&self) -> bool {
        self.cases.iter().all(|case| case.certificate.passed)
    }
}
