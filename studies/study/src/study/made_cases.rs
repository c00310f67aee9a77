//! The cases of a study, which are made when they are needed.

use super::case::{build_case, shared_key};
use super::error::StudyError;
use super::keys::{study_keys, tables_apart};
use super::model::{Case, Study};
use super::source::StudySource;
use crate::config::diagnostic::LocatedDiagnostic;
use crate::config::document::{Node, Value};
use crate::config::dotted_key::segments;
use crate::config::expand::{Expanded, Expansion};
use crate::config::origin::Origin;
use crate::config::overlay::set;
use crate::results::CaseLabel;
use serde_json::Value as Json;
use std::borrow::Cow;

impl Study {
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

    /// Returns the study file of a case as a tree of keys.
    pub fn root(&self, id: usize) -> Result<Node, Vec<LocatedDiagnostic>> {
        Ok(self.expansion.case(id)?.root)
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

impl Case {
    /// Returns the only case of a source without axes.
    pub fn from_source(source: StudySource) -> Result<Case, StudyError> {
        if !source.diagnostics.is_empty() {
            return Err(source.diagnostics.into());
        }
        let expansion = Expansion::new(&source.root, tables_apart(), study_keys())?;
        Ok(build_case(0, expansion.case(0)?, &|_| None)?)
    }
}
