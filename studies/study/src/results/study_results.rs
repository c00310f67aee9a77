//! The results of a study, as stored in `results.json`.

use super::case_result::CaseResult;
use super::comparison::Comparison;
use super::kind_entries::KindEntries;
use super::origin::Origin;
use serde::{Deserialize, Serialize};

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
    /// Ids of the cases, if the run was limited to some cases.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub only_cases: Option<Vec<usize>>,
    /// Names of the files that the run wrote beside results.json and resolved.toml, sorted.
    #[serde(default)]
    pub files: Vec<String>,
    /// One entry per case, by `id`.
    pub cases: Vec<CaseResult>,
    /// For `kind = "compare"` and `"map"`: the comparison of the cases.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub comparison: Option<Comparison>,
    /// Additional results of study kinds.
    #[serde(flatten)]
    pub own: KindEntries,
}

impl StudyResults {
    /// Returns the result of a case by its id; `None` if it was not requested, or not solved before the run was
    /// cancelled.
    pub fn case(&self, id: usize) -> Option<&CaseResult> {
        self.cases.iter().find(|case| case.label.id == id)
    }

    /// Returns true if every stored case is solved and its certificate passed.
    pub fn certified(&self) -> bool {
        self.cases.iter().all(|case| case.certificate.passed)
    }
}
