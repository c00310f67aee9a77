//! The results of one run, with the entries that are compared. Results of other versions of the program can be read.

use crate::kinds::read_stored_cases;
use serde::Deserialize;
use serde_json::{Map, Value as Json};
use std::io::Read;
use voussoir_study::results::HEAD;

/// Entries of a results.json that are not results, or that follow from the cases.
const NOT_COMPARED: [&str; 8] = ["study", "version", "date", "files", "kind", "only_cases", "comparison", "parts"];

/// The results of one run.
#[derive(Debug, Clone, Default)]
pub struct StoredRun {
    /// Name of the study.
    pub study: String,
    /// Version and commit of the program.
    pub program: String,
    /// The cases.
    pub cases: Vec<StoredCase>,
    /// Other results of the study kind, such as `optima`, by name.
    pub others: Map<String, Json>,
    /// Folders of the studies of a report.
    pub parts: Vec<String>,
    /// The study with all keys; `None` if it is not stored.
    pub resolved: Option<toml::Value>,
}

/// A hinge, a sliding joint or a crushing joint.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
pub(super) struct StoredJoint {
    pub joint: usize,
}

/// A mechanism without its motion.
#[derive(Debug, Clone, Default, PartialEq, Eq, Deserialize)]
#[serde(default)]
pub(super) struct StoredMechanism {
    pub kind: String,
    pub hinges: Vec<StoredJoint>,
    pub sliding: Vec<StoredJoint>,
    pub crushing: Vec<StoredJoint>,
    pub contacts: Vec<StoredContact>,
}

/// A contact in space that moves.
#[derive(Debug, Clone, Default, PartialEq, Eq, Deserialize)]
#[serde(default)]
pub(super) struct StoredContact {
    pub joint: usize,
    pub modes: Vec<String>,
}

/// A limit point of a path.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub(super) struct StoredLimitPoint {
    pub stage: String,
    pub factor: f64,
}

/// The reserve of a load that is carried.
#[derive(Debug, Clone, Copy, Default, PartialEq, Deserialize)]
pub(super) struct StoredReserve {
    pub factor: Option<f64>,
}

/// The verdict of a certificate.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Deserialize)]
pub(super) struct StoredCertificate {
    pub passed: bool,
}

/// The entries of a case that are compared.
#[derive(Debug, Clone, Default, PartialEq, Deserialize)]
#[serde(default)]
pub struct StoredCase {
    /// Index in its study.
    pub id: usize,
    /// Name of the variant.
    pub variant: Option<String>,
    /// Name of the scene, if the study compares several.
    pub scene: Option<String>,
    /// Swept key → value.
    pub parameters: Map<String, Json>,
    /// Its status, as in results.json.
    pub status: String,
    pub(super) load_factor: Option<f64>,
    pub(super) bounds: Option<[Option<f64>; 2]>,
    pub(super) first_limit_point: Option<f64>,
    pub(super) reserve: Option<StoredReserve>,
    pub(super) mechanism: Option<StoredMechanism>,
    pub(super) limit_points: Vec<StoredLimitPoint>,
    pub(super) certificate: Option<StoredCertificate>,
    /// Names of the columns of a driven point.
    pub(super) columns: Vec<String>,
    /// Rows of a driven point.
    pub(super) rows: Vec<Vec<Option<f64>>>,
}

/// A case must have an id and a status.
fn case_of(json: Json) -> Result<StoredCase, String> {
    if !json["id"].is_u64() || !json["status"].is_string() || !json["parameters"].is_object() {
        return Err("an entry of \"cases\" has no id, no status or no parameters".into());
    }
    serde_json::from_value(json).map_err(|error| format!("an entry of \"cases\": {error}"))
}

impl StoredRun {
    /// Reads a results.json and the resolved study beside it.
    ///
    /// # Errors
    /// The reason why one of them cannot be read.
    pub fn read(results: impl Read, resolved: Option<&str>) -> Result<Self, String> {
        let (mut cases, mut wrong) = (Vec::new(), None);
        let mut head = read_stored_cases(results, &mut |_, json| match case_of(json) {
            Ok(case) => cases.push(case),
            Err(why) => drop(wrong.get_or_insert(why)),
        })?;
        if let Some(why) = wrong {
            return Err(why);
        }
        let text = |key: &str| head.get(key).and_then(Json::as_str).unwrap_or("unknown").to_string();
        let (study, program) = (text("study"), format!("{} (commit {})", text("version"), text("commit")));
        let parts = head.get("parts").and_then(Json::as_array).into_iter().flatten();
        let parts = parts.filter_map(|part| Some(part["study"].as_str()?.to_string())).collect();
        head.retain(|key, _| !NOT_COMPARED.contains(&key.as_str()) && !HEAD.contains(&key.as_str()));
        let resolved = resolved.map(|text| toml::from_str(text).map_err(|error| format!("resolved.toml: {error}")));
        Ok(StoredRun { study, program, cases, others: head, parts, resolved: resolved.transpose()? })
    }
}
