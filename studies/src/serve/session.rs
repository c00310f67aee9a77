//! A session of `voussoir serve`: one case of a study, with the numbers that the page has changed.

use super::{answer, page};
use crate::config::diagnostic::LocatedDiagnostic;
use crate::config::document::{Node, Value, from_json};
use crate::config::origin::Origin;
use crate::config::overlay::set;
use crate::results::Totals;
use crate::solve::{Observer, solve_unless_cancelled};
use crate::study::{Study, StudyError, StudyFile, StudySource, value_of};
use crate::writers::StudyOutput;
use crate::writers::report::report_html;
use serde::Deserialize;
use serde_json::{Value as Json, json};

/// A study with a scene whose cases are shown in the browser.
#[derive(Debug)]
pub struct Session {
    study: Study,
}

/// A request of the page.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Asked {
    /// Id of the case.
    pub case: usize,
    /// Dotted keys with their new values: numbers in SI units, or texts such as `"25 MPa"`.
    #[serde(default)]
    pub set: Vec<(String, Json)>,
}

/// Greatest number of cases that are drawn in a report.
const DRAWN: usize = 40;
/// Greatest number of cases with labels in a list.
const LISTED: usize = 500;

impl Session {
    /// Reads a study. The error contains all mistakes in its first case and its axes.
    pub fn read(source: StudySource) -> Result<Self, StudyError> {
        Ok(Session { study: StudyFile::read(source)?.study_unchecked()? })
    }

    /// Returns the name of the study.
    pub fn name(&self) -> &str {
        &self.study.name
    }

    /// Returns the purpose of the study's kind; here each case is shown separately.
    pub fn kind(&self) -> &str {
        &self.study.kind
    }

    /// Returns the number of cases.
    pub fn count(&self) -> usize {
        self.study.count()
    }

    /// Returns variant, scene and swept values of each case; `None` if there are too many for a list.
    pub fn labels(&self) -> Option<Vec<String>> {
        let keys = self.study.swept_keys();
        let label = |id: usize| {
            let case = self.study.label(id)?;
            let swept = Some(keys.text(&case.parameters)).filter(|text| !text.is_empty());
            let words: Vec<String> = case.variant.into_iter().chain(case.scene).chain(swept).collect();
            Some(if words.is_empty() { format!("case {id}") } else { words.join(", ") })
        };
        (self.count() <= LISTED).then(|| (0..self.count()).map(|id| label(id).unwrap_or_default()).collect())
    }

    /// Returns the study file of a request, with one case.
    fn root(&self, asked: &Asked) -> Result<Node, Vec<LocatedDiagnostic>> {
        let mut root = self.study.expansion.case(asked.case)?.root;
        let run = Node { value: Value::String("run".into()), origin: root.place("kind") };
        set(&mut root, "kind", run, &Origin::Value).map_err(|wrong| vec![*wrong])?;
        let mut wrong = Vec::new();
        for (key, value) in &asked.set {
            let origin = Origin::Set(key.as_str().into());
            let node = match value {
                Json::String(text) => value_of(text, &origin),
                other => from_json(other)?,
            };
            wrong.extend(set(&mut root, key, placed(node, &origin), &origin).err().map(|wrong| *wrong));
        }
        if wrong.is_empty() { Ok(root) } else { Err(wrong) }
    }

    fn study(&self, asked: &Asked) -> Result<(Node, Study), StudyError> {
        if asked.case >= self.count() {
            let message = format!("the study \"{}\" has cases 0 to {}", self.name(), self.count().saturating_sub(1));
            return Err(vec![LocatedDiagnostic::new(&Origin::Value, "case", message)].into());
        }
        let root = self.root(asked)?;
        let source = StudySource { root: root.clone(), sets: Vec::new(), diagnostics: Vec::new() };
        Ok((root, Study::from_source(source)?))
    }

    /// Returns the result in the form that the script of the page draws. `mistakes` contains the diagnostics as text if the
    /// input is wrong; `slow` is set if the observer has cancelled.
    pub fn answer(&self, asked: &Asked, observer: &dyn Observer) -> Json {
        let (root, study) = match self.study(asked) {
            Ok(study) => study,
            Err(wrong) => return json!({ "mistakes": wrong.to_string() }),
        };
        let Some(case) = study.cases.first() else { return json!({ "mistakes": "the study has no case" }) };
        let toml = toml::to_string(&root.to_toml()).unwrap_or_default();
        match solve_unless_cancelled(case, observer) {
            Some(result) => answer::answer(case, &result, &root, toml),
            None => json!({
                "slow": "this takes too long to follow a slider: copy the study file and give it to voussoir run",
                "toml": toml,
            }),
        }
    }

    /// Returns the report of a request, as `run` writes it; an error is a text for the reader.
    pub fn report(&self, asked: &Asked, observer: &dyn Observer) -> Result<String, String> {
        let (_, study) = self.study(asked).map_err(|wrong| wrong.to_string())?;
        let result = study.cases.first().and_then(|case| solve_unless_cancelled(case, observer));
        let result = result.ok_or("this takes too long here: copy the study file and give it to voussoir run")?;
        let results = study.results(env!("CARGO_PKG_VERSION"), vec![result]);
        let totals = Totals::of(&results.cases);
        let cases: Vec<_> = results.cases.iter().filter_map(|case| study.case_of(&case.label)).collect();
        Ok(report_html(&StudyOutput::new(&study, &results, &totals, &cases), DRAWN))
    }

    /// Returns the page of a case, with sliders at the values of the study file.
    pub fn page(&self, case: usize) -> Result<String, String> {
        let (_, study) = self.study(&Asked { case, set: Vec::new() }).map_err(|wrong| wrong.to_string())?;
        let first = study.cases.first().ok_or("the study has no case")?;
        Ok(page::page(&page::Shown {
            name: self.name(),
            kind: self.kind(),
            case,
            count: self.count(),
            labels: self.labels(),
            resolved: &first.resolved.to_json(),
        }))
    }
}

/// Sets the origin of a value and of all its parts.
fn placed(mut node: Node, origin: &Origin) -> Node {
    node.set_origin(origin);
    node
}
