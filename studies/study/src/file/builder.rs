//! Studies made by a program: from text, a file or a value, or step by step.

use crate::file::load;
use crate::study::Study;
use crate::study::StudyError;
use crate::study::StudySource;
use crate::study::beside;
use serde_json::{Map, Value as Json, json};
use std::path::Path;

impl Study {
    /// Reads a study from TOML.
    pub fn from_toml(text: &str) -> Result<Study, StudyError> {
        load(text, "study", &[])
    }

    /// Reads a study file.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Study, StudyError> {
        let path = path.as_ref();
        let read = std::fs::read_to_string(path);
        let text = read.map_err(|error| StudyError::File { path: path.into(), error })?;
        let source = StudySource::parse_with(&text, &path.display().to_string(), &[], &beside(path))?;
        Study::from_source(source)
    }

    /// Reads a study from a value with the tables and keys of a study file.
    pub fn from_value(value: &Json) -> Result<Study, StudyError> {
        Study::from_source(StudySource::of_value(value, &[])?)
    }

    /// Starts a study with this name, to be built step by step.
    pub fn builder(name: &str) -> StudyBuilder {
        StudyBuilder { study: Map::from_iter([("name".to_string(), json!(name))]), sets: Vec::new() }
    }
}

/// A study that is built step by step. Omitted keys have the defaults of study files. Keys and units are the same as in
/// study files: `voussoir explain TAG` lists them. [`build`](Self::build) reports all mistakes at once.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyBuilder {
    study: Map<String, Json>,
    sets: Vec<(String, Json)>,
}

/// Adds its tag to a table. A value that is not a table is unchanged; the check reports it.
fn tagged(key: &str, tag: &str, keys: Json) -> Json {
    match keys {
        Json::Object(keys) => Json::Object([(key.to_string(), json!(tag))].into_iter().chain(keys).collect()),
        other => other,
    }
}

impl StudyBuilder {
    /// Sets the entry `name` of a table of tables.
    fn entry(mut self, table: &str, name: &str, value: Json) -> Self {
        let entries = self.study.entry(table).or_insert_with(|| json!({}));
        entries[name] = value;
        self
    }

    /// Adds an entry to a list.
    fn push(mut self, list: &str, value: Json) -> Self {
        let entries = self.study.entry(list).or_insert_with(|| json!([]));
        entries.as_array_mut().into_iter().for_each(|entries| entries.push(value.clone()));
        self
    }

    /// Sets the scene, by its tag and keys.
    pub fn scene(mut self, tag: &str, keys: Json) -> Self {
        self.study.insert("scene".into(), tagged("scene", tag, keys));
        self
    }

    /// Adds a material: its name in the scene, the tag of its law and the keys of the law.
    pub fn material(self, name: &str, law: &str, keys: Json) -> Self {
        self.entry("materials", name, tagged("law", law, keys))
    }

    /// Adds a law of joints: its name in the scene, its tag and keys.
    pub fn joint(self, name: &str, law: &str, keys: Json) -> Self {
        self.entry("joints", name, tagged("law", law, keys))
    }

    /// Adds a stage: gravity downwards \[m/s²\].
    pub fn gravity(self, acceleration: f64) -> Self {
        self.push("stages", json!({ "name": "dead", "gravity": acceleration }))
    }

    /// Adds a stage: a list of loads, up to a factor.
    pub fn stage(self, name: &str, loads: Json, factor: f64) -> Self {
        self.push("stages", json!({ "name": name, "loads": loads, "factor": factor }))
    }

    /// Adds a stage: a list of loads that grow until collapse.
    pub fn until_collapse(self, name: &str, loads: Json) -> Self {
        self.push("stages", json!({ "name": name, "loads": loads, "until": "collapse" }))
    }

    /// Sets the solver, by its tag and keys.
    pub fn solver(mut self, tag: &str, keys: Json) -> Self {
        self.study.insert("solver".into(), tagged("solver", tag, keys));
        self
    }

    /// Adds an axis of the sweep: a dotted key and its values.
    pub fn sweep(self, key: &str, values: &[f64]) -> Self {
        self.entry("sweep", key, json!({ "list": values }))
    }

    /// Adds a variant that sets dotted keys.
    pub fn variant(self, name: &str, set: Json) -> Self {
        self.push("variants", json!({ "name": name, "set": set }))
    }

    /// Sets any dotted key of the study, such as `stages.live.factor` or `output.curve`. These keys are set last, in order.
    pub fn set(mut self, key: &str, value: impl Into<Json>) -> Self {
        self.sets.push((key.into(), value.into()));
        self
    }

    /// Checks the study. The error contains all mistakes.
    pub fn build(self) -> Result<Study, StudyError> {
        Study::from_source(StudySource::of_value(&Json::Object(self.study), &self.sets)?)
    }
}
