//! From the text of a study file to a [`Study`]: every mistake of the whole file at once.

use super::case::build_case;
use super::diagnostics::located;
use super::keys::{VARIANT, kind_tables, study_keys};
use super::model::{Case, Drawn, Output, Study};
use super::outline::Outline;
use super::source::{FILE_NAME, StudySource, kind_of, no_file_name};
use crate::config::check::Checker;
use crate::config::diagnostic::{LocatedDiagnostic, sort};
use crate::config::document::{Node, Value};
use crate::config::expand::{Expanded, Expansion};
use crate::config::origin::Origin;
use crate::config::overlay::set;
use crate::kinds::kind;
use serde_json::{Map, Value as Json};
use std::collections::HashMap;
use voussoir_core::plugin::{Parameter, Shape};

/// Greatest number of different mistakes reported.
const MAX_MISTAKES: usize = 100;

/// Reads a study. `file` is its name in messages, `sets` the `--set KEY=VALUE` of the command line;
/// a value that is no TOML is taken as text.
pub fn load(text: &str, file: &str, sets: &[(String, String)]) -> Result<Study, Vec<LocatedDiagnostic>> {
    Study::from_source(StudySource::parse(text, file, sets)?)
}

impl Study {
    /// The study that a source describes.
    pub fn from_source(source: StudySource) -> Result<Study, Vec<LocatedDiagnostic>> {
        let StudySource { root, sets, mut diagnostics } = source;
        if kind(kind_of(&root)).is_some_and(|kind| kind.file_keys().is_some()) {
            let message = format!("\"{}\" has no scene to solve", kind_of(&root));
            let wrong = LocatedDiagnostic::new(&root.place("kind"), "kind", message);
            diagnostics.push(wrong.help("run it by `voussoir run STUDY.toml`"));
            return Err(diagnostics);
        }
        check_variants(&root, &mut diagnostics);
        let table = kind_table(&root, &mut diagnostics);
        let expansion = match Expansion::new(&root, &kind_tables()) {
            Ok(expansion) => expansion,
            Err(wrong) => {
                diagnostics.extend(wrong);
                sort(&mut diagnostics);
                return Err(diagnostics);
            }
        };
        check_sets(&sets, &expansion, &mut diagnostics);
        let outline =
            Outline { variants: expansion.variants(), scenes: expansion.scenes(), axes: expansion.axes(), table };
        check_outline(&root, &outline, &mut diagnostics);
        let cases = build_cases(&expansion, &mut diagnostics);
        if !diagnostics.is_empty() {
            sort(&mut diagnostics);
            return Err(diagnostics);
        }
        let first = cases.first().map(|case| &case.resolved);
        // A sweep or a variant may have changed it.
        if let Some(why) = first.and_then(|case| case["name"].as_str()).and_then(no_file_name) {
            return Err(vec![LocatedDiagnostic::new(&root.place("name"), "name", why).help(FILE_NAME)]);
        }
        let text_of = |name: &str| first.and_then(|case| case[name].as_str()).unwrap_or_default().to_string();
        Ok(Study {
            name: text_of("name"),
            kind: text_of("kind"),
            outline,
            output: first.map(|case| output(&case["output"], expansion.count())).unwrap_or_default(),
            cases,
            resolved: root.to_toml(),
            expansion,
        })
    }

    /// Case `id` with other values of some keys, numbers or texts, as a study kind needs it that chooses values itself. Its `id`
    /// and `parameters` are those of the case, with the keys that are set.
    pub fn at(&self, id: usize, values: &[(String, Json)]) -> Result<Case, Vec<LocatedDiagnostic>> {
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
        build_case(id, expanded)
    }
}

/// What is written besides the results, from the checked table `[output]`.
fn output(table: &Json, cases: usize) -> Output {
    let flag = |name: &str| table[name].as_bool().unwrap_or(false);
    let tags = |list: &Vec<Json>| list.iter().filter_map(|tag| tag.as_str().map(str::to_string)).collect();
    Output {
        curve: flag("curve"),
        figures: Drawn::read(&table["figures"], cases),
        vtu: flag("vtu"),
        writers: table["writers"].as_array().map(tags),
        options: table["options"].as_object().cloned().unwrap_or_default(),
    }
}

/// All cases; a mistake that several cases have stands once, with the first of them where not all have it.
fn build_cases(expansion: &Expansion, diagnostics: &mut Vec<LocatedDiagnostic>) -> Vec<Case> {
    let count = expansion.count();
    let mut times: HashMap<LocatedDiagnostic, usize> = HashMap::new();
    let mut order: Vec<(LocatedDiagnostic, String)> = Vec::new();
    let mut cases = Vec::new();
    for id in 0..count {
        let (result, label) = match expansion.case(id) {
            Ok(expanded) => {
                let label = describe_case(&expanded);
                (build_case(id, expanded), label)
            }
            Err(wrong) => (Err(wrong), String::new()),
        };
        match result {
            Ok(case) => cases.push(case),
            Err(wrong) => {
                for diagnostic in wrong {
                    let times = times.entry(diagnostic.clone()).or_insert(0);
                    if *times == 0 {
                        order.push((diagnostic, label.clone()));
                    }
                    *times += 1;
                }
            }
        }
        if order.len() > MAX_MISTAKES {
            break;
        }
    }
    diagnostics.extend(order.into_iter().map(|(mut diagnostic, label)| {
        if times[&diagnostic] < count && !label.is_empty() {
            diagnostic.case = Some(label);
        }
        diagnostic
    }));
    cases
}

fn check_variants(root: &Node, diagnostics: &mut Vec<LocatedDiagnostic>) {
    let Some(variants) = root.table().and_then(|table| table.get("variants")) else {
        return;
    };
    let mut checker = Checker::new(root);
    checker.check(variants, &Shape::List { of: &VARIANT, min: 0, max: usize::MAX }, "variants");
    diagnostics.append(&mut checker.diagnostics);
}

/// A swept key that is set on the command line besides.
fn check_sets(sets: &[(String, String)], expansion: &Expansion, diagnostics: &mut Vec<LocatedDiagnostic>) {
    for (path, _) in sets.iter().filter(|(path, _)| expansion.swept().any(|swept| swept == path)) {
        let message = "is swept, so setting it has no effect";
        let help = format!("change the axis instead: --set 'sweep.\"{path}\".list=[…]'");
        diagnostics.push(LocatedDiagnostic::new(&Origin::Set(path.as_str().into()), path, message).help(help));
    }
}

/// The table of the study's kind, checked; a table of another kind is a mistake.
fn kind_table(root: &Node, diagnostics: &mut Vec<LocatedDiagnostic>) -> Map<String, Json> {
    let (kind, tables, mut own) = (kind_of(root), kind_tables(), Map::new());
    let of_kinds = |parameter: &&Parameter| tables.contains(&parameter.name);
    for parameter in study_keys().iter().filter(of_kinds) {
        let name = parameter.name;
        let Some(node) = root.table().and_then(|table| table.get(name)) else { continue };
        let mut checker = Checker::new(root);
        let value = checker.check(node, &parameter.shape, name);
        diagnostics.append(&mut checker.diagnostics);
        if kind == name {
            own = value.as_ref().and_then(Json::as_object).cloned().unwrap_or_default();
        } else {
            let message = format!("is only read by kind = \"{name}\", but the kind is \"{kind}\"");
            let help = format!("write kind = \"{name}\", or remove this table");
            diagnostics.push(LocatedDiagnostic::new(&root.place(name), name, message).help(help));
        }
    }
    own
}

/// What the study's kind finds wrong with its axes and its table.
fn check_outline(root: &Node, outline: &Outline, diagnostics: &mut Vec<LocatedDiagnostic>) {
    let Some(kind) = kind(kind_of(root)) else { return };
    diagnostics.extend(kind.check(outline).into_iter().map(|wrong| located(root, wrong)));
}

fn describe_case(case: &Expanded) -> String {
    let variant = case.variant.iter().map(|name| format!("variant \"{name}\""));
    let scene = case.scene.iter().map(|name| format!("scene \"{name}\""));
    let swept = case.parameters.iter().map(|(key, value)| format!("{key} = {value}"));
    variant.chain(scene).chain(swept).collect::<Vec<_>>().join(", ")
}
