//! The keys of a study file.

use super::partial_factors::FACTORS;
use crate::config::common_keys::STOP;
use crate::kinds::kinds;
use crate::loads::{VEHICLE, load_shape};
use std::sync::LazyLock;
use voussoir_core::plugin::{Card, Need, Parameter, PluginKind, Quantity, Range, Shape, card, cards_of};

const fn key(name: &'static str, shape: Shape, need: Need, doc: &'static str) -> Parameter {
    Parameter { name, doc, shape, need }
}

const LENGTH: Shape = Shape::Number(Quantity::Length, Range::ANY);
const ACCELERATION: Shape = Shape::Number(Quantity::Acceleration, Range::ANY);
static FREE: Shape = Shape::Free;
static MATERIAL: Shape = Shape::Plugin(PluginKind::BulkMaterial);
static LAW: Shape = Shape::Plugin(PluginKind::InterfaceLaw);

static SETTLEMENT: Shape = Shape::Table(&[
    key("support", Shape::Text, Need::Required, "left, right, or the name of a fixed block"),
    key(
        "displacement",
        Shape::Tuple(&[("x", LENGTH), ("y", LENGTH)]),
        Need::Default("[0.0, 0.0]"),
        "displacement of the support, x to the right and y upwards",
    ),
    Parameter::number(
        "rotation",
        Quantity::Radians,
        Range::ANY,
        "rotation about the middle of the springing joint, anticlockwise",
    )
    .default("0.0"),
]);

/// The value of `until` with which a stage ends at its first limit point.
pub const FIRST_LIMIT_POINT: &str = "first_limit_point";

/// Keys of a stage but for `loads`, which stand after the second.
static STAGE: &[Parameter] = &[
    key("name", Shape::Text, Need::Required, "name of the stage, unique in the study"),
    key(
        "gravity",
        Shape::Either(&[
            Shape::Number(Quantity::Acceleration, Range::NON_NEGATIVE),
            Shape::Tuple(&[("x", ACCELERATION), ("y", ACCELERATION)]),
        ]),
        Need::Optional("gravity stays as it was"),
        "gravity from this stage on: downwards, or a vector [gx, gy]",
    ),
    key(
        "until",
        Shape::Choice(&["collapse", FIRST_LIMIT_POINT]),
        Need::Optional("the stage goes to its factor"),
        "\"collapse\": raise the factor until collapse; \"first_limit_point\": stop a path at its first limit point",
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
    key(
        "continuation",
        Shape::Plugin(PluginKind::Continuation),
        Need::Optional("that of [solver]"),
        "strategy of path solvers in this stage",
    ),
    key("stop", STOP, Need::Optional("that of [solver]"), "how far to go after a peak in this stage"),
    key("solver", Shape::Text, Need::Optional("that of [solver]"), "tag of the limit solver that answers this stage"),
];

static AXIS: Shape = Shape::Table(&[
    key(
        "list",
        Shape::List { of: &FREE, min: 1, max: usize::MAX },
        Need::Optional("from and to are given"),
        "the values",
    ),
    Parameter::number("from", Quantity::Ratio, Range::ANY, "first value, in the unit of the key")
        .optional("list is given"),
    Parameter::number("to", Quantity::Ratio, Range::ANY, "last value, in the unit of the key")
        .optional("list is given"),
    Parameter::number("step", Quantity::Ratio, Range::ANY, "step towards `to`, in the unit of the key")
        .optional("count is given"),
    key("count", Shape::Integer { min: 1, max: 1_000_000 }, Need::Optional("step is given"), "number of values"),
]);
static AXES: Shape = Shape::Either(&[AXIS, Shape::Map(&AXIS)]);

/// A variant, and a scene of a comparison.
pub static VARIANT: Shape = Shape::Table(&[
    key("name", Shape::Text, Need::Required, "its name, unique in the study"),
    key("set", Shape::Map(&FREE), Need::Default("{}"), "dotted keys in quotes, with the values they take"),
]);

/// Keys of `[output]` that studies of every kind have.
static OUTPUT_KEYS: &[Parameter] = &[
    key("curve", Shape::Boolean, Need::Default("false"), "force-displacement points"),
    key(
        "figures",
        Shape::Either(&[Shape::Boolean, Shape::Choice(&["all", "worst", "none"])]),
        Need::Default("true"),
        "figures: of all cases, of the worst of each variant, of none; true: of all up to 50 cases, else of the worst",
    ),
    key(
        "states",
        Shape::Integer { min: 2, max: 500 },
        Need::Optional("no states are kept"),
        "of each path so many states are kept, for the drawing that moves in the report",
    ),
    key(
        "sensitivities",
        Shape::Boolean,
        Need::Default("false"),
        "derivatives of the load factor of limit analysis with respect to every number, on both sides",
    ),
    key(
        "accuracy",
        Shape::Choice(&["estimate"]),
        Need::Optional("errors are not estimated"),
        "\"estimate\": how far the load factor may be off, by solving again on a mesh twice as fine and with half the step",
    ),
    key(
        "animation",
        Shape::Boolean,
        Need::Default("false"),
        "of an envelope: figures/moving-load.svg, the load on its way with the mechanism at each place",
    ),
    key("vtu", Shape::Boolean, Need::Default("false"), "files for ParaView of the end of each path"),
    key(
        "fields",
        Shape::Boolean,
        Need::Default("true"),
        "the forces and motions that prove each answer; false: they are checked and not kept, and drawings show the scene alone",
    ),
    key(
        "joints",
        Shape::Boolean,
        Need::Default("true"),
        "of a load that is carried: forces and stresses of each joint, the reserve to collapse, the permissible limit state",
    ),
    key(
        "thrust_zone",
        Shape::Boolean,
        Need::Optional("if few joints close the blocks to rings and nothing is swept"),
        "of a load that is carried: the interval of eccentricities of each joint over all admissible fields",
    ),
    key(
        "path_proofs",
        Shape::Boolean,
        Need::Optional("paths of up to 200,000 numbers of studies of up to 20 cases"),
        "path_proofs.jsonl: the states and witnesses of each path that prove its end without a solver; true: of all paths, false: of none",
    ),
];

/// `[output]` of studies without writers.
pub static OUTPUT: Shape = Shape::Table(OUTPUT_KEYS);

/// `[output]` with the registered writers: which of them write, and a table of options for each that has keys.
fn output() -> Shape {
    let cards = cards_of(PluginKind::Writer);
    // Made once, from a registry that lives as long as the program.
    let tags: &'static [&'static str] = Vec::leak(cards.iter().map(|card| card.tag).collect());
    let tag: &'static Shape = Box::leak(Box::new(Shape::Choice(tags)));
    let with_keys = cards.into_iter().filter(|card| !card.parameters.is_empty());
    let options: Vec<Parameter> =
        with_keys.map(|card| key(card.tag, Shape::Table(card.parameters), Need::Default("{}"), card.summary)).collect();
    let mut keys = OUTPUT_KEYS.to_vec();
    let list = Shape::List { of: tag, min: 0, max: usize::MAX };
    keys.push(key(
        "writers",
        list,
        Need::Optional("all"),
        "tags of the writers that write; results.json is always written",
    ));
    keys.push(key("options", Shape::Table(Vec::leak(options)), Need::Default("{}"), "options of writers, by tag"));
    Shape::Table(Vec::leak(keys))
}

/// Cards of study kinds that read a table of their own, `[compare]` and the like, named as their tag.
fn kinds_with_tables() -> impl Iterator<Item = &'static Card> {
    kinds()
        .into_iter()
        .filter(|entry| entry.kind.file_keys().is_none())
        .filter_map(|entry| card(PluginKind::StudyKind, entry.tag))
        .filter(|card| !card.parameters.is_empty())
}

/// Names of the tables of study kinds, which are no part of a case.
pub fn kind_tables() -> &'static [&'static str] {
    static TABLES: LazyLock<Vec<&'static str>> = LazyLock::new(|| kinds_with_tables().map(|card| card.tag).collect());
    &TABLES
}

/// The top-level keys that are part of a case.
pub fn case_keys() -> impl Iterator<Item = &'static Parameter> {
    let apart = |name: &str| ["sweep", "variants"].contains(&name) || kind_tables().contains(&name);
    study_keys().iter().filter(move |parameter| !apart(parameter.name))
}

/// The keys of a study file: those that every study has, and the table of each study kind that reads one.
pub fn study_keys() -> &'static [Parameter] {
    static KEYS: LazyLock<Vec<Parameter>> = LazyLock::new(|| {
        let table =
            |card: &Card| key(card.tag, Shape::Table(card.parameters), Need::Optional("defaults"), card.summary);
        let output = key("output", output(), Need::Default("{}"), "what is written besides the results");
        let (before, after) = COMMON.split_at(5);
        let common = before.iter().chain([&stages()]).chain(after).copied().collect::<Vec<_>>();
        common.into_iter().chain(kinds_with_tables().map(table)).chain([output]).collect()
    });
    &KEYS
}

/// The key `stages`, with the registered load kinds.
fn stages() -> Parameter {
    let list = Shape::List { of: load_shape(), min: 0, max: usize::MAX };
    let mut keys = STAGE.to_vec();
    keys.insert(2, key("loads", list, Need::Default("[]"), "loads, multiplied by the stage's factor"));
    // Made once, from a registry that lives as long as the program.
    let stage: &'static Shape = Box::leak(Box::new(Shape::Table(Vec::leak(keys))));
    let list = Shape::List { of: stage, min: 1, max: usize::MAX };
    key("stages", list, Need::Required, "stages of loading, [[stages]], in order")
}

/// Keys that every study has, but for `stages`, which stand after the fifth.
static COMMON: &[Parameter] = &[
    key("name", Shape::Text, Need::Required, "name of the study"),
    key("kind", Shape::Text, Need::Default("\"run\""), "what is done with the cases"),
    key("scene", Shape::Plugin(PluginKind::Scene), Need::Required, "the geometry"),
    key("materials", Shape::Map(&MATERIAL), Need::Required, "materials of blocks by name"),
    key("joints", Shape::Map(&LAW), Need::Default("{}"), "laws of joints by name"),
    key(
        "solver",
        Shape::Plugin(PluginKind::LimitSolver),
        Need::Default("{ solver = \"auto\" }"),
        "how the cases are answered",
    ),
    key(
        "vehicles",
        Shape::Map(&VEHICLE),
        Need::Optional("no vehicles"),
        "vehicles by name, for loads of kind \"vehicle\"",
    ),
    key(
        "factors",
        FACTORS,
        Need::Optional("all are 1"),
        "partial factors on weights, loads and strengths; the values given elsewhere are characteristic ones",
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
];
