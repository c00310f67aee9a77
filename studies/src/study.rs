//! A study: what the keys of its file mean, and the cases it becomes.
//!
//! [`STUDY`] is the schema of the file, [`load`] the way from text to [`Study`]. Every mistake of
//! the whole file is reported at once. Solving the cases is not done here.

mod case;
mod keys;
mod solver;

pub(crate) use keys::{OUTPUT, VARIANT};
pub use keys::{SOLVER, STUDY};

use crate::config::check::Checker;
use crate::config::document::{Node, Origin, parse, parse_value};
use crate::config::expand::{Expanded, Plan};
use crate::config::overlay::set;
use crate::config::report::{Mistake, sort};
use case::build_case;
use serde_json::{Map, Value as Json};
use std::collections::HashMap;
use voussoir_core::model::{Assembly, Stage};
use voussoir_core::plugin::Shape;

/// Whether equilibrium is that of the undeformed geometry.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kinematics {
    /// It is.
    Small,
    /// It is that of displaced positions.
    Finite,
}

/// How a case is to be answered.
#[derive(Debug, Clone)]
pub struct SolverChoice {
    /// `"auto"`, or the tag of a solver.
    pub tag: String,
    /// Tag and the solver's own keys, as its plug-in reads them.
    pub table: Json,
    /// Relative tolerance of certificates.
    pub tolerance: f64,
    /// Small or finite displacements.
    pub kinematics: Kinematics,
    /// Continuation strategy, as its plug-in reads it.
    pub continuation: Option<Json>,
    /// How far behind a peak: displacement of the load \[m\].
    pub stop_displacement: Option<f64>,
    /// At which factor a falling branch ends.
    pub stop_factor: Option<f64>,
}

/// One case, ready to be solved.
#[derive(Debug, Clone)]
pub struct Case {
    /// Index from 0, variants outermost.
    pub id: usize,
    /// Name of its variant, if the study has variants.
    pub variant: Option<String>,
    /// Name of its scene, where the study compares several.
    pub scene: Option<String>,
    /// Swept key → value.
    pub parameters: Map<String, Json>,
    /// Bodies and joints.
    pub assembly: Assembly,
    /// Loads, stage by stage.
    pub stages: Vec<Stage>,
    /// How it is to be answered.
    pub solver: SolverChoice,
    /// Whether force-displacement points are asked for.
    pub output_curve: bool,
    /// Keys that were given and have no influence.
    pub notes: Vec<String>,
    /// The case's own study file: numbers in SI units, defaults filled in.
    pub resolved: Json,
}

/// What is written besides the results.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Output {
    /// Force-displacement points.
    pub curve: bool,
    /// Figures and the report.
    pub figures: bool,
    /// Files for ParaView.
    pub vtu: bool,
}

/// The axes of a study, outermost first, and what its kind is told.
#[derive(Debug, Clone, Default)]
pub struct Outline {
    /// Names of the variants; empty where there are none.
    pub variants: Vec<String>,
    /// Names of the scenes compared; empty where there is only one.
    pub scenes: Vec<String>,
    /// Keys of each axis of the sweep, which change together, and whether the first takes numbers.
    pub axes: Vec<(Vec<String>, bool)>,
    /// The table named after the study's kind; empty where it has none.
    pub table: Map<String, Json>,
}

impl Outline {
    /// The index of the variant that `key` of the kind's table names.
    pub fn variant(&self, key: &str) -> Option<usize> {
        let name = self.table.get(key)?.as_str()?;
        self.variants.iter().position(|variant| variant == name)
    }
}

/// A study file that holds no mistake.
#[derive(Debug, Clone)]
pub struct Study {
    /// Its name.
    pub name: String,
    /// What is done with the cases: the tag of a study kind.
    pub kind: String,
    /// Its axes and the table of its kind.
    pub outline: Outline,
    /// What is written.
    pub output: Output,
    /// All cases in order.
    pub cases: Vec<Case>,
    /// The file with `--set` applied. Values stand as they were written and defaults are not filled
    /// in, because a variant may change what a default or a specific weight means; read again, it
    /// makes exactly the same cases.
    pub resolved: toml::Value,
}

/// Greatest number of different mistakes reported.
const MAX_MISTAKES: usize = 100;

/// Sets the `--set KEY=VALUE` of the command line; a value that is no TOML is taken as text.
pub(crate) fn apply(root: &mut Node, sets: &[(String, String)]) -> Vec<Mistake> {
    let mut mistakes = Vec::new();
    for (path, value) in sets {
        let origin = Origin::Set(path.as_str().into());
        let value = parse_value(value, &origin).unwrap_or_else(|| {
            parse_value(&format!("{value:?}"), &origin).unwrap_or_else(|| Node {
                value: crate::config::document::Value::String(value.clone()),
                origin: origin.clone(),
            })
        });
        mistakes.extend(set(root, path, value, &origin).err().map(|mistake| *mistake));
    }
    mistakes
}

/// Reads a study. `file` is its name in messages, `sets` the `--set KEY=VALUE` of the command line;
/// a value that is no TOML is taken as text.
pub fn load(text: &str, file: &str, sets: &[(String, String)]) -> Result<Study, Vec<Mistake>> {
    let mut root = parse(text, file)?;
    let mut mistakes = apply(&mut root, sets);
    if root.table().and_then(|table| table.get("kind")?.text()) == Some("point") {
        let message = "\"point\" has no scene to solve";
        mistakes
            .push(Mistake::new(&root.place("kind"), "kind", message).help("drive it by `voussoir point STUDY.toml`"));
        return Err(mistakes);
    }
    check_variants(&root, &mut mistakes);
    let table = kind_table(&root, &mut mistakes);
    let plan = match Plan::new(&root) {
        Ok(plan) => plan,
        Err(wrong) => {
            mistakes.extend(wrong);
            sort(&mut mistakes);
            return Err(mistakes);
        }
    };
    for (path, _) in sets {
        if plan.swept().any(|swept| swept == path) {
            let message = "is swept, so setting it has no effect";
            let help = format!("change the axis instead: --set 'sweep.\"{path}\".list=[…]'");
            mistakes.push(Mistake::new(&Origin::Set(path.as_str().into()), path, message).help(help));
        }
    }
    let outline = Outline { variants: plan.variants(), scenes: plan.scenes(), axes: plan.axes(), table };
    check_outline(&root, &outline, &mut mistakes);
    let count = plan.count();
    let mut found: HashMap<Mistake, usize> = HashMap::new();
    let mut order: Vec<(Mistake, String)> = Vec::new();
    let mut cases = Vec::new();
    for id in 0..count {
        let (result, label) = match plan.case(id) {
            Ok(expanded) => {
                let label = describe_case(&expanded);
                (build_case(id, expanded), label)
            }
            Err(wrong) => (Err(wrong), String::new()),
        };
        match result {
            Ok(case) => cases.push(case),
            Err(wrong) => {
                for mistake in wrong {
                    let times = found.entry(mistake.clone()).or_insert(0);
                    if *times == 0 {
                        order.push((mistake, label.clone()));
                    }
                    *times += 1;
                }
            }
        }
        if order.len() > MAX_MISTAKES {
            break;
        }
    }
    mistakes.extend(order.into_iter().map(|(mut mistake, label)| {
        if found[&mistake] < count && !label.is_empty() {
            mistake.case = Some(label);
        }
        mistake
    }));
    if !mistakes.is_empty() {
        sort(&mut mistakes);
        return Err(mistakes);
    }
    let first = cases.first().map(|case| &case.resolved);
    let text_of = |name: &str| first.and_then(|case| case[name].as_str()).unwrap_or_default().to_string();
    let flag = |name: &str| first.and_then(|case| case["output"][name].as_bool()).unwrap_or(false);
    Ok(Study {
        name: text_of("name"),
        kind: text_of("kind"),
        outline,
        output: Output { curve: flag("curve"), figures: flag("figures"), vtu: flag("vtu") },
        cases,
        resolved: root.to_toml(),
    })
}

fn check_variants(root: &Node, mistakes: &mut Vec<Mistake>) {
    let Some(variants) = root.table().and_then(|table| table.get("variants")) else {
        return;
    };
    let mut checker = Checker::new(root);
    checker.check(variants, &Shape::List { of: &VARIANT, min: 0, max: usize::MAX }, "variants");
    mistakes.append(&mut checker.mistakes);
}

/// The word after `kind`.
fn kind_of(root: &Node) -> &str {
    root.table().and_then(|table| table.get("kind")?.text()).unwrap_or("run")
}

/// The table of the study's kind, checked; a table of another kind is a mistake.
fn kind_table(root: &Node, mistakes: &mut Vec<Mistake>) -> Map<String, Json> {
    let (kind, mut own) = (kind_of(root), Map::new());
    for parameter in STUDY.iter().filter(|parameter| ["compare", "map"].contains(&parameter.name)) {
        let name = parameter.name;
        let Some(node) = root.table().and_then(|table| table.get(name)) else { continue };
        let mut checker = Checker::new(root);
        let value = checker.check(node, &parameter.shape, name);
        mistakes.append(&mut checker.mistakes);
        if kind == name {
            own = value.as_ref().and_then(Json::as_object).cloned().unwrap_or_default();
        } else {
            let message = format!("is only read by kind = \"{name}\", but the kind is \"{kind}\"");
            let help = format!("write kind = \"{name}\", or remove this table");
            mistakes.push(Mistake::new(&root.place(name), name, message).help(help));
        }
    }
    own
}

/// What the study's kind finds wrong with its axes and its table.
fn check_outline(root: &Node, outline: &Outline, mistakes: &mut Vec<Mistake>) {
    let Some(kind) = crate::kinds::kind(kind_of(root)) else { return };
    mistakes.extend(kind.check(outline).into_iter().map(|diagnostic| {
        let mut mistake = Mistake::new(&root.place(&diagnostic.path), diagnostic.path, diagnostic.message);
        mistake.help = diagnostic.help;
        mistake
    }));
}

fn describe_case(case: &Expanded) -> String {
    let variant = case.variant.iter().map(|name| format!("variant \"{name}\""));
    let scene = case.scene.iter().map(|name| format!("scene \"{name}\""));
    let swept = case.parameters.iter().map(|(key, value)| format!("{key} = {value}"));
    variant.chain(scene).chain(swept).collect::<Vec<_>>().join(", ")
}
