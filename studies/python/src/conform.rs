//! Conformance of plug-ins from Python: registered ones by their tag, and joint laws written in Python.

use crate::law::kept;
use pyo3::prelude::*;
use serde::Deserialize;
use voussoir::conformance::{Options, Report, conform};
use voussoir::core::plugin::{
    Capability, Card, KnownPath, Need, Parameter, PluginKind, Property, Quantity, Range, Sample, Shape, cards,
};

/// A report: tag, kind, text, passed, (check, times), checks that were left out, (check, finding, study).
type Told = (String, String, String, bool, Vec<(String, usize)>, Vec<String>, Vec<(String, String, Option<String>)>);

/// Checks all plug-ins with a tag. The list is empty if no plug-in has this tag.
#[pyfunction]
pub fn conform_tag(py: Python<'_>, tag: &str) -> Vec<Told> {
    let own = cards().iter().filter(|card| card.tag == tag);
    own.map(|card| told(py.detach(|| conform(card, &Options::default())))).collect()
}

/// Checks a joint law written in Python, from its description as JSON.
#[pyfunction]
pub fn conform_law(py: Python<'_>, described: &str) -> PyResult<Told> {
    let wrong = |why: String| pyo3::exceptions::PyValueError::new_err(why);
    let described: Described = serde_json::from_str(described).map_err(|why| wrong(why.to_string()))?;
    let card = described.card().map_err(wrong)?;
    Ok(told(py.detach(|| conform(&card, &Options::default()))))
}

fn told(report: Report) -> Told {
    let text = report.to_string();
    let (passed, tag, kind) = (report.passed(), report.tag, report.kind.describe().to_string());
    let done = report.done.into_iter().map(|(check, times)| (check.to_string(), times)).collect();
    let findings = report.findings.into_iter().map(|own| (own.check.to_string(), own.what, own.study)).collect();
    (tag, kind, text, passed, done, report.left_out, findings)
}

/// The description of a class.
#[derive(Deserialize)]
struct Described {
    /// Tag of the law of this form: `python_facets` or `python_response`.
    form: String,
    /// Keys of the law in TOML.
    table: String,
    /// True if the law gives tractions from gaps.
    responds: bool,
    summary: String,
    size: f64,
    branches: Vec<String>,
    sources: Vec<String>,
    claims: Vec<String>,
    parameters: Vec<Key>,
    known_paths: Vec<Path>,
}

/// An argument of the constructor.
#[derive(Deserialize)]
struct Key {
    name: String,
    unit: String,
    /// True if its value is a list of numbers.
    list: bool,
    /// The default in TOML; `None` if the argument is required.
    default: Option<String>,
    /// True if the default is no value.
    optional: bool,
}

#[derive(Deserialize)]
struct Path {
    source: String,
    steps: Vec<[Vec<f64>; 2]>,
    tolerance: f64,
}

/// Returns a value that lives as long as the program, as all content of a card does.
fn leaked<T>(values: Vec<T>) -> &'static [T] {
    Vec::leak(values)
}

fn texts(words: &[String]) -> &'static [&'static str] {
    leaked(words.iter().map(|word| kept(word.clone())).collect())
}

impl Described {
    /// Returns the card of the class.
    fn card(&self) -> Result<Card, String> {
        let keys = self.parameters.iter().map(Key::parameter).collect::<Result<Vec<_>, _>>()?;
        let class = Parameter { name: "class", doc: "name of the class", shape: Shape::Text, need: Need::Required };
        let arguments = Parameter {
            name: "parameters",
            doc: "arguments of the constructor",
            shape: Shape::Table(leaked(keys)),
            need: Need::Default("{}"),
        };
        let table = kept(self.table.clone());
        let path = |path: &Path| KnownPath {
            table,
            source: kept(path.source.clone()),
            steps: leaked(path.steps.iter().map(|[at, force]| (leaked(at.clone()), leaked(force.clone()))).collect()),
            tolerance: path.tolerance,
        };
        let facets = self.form == "python_facets";
        Ok(Card {
            kind: PluginKind::InterfaceLaw,
            tag: if facets { "python_facets" } else { "python_response" },
            summary: kept(self.summary.clone()),
            page: kept(self.summary.clone()),
            parameters: leaked(if self.parameters.is_empty() { vec![class] } else { vec![class, arguments] }),
            provides: match (facets, self.responds) {
                (true, true) => &[Capability::FACETS, Capability::RESPONSE],
                (true, false) => &[Capability::FACETS],
                _ => &[Capability::RESPONSE],
            },
            claims: leaked(self.claims.iter().map(|claim| Property(kept(claim.clone()))).collect()),
            samples: leaked(vec![Sample::new(table, self.size, texts(&self.branches))]),
            known_paths: leaked(self.known_paths.iter().map(path).collect()),
            sources: texts(&self.sources),
            ..Card::BLANK
        })
    }
}

impl Key {
    fn parameter(&self) -> Result<Parameter, String> {
        let quantity = match self.unit.as_str() {
            "-" => Some(Quantity::Ratio),
            unit => Quantity::ALL.into_iter().find(|own| !unit.is_empty() && own.unit() == unit),
        };
        let unit = || {
            let known: Vec<&str> = Quantity::ALL.iter().map(|own| own.unit()).filter(|unit| !unit.is_empty()).collect();
            format!("units[\"{}\"] = \"{}\" is no unit of a key; units are - {}", self.name, self.unit, known.join(" "))
        };
        let need = match &self.default {
            _ if self.optional => Need::Optional("the class has a default without a value"),
            Some(text) => Need::Default(kept(text.clone())),
            None => Need::Required,
        };
        let number = Shape::Number(quantity.ok_or_else(unit)?, Range::ANY);
        let shape = match self.list {
            true => Shape::List { of: Box::leak(Box::new(number)), min: 0, max: usize::MAX },
            false => number,
        };
        Ok(Parameter { name: kept(self.name.clone()), doc: "an argument of the constructor", shape, need })
    }
}
