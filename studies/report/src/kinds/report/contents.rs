//! The content of a report about its studies, and the mistakes in it.

use super::claims::{Claim, Test};
use super::evaluate::FUNCTIONS;
use super::expression::Expression;
use super::figures::{Chart, Image, Table};
use super::series::Selection;
use super::types::Type;
use super::typing::type_of;
use crate::writers::markdown::images;
use serde_json::{Map, Value as Json};
use std::collections::BTreeMap;
use voussoir_core::plugin::Keys;
use voussoir_study::config::diagnostic::suggest;
use voussoir_study::kind::Part;
use voussoir_study::study::{DiagnosticList, OutputKeys, RecordTable};

/// The table `[report]`.
#[derive(Debug, Clone, Keys)]
pub struct Contents {
    /// heading of the page
    #[key(optional = "the study's name")]
    pub title: Option<String>,
    /// study files, relative to this one
    #[key(len = ">= 1, <= 200")]
    pub studies: Vec<String>,
    /// \[\[report.finer\]\]: studies that are solved again with finer numerical settings. A claim holds only if it holds with all of
    /// them
    #[key(len = "<= 200", default = [])]
    pub finer: Vec<Finer>,
    /// Markdown before each study; one more text is at the end
    #[key(len = "<= 201", default = [])]
    pub text: Vec<String>,
    /// Markdown at the head of the page
    #[key(default = "")]
    pub introduction: String,
    /// results that claims, charts and tables refer to, by name
    #[key(default = {})]
    pub series: BTreeMap<String, Selection>,
    /// \[\[report.claims\]\], in order
    #[key(len = "<= 1000", default = [])]
    pub claims: Vec<Claim>,
    /// \[\[report.charts\]\]
    #[key(len = "<= 1000", default = [])]
    pub charts: Vec<Chart>,
    /// \[\[report.tables\]\]
    #[key(len = "<= 1000", default = [])]
    pub tables: Vec<Table>,
}

impl Contents {
    /// Returns the greatest number of finer settings of one study.
    pub fn finer_levels(&self) -> usize {
        let of = |study: &str| self.finer.iter().filter(|own| own.study == study).count();
        self.finer.iter().map(|own| of(&own.study)).max().unwrap_or(0)
    }

    /// Returns the name of a study with its finer settings of a level; of the last level if it has fewer, its own at level 0.
    pub fn at_level<'a>(&'a self, study: &'a str, level: usize) -> &'a str {
        let own = self.finer.iter().filter(|own| own.study == study).take(level).last();
        own.map_or(study, |own| &own.name)
    }

    /// Adds the mistakes in the content of the report.
    pub fn check(&self, diagnostics: &mut DiagnosticList<'_>, parts: &[Part]) {
        let studies: Vec<&str> = parts.iter().map(|part| part.folder.as_str()).collect();
        let names: Vec<&str> = self.series.keys().map(String::as_str).collect();
        if self.text.len() > self.studies.len() + 1 {
            let message = format!("there are {} texts for {} studies", self.text.len(), self.studies.len());
            diagnostics.wrong("report.text", message, "one before each study, and one more at the end");
        }
        for (name, series) in &self.series {
            let key = format!("report.series.{name}");
            match (&series.study, &series.points) {
                (Some(study), None) if !studies.is_empty() && !studies.contains(&study.as_str()) => {
                    let help = suggest(study, &studies, "studies");
                    diagnostics.wrong(&format!("{key}.study"), format!("there is no study \"{study}\" here"), help);
                }
                (Some(_), None) | (None, Some(_)) => {}
                _ => diagnostics.wrong(&key, "needs either study or points", "name the study whose results are meant"),
            }
            for (own, text) in [("x", &series.x), ("y", &series.y)] {
                let names = Names { known: &["x", "y"], type_of: &|_| Type::Unknown };
                check_expression(diagnostics, &format!("{key}.{own}"), text, &names, Type::Number);
            }
        }
        for (index, claim) in self.claims.iter().enumerate() {
            let key = format!("report.claims.{index}");
            if claim.tests.len() > 1 && claim.depends_on.is_none() {
                let help = "name what the tests differ in: \"the strength\"";
                diagnostics.wrong(&format!("{key}.depends_on"), "is missing: the claim has several tests", help);
            }
            for (place, test) in claim.tests.iter().enumerate() {
                let key = format!("{key}.tests.{place}");
                self.check_test(diagnostics, &key, test, &names);
            }
        }
        let charts =
            self.charts.iter().enumerate().map(|(i, chart)| (format!("report.charts.{i}.series"), &chart.series));
        let tables =
            self.tables.iter().enumerate().map(|(i, table)| (format!("report.tables.{i}.series"), &table.series));
        for (key, list) in charts.chain(tables) {
            for (place, name) in list.iter().enumerate().filter(|(_, name)| !names.contains(&name.as_str())) {
                let help = suggest(name, &names, "series");
                diagnostics.wrong(&format!("{key}.{place}"), format!("there is no series \"{name}\""), help);
            }
        }
        self.check_images(diagnostics, &studies, &names);
    }

    /// Adds the mistakes in a test: `value` may be of any type, `holds` is true or false.
    fn check_test(&self, diagnostics: &mut DiagnosticList<'_>, key: &str, test: &Test, names: &[&str]) {
        let of_series = |name: &str| self.series.get(name).map_or(Type::Unknown, Selection::element_type);
        let series = Names { known: names, type_of: &of_series };
        let found = check_expression(diagnostics, &format!("{key}.value"), &test.value, &series, Type::Unknown);
        let known: Vec<&str> = names.iter().copied().chain(["value"]).collect();
        let with_value = |name: &str| if name == "value" { found } else { of_series(name) };
        let names = Names { known: &known, type_of: &with_value };
        check_expression(diagnostics, &format!("{key}.holds"), &test.holds, &names, Type::Truth);
    }

    fn check_images(&self, diagnostics: &mut DiagnosticList<'_>, studies: &[&str], series: &[&str]) {
        let charts: Vec<&str> = self.charts.iter().map(|chart| chart.name.as_str()).collect();
        let tables: Vec<&str> = self.tables.iter().map(|table| table.name.as_str()).collect();
        let numbered = self.text.iter().enumerate().map(|(i, text)| (format!("report.text.{i}"), text));
        let texts = numbered.chain([("report.introduction".to_string(), &self.introduction)]);
        for (key, text) in texts {
            for place in images(text) {
                let (known, name): (&[&str], String) = match Image::parse(&place) {
                    Some(Image::Chart(name)) => (&charts, name),
                    Some(Image::Table(name)) => (&tables, name),
                    Some(Image::Study(name)) => (studies, name),
                    Some(Image::Case(_, name, _)) => (series, name),
                    None => {
                        let help =
                            "a text shows chart:NAME, table:NAME, study:NAME, and scene:, mechanism: or curve:SERIES@x";
                        diagnostics.wrong(&key, format!("there is nothing to draw at \"{place}\""), help);
                        continue;
                    }
                };
                if !known.contains(&name.as_str()) && !known.is_empty() {
                    diagnostics.wrong(
                        &key,
                        format!("there is no \"{name}\" for {place}"),
                        suggest(&name, known, "names"),
                    );
                }
            }
        }
    }
}

/// The names that an expression may use.
struct Names<'a> {
    known: &'a [&'a str],
    type_of: &'a dyn Fn(&str) -> Type,
}

/// Returns the type of an expression. Reports syntax errors, unknown names, functions with too few or many arguments, and
/// wrong types; the whole expression must be of the type `wanted`.
fn check_expression(
    diagnostics: &mut DiagnosticList<'_>,
    key: &str,
    text: &str,
    names: &Names<'_>,
    wanted: Type,
) -> Type {
    let expression = match Expression::parse(text) {
        Ok(expression) => expression,
        Err(why) => {
            diagnostics.wrong(key, why, "such as abs(argmax(series) - 0.59) < 0.1");
            return Type::Unknown;
        }
    };
    let before = diagnostics.found.len();
    check_names(diagnostics, key, &expression, names.known);
    if diagnostics.found.len() > before {
        return Type::Unknown;
    }
    let mut mistakes = Vec::new();
    let found = type_of(&expression, names.type_of, &mut mistakes);
    if mistakes.is_empty() && !found.may_be(wanted) {
        mistakes.push(format!("must be {}, but is {}", wanted.describe(), found.describe()));
    }
    mistakes.into_iter().for_each(|why| diagnostics.wrong(key, why, "such as abs(argmax(series) - 0.59) < 0.1"));
    found
}

/// Reports names and functions that do not exist.
fn check_names(diagnostics: &mut DiagnosticList<'_>, key: &str, expression: &Expression, names: &[&str]) {
    let functions: Vec<&str> = FUNCTIONS.iter().map(|function| function.name).collect();
    expression.names(&mut |name, arguments| match arguments {
        None if !names.contains(&name) => {
            diagnostics.wrong(key, format!("there is no series \"{name}\""), suggest(name, names, "series"));
        }
        Some(count) => match FUNCTIONS.iter().find(|function| function.name == name) {
            None => diagnostics.wrong(
                key,
                format!("there is no function \"{name}\""),
                suggest(name, &functions, "functions"),
            ),
            Some(function) if function.takes.len() != count => {
                let message = format!("{name} takes {} argument(s), not {count}", function.takes.len());
                diagnostics.wrong(key, message, function.doc);
            }
            Some(_) => {}
        },
        None => {}
    });
}

/// A study that is solved again with finer numerical settings, such as another mesh.
#[derive(Debug, Clone, Keys)]
pub struct Finer {
    /// name of the study
    pub study: String,
    /// its name with these settings, which is also its folder
    pub name: String,
    /// dotted keys in quotes, with the values they take
    pub set: Map<String, Json>,
}

/// The value of `kind` of such a study.
#[derive(Debug, Clone, Copy, Keys)]
pub enum ReportKind {
    /// Studies are run and reported on.
    Report,
}

/// A study file of this kind.
#[derive(Debug, Clone, Keys)]
pub struct ReportFile {
    /// name of the study
    pub name: String,
    /// kind of the study
    pub kind: ReportKind,
    /// head of the report: project, author, checker, date and version
    #[key(optional = "the report has no head")]
    pub record: Option<RecordTable>,
    /// studies, and claims about them
    pub report: Contents,
    /// what is written besides the results
    #[key(default = {})]
    pub output: OutputKeys,
}
