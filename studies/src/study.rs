//! A study: what the keys of its file mean, and the cases it becomes.
//!
//! [`STUDY`] is the schema of the file, [`load`] the way from text to [`Study`]. Every mistake of
//! the whole file is reported at once. Solving the cases is not done here.

use crate::config::check::{Checker, gravity_of};
use crate::config::document::{Node, Origin, parse, parse_value};
use crate::config::expand::{Expanded, Plan};
use crate::config::overlay::{join, set};
use crate::config::report::{Mistake, sort, suggest};
use crate::loads::{LOAD, Load, place};
use serde_json::{Map, Value as Json};
use std::collections::HashMap;
use std::sync::Arc;
use voussoir_core::assembly::{Assembly, Bond, Catalogue, Joint, Settlement, Stage, Target};
use voussoir_core::card::{Capability, Card, candidate, candidates, card, cards_of};
use voussoir_core::geometry::Vec2;
use voussoir_core::interface::InterfaceLaw;
use voussoir_core::issue::Issue;
use voussoir_core::material::BulkMaterial;
use voussoir_core::scene::Scene;
use voussoir_core::schema::{Need, Parameter, PluginKind, Range, Shape};
use voussoir_core::units::Quantity;

const fn key(name: &'static str, shape: Shape, need: Need, doc: &'static str) -> Parameter {
    Parameter { name, doc, shape, need }
}

static LENGTH: Shape = Shape::Number(Quantity::Length, Range::ANY);
static ACCELERATION: Shape = Shape::Number(Quantity::Acceleration, Range::ANY);
static FREE: Shape = Shape::Free;
static MATERIAL: Shape = Shape::Plugin(PluginKind::BulkMaterial);
static LAW: Shape = Shape::Plugin(PluginKind::InterfaceLaw);

static SETTLEMENT: Shape = Shape::Table(&[
    key("support", Shape::Text, Need::Required, "left, right, or the name of a fixed block"),
    key("displacement", Shape::List { of: &LENGTH, min: 2, max: 2 }, Need::Default("[0.0, 0.0]"), "movement [x, y]"),
    Parameter::number(
        "rotation",
        Quantity::Radians,
        Range::ANY,
        "rotation about the middle of the springing joint, anticlockwise",
    )
    .default("0.0"),
]);

static STAGE: Shape = Shape::Table(&[
    key("name", Shape::Text, Need::Required, "name of the stage, unique in the study"),
    key(
        "gravity",
        Shape::Either(&[
            Shape::Number(Quantity::Acceleration, Range::NON_NEGATIVE),
            Shape::List { of: &ACCELERATION, min: 2, max: 2 },
        ]),
        Need::Optional("gravity stays as it was"),
        "gravity from this stage on: downwards, or a vector [gx, gy]",
    ),
    key(
        "loads",
        Shape::List { of: &LOAD, min: 0, max: usize::MAX },
        Need::Default("[]"),
        "loads, multiplied by the stage's factor",
    ),
    key(
        "until",
        Shape::Choice(&["collapse"]),
        Need::Optional("the stage goes to its factor"),
        "\"collapse\": raise the factor until collapse",
    ),
    Parameter::number("factor", Quantity::Ratio, Range::ANY, "factor of this stage's loads")
        .optional("1.0, unless until is given"),
    Parameter::number("factor_min", Quantity::Ratio, Range::ANY, "least factor searched").optional("0"),
    Parameter::number("factor_max", Quantity::Ratio, Range::ANY, "greatest factor searched").optional("unlimited"),
    key(
        "settlement",
        Shape::List { of: &SETTLEMENT, min: 0, max: usize::MAX },
        Need::Default("[]"),
        "movements of supports",
    ),
]);

static STOP: Shape = Shape::Table(&[
    Parameter::number(
        "displacement",
        Quantity::Length,
        Range::POSITIVE,
        "displacement of the load point behind a peak",
    )
    .optional("not a limit"),
    Parameter::number("factor", Quantity::Ratio, Range::ANY, "load factor at which a path ends")
        .optional("not a limit"),
]);

/// Keys of `[solver]` that every solver has.
pub static SOLVER: &[Parameter] = &[
    key("kinematics", Shape::Choice(&["small", "finite"]), Need::Default("\"small\""), "small or finite displacements"),
    key(
        "continuation",
        Shape::Plugin(PluginKind::Continuation),
        Need::Optional("the solver's own"),
        "strategy of path solvers: { strategy = \"arc_length\" }",
    ),
    Parameter::number(
        "tolerance",
        Quantity::Ratio,
        Range::new(0.0, true, 0.01, false),
        "relative tolerance of certificates",
    )
    .default("1e-9"),
    key("stop", STOP, Need::Optional("the path ends at collapse"), "how far to go behind a peak"),
];

static AXIS: Shape = Shape::Table(&[
    key(
        "list",
        Shape::List { of: &FREE, min: 1, max: usize::MAX },
        Need::Optional("from and to are given"),
        "the values",
    ),
    Parameter::number("from", Quantity::Ratio, Range::ANY, "first value").optional("list is given"),
    Parameter::number("to", Quantity::Ratio, Range::ANY, "last value").optional("list is given"),
    Parameter::number("step", Quantity::Ratio, Range::ANY, "step towards `to`").optional("count is given"),
    key("count", Shape::Integer { min: 1, max: 1_000_000 }, Need::Optional("step is given"), "number of values"),
]);
static AXES: Shape = Shape::Either(&[AXIS, Shape::Map(&AXIS)]);

/// A variant, and a scene of a comparison.
pub(crate) static VARIANT: Shape = Shape::Table(&[
    key("name", Shape::Text, Need::Required, "its name, unique in the study"),
    key("set", Shape::Map(&FREE), Need::Default("{}"), "dotted keys in quotes, with the values they take"),
]);

/// Keys of `[output]`.
pub(crate) static OUTPUT: Shape = Shape::Table(&[
    key("curve", Shape::Boolean, Need::Default("false"), "force-displacement points"),
    key("figures", Shape::Boolean, Need::Default("true"), "figures and the report"),
    key("vtu", Shape::Boolean, Need::Default("false"), "files for ParaView of the end of each path"),
]);

/// The keys of a study file.
pub static STUDY: &[Parameter] = &[
    key("name", Shape::Text, Need::Required, "name of the study"),
    key("kind", Shape::Text, Need::Default("\"run\""), "what is done with the cases"),
    key("scene", Shape::Plugin(PluginKind::Scene), Need::Required, "the geometry"),
    key("materials", Shape::Map(&MATERIAL), Need::Required, "materials of blocks by name"),
    key("joints", Shape::Map(&LAW), Need::Default("{}"), "laws of joints by name"),
    key(
        "stages",
        Shape::List { of: &STAGE, min: 1, max: usize::MAX },
        Need::Required,
        "stages of loading, [[stages]], in order",
    ),
    key(
        "solver",
        Shape::Plugin(PluginKind::LimitSolver),
        Need::Default("{ solver = \"auto\" }"),
        "how the cases are answered",
    ),
    key(
        "sweep",
        Shape::Map(&AXES),
        Need::Optional("one case"),
        "axes by dotted key in quotes; keys under zip change together",
    ),
    key(
        "variants",
        Shape::List { of: &VARIANT, min: 0, max: usize::MAX },
        Need::Optional("no variants"),
        "each overrides any keys",
    ),
    key(
        "compare",
        Shape::Table(crate::kinds::compare::KEYS),
        Need::Optional("one scene"),
        "what kind = \"compare\" sets beside each other",
    ),
    key(
        "map",
        Shape::Table(crate::kinds::map::KEYS),
        Need::Optional("the first two variants are compared"),
        "what kind = \"map\" draws",
    ),
    key("output", OUTPUT, Need::Default("{}"), "what is written besides the results"),
];

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
    mistakes.extend(kind.check(outline).into_iter().map(|issue| {
        let mut mistake = Mistake::new(&root.place(&issue.path), issue.path, issue.message);
        mistake.help = issue.help;
        mistake
    }));
}

fn describe_case(case: &Expanded) -> String {
    let variant = case.variant.iter().map(|name| format!("variant \"{name}\""));
    let scene = case.scene.iter().map(|name| format!("scene \"{name}\""));
    let swept = case.parameters.iter().map(|(key, value)| format!("{key} = {value}"));
    variant.chain(scene).chain(swept).collect::<Vec<_>>().join(", ")
}

/// The mistakes of one case, gathered while it is built.
struct Builder<'a> {
    root: &'a Node,
    mistakes: Vec<Mistake>,
}

impl Builder<'_> {
    fn wrong(&mut self, key: &str, message: impl Into<String>, help: impl Into<String>) {
        self.mistakes.push(Mistake::new(&self.root.place(key), key, message).help(help));
    }

    fn issues(&mut self, issues: Vec<Issue>) {
        for issue in issues {
            let mut mistake = Mistake::new(&self.root.place(&issue.path), issue.path, issue.message);
            mistake.help = issue.help;
            self.mistakes.push(mistake);
        }
    }

    fn plugins<T: serde::de::DeserializeOwned>(&mut self, name: &str, tables: &Json) -> Option<Vec<(String, T)>> {
        let mut out = Vec::new();
        for (entry, table) in tables.as_object()? {
            match serde_json::from_value(table.clone()) {
                Ok(plugin) => out.push((entry.clone(), plugin)),
                Err(error) => self.wrong(&join(name, entry), format!("cannot be read: {error}"), "correct this table"),
            }
        }
        Some(out)
    }
}

fn build_case(id: usize, expanded: Expanded) -> Result<Case, Vec<Mistake>> {
    let Expanded { variant, scene, parameters, root } = expanded;
    let mut checker = Checker::new(&root);
    checker.gravity = gravity_of(&root);
    let Some(table) = root.table() else {
        return Err(vec![Mistake::new(&root.origin, "", "must be a table")]);
    };
    let names: Vec<_> = STUDY.iter().map(|parameter| parameter.name).collect();
    // A key that is written wrongly is not missing as well.
    let mut misspelt = Vec::new();
    for entry in table.entries.iter().filter(|entry| !names.contains(&entry.key.as_str())) {
        misspelt.extend(voussoir_core::card::nearest(&entry.key, names.iter().copied()));
        let help = suggest(&entry.key, &names, "keys here");
        checker.mistakes.push(Mistake::new(&entry.origin, &entry.key, "is not a key of a study").help(help));
    }
    let mut resolved = Map::new();
    let apart = ["sweep", "variants", "compare", "map"];
    for parameter in STUDY.iter().filter(|p| !apart.contains(&p.name)) {
        if table.get(parameter.name).is_none() && misspelt.contains(&parameter.name) {
            continue;
        }
        if let Ok(Some(value)) = checker.parameter(&root, table, parameter, "") {
            resolved.insert(parameter.name.into(), value);
        }
    }
    let Checker { mistakes, unused, .. } = checker;
    let mut builder = Builder { root: &root, mistakes };
    let mut notes: Vec<String> =
        unused.into_iter().map(|unused| format!("{} is not used by {}", unused.key, unused.by)).collect();

    check_kind_and_output(&mut builder, &resolved);
    let catalogue = catalogue(&mut builder, &resolved);
    let assembly = catalogue.and_then(|catalogue| assembly(&mut builder, &resolved, &catalogue));
    let stages = resolved.get("stages").and_then(|stages| build_stages(&mut builder, stages, assembly.as_ref()));
    let solver =
        resolved.get("solver").and_then(|solver| choose_solver(&mut builder, solver, &resolved, assembly.as_ref()));
    let limit = solver.as_ref().is_some_and(|solver| card(PluginKind::LimitSolver, &solver.tag).is_some());
    let rigid = assembly.as_ref().is_some_and(|assembly| !assembly.deforms());
    if limit || rigid {
        notes.extend(unused_by_limit_analysis(&resolved));
    }
    match (assembly, stages, solver) {
        (Some(assembly), Some(stages), Some(solver)) if builder.mistakes.is_empty() => {
            let output_curve = resolved.get("output").is_some_and(|output| output["curve"] == true);
            Ok(Case {
                id,
                variant,
                scene,
                parameters,
                assembly,
                stages,
                solver,
                output_curve,
                notes,
                resolved: Json::Object(resolved),
            })
        }
        _ => Err(builder.mistakes),
    }
}

fn check_kind_and_output(builder: &mut Builder<'_>, resolved: &Map<String, Json>) {
    if let Some(kind) = resolved.get("kind").and_then(Json::as_str) {
        let mut kinds: Vec<_> = cards_of(PluginKind::StudyKind).iter().map(|card| card.tag).collect();
        if !kinds.contains(&"run") {
            kinds.insert(0, "run");
        }
        if !kinds.contains(&kind) {
            let help = suggest(kind, &kinds, "kinds available");
            builder.wrong("kind", format!("there is no study kind \"{kind}\""), help);
        }
    }
}

fn catalogue(builder: &mut Builder<'_>, resolved: &Map<String, Json>) -> Option<Catalogue> {
    let materials = resolved.get("materials").and_then(|t| builder.plugins::<Box<dyn BulkMaterial>>("materials", t));
    let laws = resolved.get("joints").and_then(|t| builder.plugins::<Box<dyn InterfaceLaw>>("joints", t));
    let (materials, laws) = (materials?, laws?);
    Some(Catalogue {
        materials: materials.into_iter().map(|(name, material)| (name, Arc::from(material))).collect(),
        laws: laws.into_iter().map(|(name, law)| (name, Arc::from(law))).collect(),
    })
}

fn assembly(builder: &mut Builder<'_>, resolved: &Map<String, Json>, catalogue: &Catalogue) -> Option<Assembly> {
    let scene: Box<dyn Scene> = match serde_json::from_value(resolved.get("scene")?.clone()) {
        Ok(scene) => scene,
        Err(error) => {
            builder.wrong("scene", format!("cannot be read: {error}"), "correct this table");
            return None;
        }
    };
    scene.build(catalogue).map_err(|issues| builder.issues(issues)).ok()
}

fn build_stages(builder: &mut Builder<'_>, stages: &Json, assembly: Option<&Assembly>) -> Option<Vec<Stage>> {
    let stages = stages.as_array()?;
    let before = builder.mistakes.len();
    let mut out: Vec<Stage> = Vec::new();
    for (index, stage) in stages.iter().enumerate() {
        let at = format!("stages.{index}");
        let name = stage["name"].as_str().unwrap_or_default().to_string();
        if stages[..index].iter().any(|earlier| earlier["name"] == stage["name"]) {
            builder.wrong(
                &join(&at, "name"),
                format!("two stages are called \"{name}\""),
                "give each stage a name of its own",
            );
        }
        let collapse = stage["until"] == "collapse";
        if collapse && stage.get("factor").is_some() {
            let help = "keep until to raise the loads to collapse, or factor to stop at that factor";
            builder.wrong(&join(&at, "factor"), "is given besides until = \"collapse\"", help);
        }
        if collapse && index + 1 < stages.len() {
            let help = "make it the last stage, or give this stage a factor";
            builder.wrong(
                &join(&at, "until"),
                "\"collapse\" is only possible in the last stage: nothing can be loaded after it",
                help,
            );
        }
        let factor = |key: &str| stage.get(key).and_then(Json::as_f64);
        let (least, greatest) = (factor("factor_min").unwrap_or(0.0), factor("factor_max").unwrap_or(f64::INFINITY));
        if least > greatest {
            let named = if factor("factor_max").is_some() { "factor_max" } else { "factor_min" };
            let message = format!("the search would go from factor_min = {least} to factor_max = {greatest}");
            builder.wrong(&join(&at, named), message, "factor_min must be at most factor_max");
        }
        let settlements = match assembly {
            Some(assembly) => build_settlements(builder, &stage["settlement"], assembly, &at),
            None => Vec::new(),
        };
        let (mut forces, mut accelerations) = (Vec::new(), Vec::new());
        for (number, load) in stage["loads"].as_array().into_iter().flatten().enumerate() {
            let path = format!("{at}.loads.{number}");
            let load: Load = match serde_json::from_value(load.clone()) {
                Ok(load) => load,
                Err(error) => {
                    builder.wrong(&path, format!("cannot be read: {error}"), "correct this load");
                    continue;
                }
            };
            let Some(assembly) = assembly else { continue };
            match place(&load, assembly, &path) {
                Ok((placed, accelerated)) => {
                    let (groups, _) = assembly.rigid_groups();
                    let held = placed.iter().find(|f| groups[f.body].is_none() && assembly.is_rigid(f.body));
                    if let Some(force) = held {
                        let name = &assembly.bodies[force.body].name;
                        let message = format!(
                            "the load acts on \"{name}\", which is rigid and held by the ground, so it has no effect"
                        );
                        let help = "move the load to a block that can move, or join the ends: ends = \"jointed\"";
                        builder.wrong(&path, message, help);
                    }
                    forces.extend(placed);
                    accelerations.extend(accelerated);
                }
                Err(issues) => builder.issues(issues),
            }
        }
        if collapse
            && assembly.is_some()
            && builder.mistakes.len() == before
            && forces.iter().all(|force| force.force.norm() == 0.0)
            && accelerations.iter().all(|acceleration| acceleration.norm() == 0.0)
            && settlements.is_empty()
        {
            let help = "give this stage a load that is not zero; gravity is not multiplied by the factor";
            builder.wrong(&join(&at, "until"), "\"collapse\" needs a load to raise, but this stage has none", help);
        }
        let gravity = match &stage["gravity"] {
            Json::Array(vector) => {
                Some(Vec2::new(vector[0].as_f64().unwrap_or(0.0), vector[1].as_f64().unwrap_or(0.0)))
            }
            number => number.as_f64().map(|down| Vec2::new(0.0, -down)),
        };
        let target = if collapse { Target::Collapse } else { Target::Factor(factor("factor").unwrap_or(1.0)) };
        out.push(Stage {
            name,
            gravity,
            forces,
            accelerations,
            settlements,
            target,
            factor_min: least,
            factor_max: greatest,
        });
    }
    Some(out)
}

/// The movements of supports of a stage.
fn build_settlements(builder: &mut Builder<'_>, list: &Json, assembly: &Assembly, at: &str) -> Vec<Settlement> {
    let mut out = Vec::new();
    for (number, entry) in list.as_array().into_iter().flatten().enumerate() {
        let support = entry["support"].as_str().unwrap_or_default();
        let fixed: Vec<&str> = assembly.bodies.iter().filter(|b| b.fixed).map(|b| b.name.as_str()).collect();
        let Some(body) = assembly.body(support).filter(|body| assembly.bodies[*body].fixed) else {
            let path = format!("{at}.settlement.{number}.support");
            let help = suggest(support, &fixed, "supports here");
            builder.wrong(&path, format!("there is no support \"{support}\""), help);
            continue;
        };
        let joint = assembly.joints.iter().find(|joint| joint.minus == body || joint.plus == body);
        let number = |key: &str, i: usize| entry[key][i].as_f64().unwrap_or(0.0);
        out.push(Settlement {
            body,
            displacement: Vec2::new(number("displacement", 0), number("displacement", 1)),
            rotation: entry["rotation"].as_f64().unwrap_or(0.0),
            about: joint.map_or(Vec2::zeros(), Joint::middle),
        });
    }
    out
}

fn solvers_that(fit: impl Fn(&Card) -> bool) -> Vec<&'static str> {
    candidates(PluginKind::LimitSolver).into_iter().filter(|card| fit(card)).map(|card| card.tag).collect()
}

fn offers(capability: Capability) -> bool {
    !solvers_that(|card| card.provides.contains(&capability)).is_empty()
}

fn or_none(tags: &[&str]) -> String {
    if tags.is_empty() { "none registered".into() } else { tags.join(", ") }
}

fn choose_solver(
    builder: &mut Builder<'_>,
    solver: &Json,
    resolved: &Map<String, Json>,
    assembly: Option<&Assembly>,
) -> Option<SolverChoice> {
    let tag = solver["solver"].as_str()?.to_string();
    let chosen = candidate(PluginKind::LimitSolver, &tag);
    let kinematics = if solver["kinematics"] == "finite" { Kinematics::Finite } else { Kinematics::Small };
    let finite = |card: &Card| card.provides.contains(&Capability::FiniteDisplacements);
    if kinematics == Kinematics::Finite && !chosen.map_or_else(|| offers(Capability::FiniteDisplacements), finite) {
        let able = solvers_that(finite);
        let message = match able.is_empty() {
            true => "no registered solver offers finite displacements".to_string(),
            false => {
                format!("solver \"{tag}\" does not offer finite displacements; solvers that do: {}", able.join(", "))
            }
        };
        builder.wrong("solver.kinematics", message, "set kinematics = \"small\"");
    }
    // `auto` needs at least what every solver needs.
    let everyone: Vec<Capability> = cards_of(PluginKind::LimitSolver)
        .iter()
        .flat_map(|card| card.requires)
        .filter(|need| solvers_that(|solver| !solver.requires.contains(need)).is_empty())
        .copied()
        .collect();
    let asked = chosen.map_or(everyone.as_slice(), |chosen| chosen.requires);
    if let Some(assembly) = assembly {
        let used = |law: usize| assembly.joints.iter().any(|joint| joint.bond == Bond::Law(law));
        let laws = assembly.catalogue.laws.iter().enumerate().filter(|(law, _)| used(*law));
        let laws = laws.map(|(_, (name, _))| ("joints", name, PluginKind::InterfaceLaw));
        let materials =
            assembly.catalogue.materials.iter().map(|(name, _)| ("materials", name, PluginKind::BulkMaterial));
        for (table, name, kind) in laws.chain(materials) {
            let law = resolved[table][name]["law"].as_str().unwrap_or_default();
            let Some(card) = card(kind, law) else {
                continue;
            };
            let missing: Vec<_> = asked.iter().filter(|need| concerns(**need) == kind && !card.gives(**need)).collect();
            for need in missing {
                let takes = |need: &Capability| concerns(*need) != kind || card.gives(*need);
                let able = solvers_that(|solver| solver.requires.iter().all(takes));
                let message = format!(
                    "solver \"{tag}\" needs {}, which {} \"{law}\" of [{table}.{name}] does not give",
                    need.describe(),
                    kind.describe()
                );
                let help = format!("solvers that can take it: {}", or_none(&able));
                builder.wrong(&join(&join(table, name), "law"), message, help);
            }
        }
    }
    needs_deformation(builder, resolved, assembly, chosen, kinematics);
    let own = |key: &str| chosen.is_some_and(|card| card.parameters.iter().any(|p| p.name == key));
    let mut table = solver.as_object()?.clone();
    table.retain(|key, _| key == "solver" || own(key));
    let tolerance = solver["tolerance"].as_f64().unwrap_or(1e-9);
    Some(SolverChoice {
        tag,
        table: Json::Object(table),
        tolerance,
        kinematics,
        continuation: solver.get("continuation").cloned(),
        stop_displacement: solver["stop"]["displacement"].as_f64(),
        stop_factor: solver["stop"]["factor"].as_f64(),
    })
}

/// What only a path answers needs something that deforms, and no limit analysis.
fn needs_deformation(
    builder: &mut Builder<'_>,
    resolved: &Map<String, Json>,
    assembly: Option<&Assembly>,
    chosen: Option<&Card>,
    kinematics: Kinematics,
) {
    let limit = chosen.is_some_and(|card| card.kind == PluginKind::LimitSolver);
    let path = chosen.is_some_and(|card| card.kind == PluginKind::PathSolver);
    let rigid = assembly.is_some_and(|assembly| !assembly.deforms());
    let help = "give a material a young_modulus (law = \"elastic\") or a joint law a normal_stiffness";
    let reason = "all blocks are rigid and no joint is compliant: there is no path before the collapse";
    let stages = resolved.get("stages").and_then(Json::as_array).map(Vec::as_slice).unwrap_or_default();
    for (index, stage) in stages.iter().enumerate() {
        if stage["settlement"].as_array().is_none_or(Vec::is_empty) {
            continue;
        }
        let at = format!("stages.{index}.settlement");
        if limit {
            let help = "remove the settlement, or take a path solver: event_path, newton_path";
            builder.wrong(&at, "limit analysis of rigid blocks knows loads only", help);
        } else if rigid {
            builder.wrong(&at, reason, help);
        }
    }
    if rigid && kinematics == Kinematics::Finite && !limit {
        builder.wrong("solver.kinematics", reason, help);
    } else if rigid && path {
        builder.wrong(
            "solver.solver",
            reason,
            "take limit analysis, or give a material a young_modulus (law = \"elastic\")",
        );
    }
}

/// Which kind of law a capability is asked of.
fn concerns(capability: Capability) -> PluginKind {
    match capability {
        Capability::RigidLimit | Capability::Linear | Capability::StressUpdate => PluginKind::BulkMaterial,
        _ => PluginKind::InterfaceLaw,
    }
}

fn unused_by_limit_analysis(resolved: &Map<String, Json>) -> Vec<String> {
    let mut notes = Vec::new();
    for (name, law) in resolved.get("joints").and_then(Json::as_object).into_iter().flatten() {
        for stiffness in ["normal_stiffness", "shear_stiffness"].iter().filter(|key| law.get(**key).is_some()) {
            notes.push(format!("joints.{name}.{stiffness} has no influence on a limit load"));
        }
    }
    for key in ["continuation", "stop"] {
        if resolved.get("solver").is_some_and(|solver| solver.get(key).is_some()) {
            notes.push(format!("solver.{key} is not used by limit analysis"));
        }
    }
    notes
}
