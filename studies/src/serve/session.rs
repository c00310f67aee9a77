//! A session of `voussoir serve`: one case of a study, with the numbers that the page has changed.

use super::runs::{Run, Runs, Stop};
use super::{answer, controls, critical, page, swap};
use serde::Deserialize;
use serde_json::{Value as Json, json};
use voussoir_report::output::StudyOutput;
use voussoir_report::writers::report::report_html;
use voussoir_study::cases::{Observer, solve_unless_cancelled};
use voussoir_study::config::diagnostic::LocatedDiagnostic;
use voussoir_study::config::document::{Node, Value, from_json};
use voussoir_study::config::origin::Origin;
use voussoir_study::config::overlay::set;
use voussoir_study::file::StudyFile;
use voussoir_study::results::Totals;
use voussoir_study::study::{Case, Study, StudyError, StudySource, value_of};

/// A study with a scene whose cases are shown in the browser.
#[derive(Debug)]
pub struct Session {
    study: Study,
    runs: Runs,
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
    /// Tables with another law or solver: dotted key and tag.
    #[serde(default)]
    pub swap: Vec<(String, String)>,
    /// The load whose most onerous position is searched for: the dotted key that moves it.
    #[serde(default)]
    pub follow: Option<String>,
    /// True if the answer must contain the controls of the page.
    #[serde(default)]
    pub controls: bool,
    /// Name of the page, which distinguishes several pages of one session. A new request of a page ends its earlier one.
    #[serde(default)]
    pub page: String,
}

/// The study of a request.
struct Posed {
    /// The study file, with one case.
    root: Node,
    study: Study,
    /// The keys whose values come from samples of laws.
    sampled: Vec<String>,
}

/// Greatest number of cases that are drawn in a report.
const DRAWN: usize = 40;
/// Greatest number of cases with labels in a list.
const LISTED: usize = 500;

impl Session {
    /// Reads a study. The error contains all mistakes in its first case and its axes.
    pub fn read(source: StudySource) -> Result<Self, StudyError> {
        Ok(Session { study: StudyFile::read(source)?.study_unchecked()?, runs: Runs::default() })
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

    /// Returns the study file of a request, with one case, and the keys whose values come from samples of laws.
    fn root(&self, asked: &Asked) -> Result<(Node, Vec<String>), Vec<LocatedDiagnostic>> {
        let mut root = self.study.root(asked.case)?;
        let run = Node { value: Value::String("run".into()), origin: root.place("kind") };
        set(&mut root, "kind", run, &Origin::Value).map_err(|wrong| vec![*wrong])?;
        let case = self.study.case(asked.case).filter(|_| !asked.swap.is_empty());
        let mut swapped = Vec::new();
        for (table, tag) in &asked.swap {
            let Some(case) = &case else { break };
            swapped.push(swap::swap(&mut root, case, table, tag)?);
        }
        let mut wrong = Vec::new();
        for (key, value) in asked.set.iter().filter(|(key, _)| !swapped.iter().any(|table| table.drops(key))) {
            let origin = Origin::Set(key.as_str().into());
            let node = match value {
                Json::String(text) => value_of(text, &origin),
                other => from_json(other)?,
            };
            wrong.extend(set(&mut root, key, placed(node, &origin), &origin).err().map(|wrong| *wrong));
        }
        let given = |key: &String| asked.set.iter().any(|(set, _)| set == key);
        let sampled = swapped.into_iter().flat_map(|table| table.sampled).filter(|key| !given(key)).collect();
        if wrong.is_empty() { Ok((root, sampled)) } else { Err(wrong) }
    }

    fn posed(&self, asked: &Asked) -> Result<Posed, StudyError> {
        if asked.case >= self.count() {
            let message = format!("the study \"{}\" has cases 0 to {}", self.name(), self.count().saturating_sub(1));
            return Err(vec![LocatedDiagnostic::new(&Origin::Value, "case", message)].into());
        }
        let (root, sampled) = self.root(asked)?;
        let source = StudySource { root: root.clone(), sets: Vec::new(), diagnostics: Vec::new() };
        Ok(Posed { root, study: Study::from_source(source)?, sampled })
    }

    /// Returns the result in the form that the script of the page draws. `mistakes` contains the diagnostics as text if the
    /// input is wrong; `stopped` is the reason if there is no result.
    pub fn answer(&self, asked: &Asked) -> Json {
        let run = self.runs.start(&asked.page);
        let mut answer = self.solved(asked, &run);
        self.runs.end(&asked.page, &run);
        if asked.controls && answer.get("controls").is_none() {
            // The law that was chosen may be wrong for this case: the reader must be able to choose another.
            let Ok(posed) = self.posed(&Asked { swap: Vec::new(), set: Vec::new(), ..asked.clone() }) else {
                return answer;
            };
            let case = posed.study.cases.first();
            answer["controls"] = case.map(|case| self.controls(case, asked)).into();
        }
        answer
    }

    fn solved(&self, asked: &Asked, run: &Run) -> Json {
        let posed = match self.posed(asked) {
            Ok(posed) => posed,
            Err(wrong) => return json!({ "mistakes": wrong.to_string() }),
        };
        let Some(case) = posed.study.cases.first() else { return json!({ "mistakes": "the study has no case" }) };
        let mut answer = match &asked.follow {
            Some(key) => match critical::most_onerous(&posed.root, key, &self.own_envelope(asked), run) {
                Ok(Some(found)) => found,
                Ok(None) => stopped(run),
                Err(wrong) => return json!({ "mistakes": wrong.to_string() }),
            },
            None => match solve_unless_cancelled(case, run) {
                Some(result) => answer::answer(case, &result, &posed.root),
                None => stopped(run),
            },
        };
        if answer.get("toml").is_none() {
            answer["toml"] = answer::toml_of(&posed.root).into();
        }
        if !posed.sampled.is_empty() {
            let words = format!("example values, which you must check: {}", posed.sampled.join(", "));
            answer["sampled"] = words.into();
        }
        if asked.controls {
            answer["controls"] = self.controls(case, asked).into();
        }
        answer
    }

    /// Returns the `[envelope]` of the study as it is for a case, if the study is an envelope.
    fn own_envelope(&self, asked: &Asked) -> Option<Node> {
        let root = self.study.root(asked.case).ok().filter(|_| self.kind() == "envelope")?;
        root.table()?.get("envelope").cloned()
    }

    /// Returns the controls of a case as HTML.
    fn controls(&self, case: &Case, asked: &Asked) -> String {
        let resolved = case.resolved.to_json();
        let movable = critical::movable(case, self.own_envelope(asked).as_ref());
        controls::controls(&resolved, &movable).into_string()
    }

    /// Returns the progress of the request of a page, or null; with `stop`, the request ends.
    pub fn progress(&self, page: &str, stop: bool) -> Json {
        self.runs.progress(page, stop)
    }

    /// Returns the report of a request, as `run` writes it; an error is a text for the reader.
    pub fn report(&self, asked: &Asked, observer: &dyn Observer) -> Result<String, String> {
        let Posed { study, .. } = self.posed(asked).map_err(|wrong| wrong.to_string())?;
        let result = study.cases.first().and_then(|case| solve_unless_cancelled(case, observer));
        let result = result.ok_or("this takes too long here: copy the study file and give it to voussoir run")?;
        let results = study.results(env!("CARGO_PKG_VERSION"), vec![result]);
        let totals = Totals::of(&results.cases);
        let cases: Vec<_> = results.cases.iter().filter_map(|case| study.case_of(&case.label)).collect();
        Ok(report_html(&StudyOutput::new(&study, &results, &totals, &cases), DRAWN))
    }

    /// Returns the page of a case, with sliders at the values of the study file.
    pub fn page(&self, case: usize) -> Result<String, String> {
        let asked = Asked { case, ..Asked::default() };
        let posed = self.posed(&asked).map_err(|wrong| wrong.to_string())?;
        let first = posed.study.cases.first().ok_or("the study has no case")?;
        Ok(page::page(&page::Shown {
            name: self.name(),
            kind: self.kind(),
            case,
            count: self.count(),
            labels: self.labels(),
            controls: self.controls(first, &asked),
        }))
    }
}

/// The answer without a result.
fn stopped(run: &Run) -> Json {
    let words = match run.stop() {
        Some(Stop::Superseded) => "replaced by a newer request",
        Some(Stop::Unseen) => "stopped, because the page did not ask for progress",
        _ => "stopped; copy the study file and give it to voussoir run to follow it to its end",
    };
    json!({ "stopped": words })
}

/// Sets the origin of a value and of all its parts.
fn placed(mut node: Node, origin: &Origin) -> Node {
    node.set_origin(origin);
    node
}
