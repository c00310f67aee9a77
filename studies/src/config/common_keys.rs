//! Keys and words that every plug-in of a kind takes besides those of its card.

use voussoir_core::plugin::{Need, Parameter, PluginKind, Quantity, Range, Shape};

const fn key(name: &'static str, shape: Shape, need: Need, doc: &'static str) -> Parameter {
    Parameter { name, doc, shape, need }
}

/// How far to go after a peak.
pub static STOP: Shape = Shape::Table(&[
    Parameter::number("displacement", Quantity::Length, Range::POSITIVE, "displacement of the load point after a peak")
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
        "relative tolerance of loads: of certificates, and of the states that path solvers accept",
    )
    .default("1e-9"),
    key("stop", STOP, Need::Optional("the path ends at collapse"), "how far to go after a peak"),
];

/// Keys that every plug-in of a kind has besides those of its card.
pub fn common_parameters(kind: PluginKind) -> &'static [Parameter] {
    if kind == PluginKind::LimitSolver { SOLVER } else { &[] }
}

/// What a kind is called in messages: limit and path solvers share one place.
pub fn word_for(kind: PluginKind) -> &'static str {
    if kind == PluginKind::LimitSolver { "solver" } else { kind.describe() }
}

/// Words that the tag may be besides the registered tags.
pub fn common_words(kind: PluginKind) -> &'static [&'static str] {
    if kind == PluginKind::LimitSolver { &["auto"] } else { &[] }
}
