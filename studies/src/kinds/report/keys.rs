//! The keys of a study of studies.

use crate::study::OUTPUT;
use voussoir_core::plugin::{Need, Parameter, Quantity, Range, Shape};

const fn key(name: &'static str, shape: Shape, need: Need, doc: &'static str) -> Parameter {
    Parameter { name, doc, shape, need }
}

const fn text(name: &'static str, need: Need, doc: &'static str) -> Parameter {
    key(name, Shape::Text, need, doc)
}

static WORD: Shape = Shape::Text;
static FREE: Shape = Shape::Free;
static NUMBER: Shape = Shape::Number(Quantity::Ratio, Range::ANY);
static PAIR: Shape = Shape::List { of: &NUMBER, min: 2, max: 2 };

static SERIES: Shape = Shape::Table(&[
    text("study", Need::Optional("points are given"), "name of one of the studies"),
    text("variant", Need::Optional("entries of every variant"), "name of its variant"),
    key(
        "where",
        Shape::Map(&FREE),
        Need::Default("{}"),
        "swept keys, whole or by their last name, with the value that is meant",
    ),
    text("over", Need::Optional("the first swept key that `where` leaves free"), "the key that makes the abscissa"),
    Parameter::number("from", Quantity::Ratio, Range::ANY, "least abscissa").optional("no bound"),
    Parameter::number("to", Quantity::Ratio, Range::ANY, "greatest abscissa").optional("no bound"),
    text("result", Need::Default("\"load_factor\""), "path of a result in an entry: \"mechanism.hinges.*.joint\""),
    text("entries", Need::Default("\"cases\""), "list of results.json that is read: cases, optima, worsts, curve"),
    text("x", Need::Default("\"x\""), "expression of `x`, for charts and tables: \"9.42 / x\""),
    text("y", Need::Default("\"y\""), "expression of `y`, for charts and tables"),
    text("label", Need::Optional("the name of the series"), "words for legends"),
    key(
        "points",
        Shape::List { of: &PAIR, min: 1, max: 1000 },
        Need::Optional("a study is given"),
        "published numbers instead of results: [[x, y], ...]",
    ),
]);

static TEST: Shape = Shape::Table(&[
    text("of", Need::Required, "what is tested: a model, a rise, a settlement"),
    text("value", Need::Required, "expression of series: the number behind the test"),
    text("unit", Need::Default("\"\""), "its unit"),
    text("holds", Need::Required, "condition of `value` and series under which what is claimed is true here"),
]);

static CLAIM: Shape = Shape::Table(&[
    text("id", Need::Required, "number or name of the claim"),
    text("claim", Need::Required, "what is claimed"),
    text("source", Need::Default("\"\""), "where it stands"),
    text("depends_on", Need::Optional("one test"), "what the tests differ in, named where some hold and some do not"),
    text("remark", Need::Default("\"\""), "what a reader should know besides, in Markdown"),
    key("tests", Shape::List { of: &TEST, min: 1, max: 100 }, Need::Required, "what decides, test by test"),
]);

static CHART: Shape = Shape::Table(&[
    text("name", Need::Required, "name: in texts the chart stands where ![caption](chart:NAME) is written"),
    text("title", Need::Required, "its heading"),
    text("x_label", Need::Required, "words and unit of the abscissa"),
    text("y_label", Need::Required, "words and unit of the ordinate"),
    key("series", Shape::List { of: &WORD, min: 1, max: 20 }, Need::Required, "names of series, one line each"),
    key("x_log", Shape::Boolean, Need::Default("false"), "logarithmic abscissa"),
    key("y_log", Shape::Boolean, Need::Default("false"), "logarithmic ordinate"),
    key("modes", Shape::Boolean, Need::Default("false"), "mark where the kind of mechanism changes along a line"),
    key("peaks", Shape::Boolean, Need::Default("false"), "mark the greatest value of each line"),
]);

static TABLE: Shape = Shape::Table(&[
    text("name", Need::Required, "name: in texts the table stands where ![caption](table:NAME) is written"),
    text("x_label", Need::Required, "words and unit of the abscissa, the first column"),
    key("series", Shape::List { of: &WORD, min: 1, max: 20 }, Need::Required, "names of series, a column each"),
]);

/// Keys of `[report]`.
pub static REPORT: &[Parameter] = &[
    text("title", Need::Optional("the study's name"), "heading of the page"),
    key("studies", Shape::List { of: &WORD, min: 1, max: 200 }, Need::Required, "study files, relative to this one"),
    key(
        "text",
        Shape::List { of: &WORD, min: 0, max: 201 },
        Need::Default("[]"),
        "Markdown before each study; one more stands at the end",
    ),
    text("introduction", Need::Default("\"\""), "Markdown at the head of the page"),
    key("series", Shape::Map(&SERIES), Need::Default("{}"), "results that claims, charts and tables speak of, by name"),
    key("claims", Shape::List { of: &CLAIM, min: 0, max: 1000 }, Need::Default("[]"), "[[report.claims]], in order"),
    key("charts", Shape::List { of: &CHART, min: 0, max: 1000 }, Need::Default("[]"), "[[report.charts]]"),
    key("tables", Shape::List { of: &TABLE, min: 0, max: 1000 }, Need::Default("[]"), "[[report.tables]]"),
];

/// The keys of such a study.
pub static STUDY: &[Parameter] = &[
    text("name", Need::Required, "name of the study"),
    key("kind", Shape::Choice(&["report"]), Need::Required, "what is done"),
    key("report", Shape::Table(REPORT), Need::Required, "which studies, and what is said of them"),
    key("output", OUTPUT, Need::Default("{}"), "what is written besides the results"),
];
