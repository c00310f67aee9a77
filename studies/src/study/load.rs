//! From the text of a study file to a [`Study`]. The error contains all mistakes of the file.

use super::case::{build_case, shared_key};
use super::error::StudyError;
use super::file::StudyFile;
use super::model::{Case, Study};
use super::source::StudySource;
use crate::config::document::{Node, Value};
use crate::config::dotted_key::segments;
use crate::config::expand::Expanded;
use crate::config::origin::Origin;
use crate::config::overlay::set;
use crate::results::CaseLabel;
use serde_json::Value as Json;
use std::borrow::Cow;

/// Reads a study. `file` is its name in messages, `sets` the `--set KEY=VALUE` of the command line; a value that is not
/// valid TOML is a text.
pub fn load(text: &str, file: &str, sets: &[(String, String)]) -> Result<Study, StudyError> {
    Study::from_source(StudySource::parse(text, file, sets)?)
}

impl Study {
    /// Returns the study of a source.
    pub fn from_source(source: StudySource) -> Result<Study, StudyError> {
        StudyFile::read(source)?.study()
    }

    /// Like [`Study::from_source`], but keeps no cases of a study with more than [`super::HELD`] cases.
    pub fn from_source_in_turn(source: StudySource) -> Result<Study, StudyError> {
        StudyFile::read(source)?.study_in_turn()
    }

    /// Returns the number of cases.
    pub fn count(&self) -> usize {
        self.expansion.count()
    }

    /// Returns a case, which is made now if it is not in memory; `None` beyond the last.
    pub fn case(&self, id: usize) -> Option<Cow<'_, Case>> {
        if let Some(case) = self.cases.get(id) {
            return Some(Cow::Borrowed(case));
        }
        let expanded = (id < self.count()).then(|| self.expansion.case(id).ok())??;
        build_case(id, expanded, &|name| shared_key(&self.checked, &self.expansion, name)).ok().map(Cow::Owned)
    }

    /// Returns variant, scene and swept values of a case, without its hash; `None` beyond the last.
    pub fn label(&self, id: usize) -> Option<CaseLabel> {
        let Expanded { variant, scene, parameters, .. } =
            (id < self.count()).then(|| self.expansion.case(id).ok())??;
        Some(CaseLabel { id, case_hash: String::new(), variant, scene, parameters })
    }

    /// Returns the values of a swept key in the order of its axis.
    pub fn values(&self, key: &str) -> Vec<Json> {
        self.expansion.values(key)
    }

    /// Returns the swept keys, outermost first.
    pub fn keys(&self) -> Vec<String> {
        self.expansion.swept().map(String::from).collect()
    }

    /// Returns case `id` with other values of some keys, numbers or texts, for study kinds that choose values themselves. Its
    /// `id` and `parameters` are those in the case, with the changed keys.
    pub fn at(&self, id: usize, values: &[(String, Json)]) -> Result<Case, StudyError> {
        let mut expanded = self.expansion.case(id)?;
        for (key, value) in values {
            let origin = Origin::Set(key.as_str().into());
            let written = match value {
                Json::String(text) => Value::String(text.clone()),
                number => Value::Float(number.as_f64().unwrap_or(f64::NAN)),
            };
            let node = Node { value: written, origin: origin.clone() };
            set(&mut expanded.root, key, node, &origin).map_err(|wrong| vec![*wrong])?;
            expanded.parameters.insert(key.clone(), value.clone());
        }
        let other = |name: &str| values.iter().any(|(key, _)| segments(key).first().is_some_and(|first| first == name));
        let known = |name: &str| if other(name) { None } else { shared_key(&self.checked, &self.expansion, name) };
        Ok(build_case(id, expanded, &known)?)
    }
}
