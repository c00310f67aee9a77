//! `results.csv`: one row per case, units in the names of columns.

use super::csv_table::csv_table;
use super::register::register;
use super::study_output::StudyOutput;
use super::writer::Writer;
use crate::figures::format::{continuation_word, format_value, kind_word, status_word};
use crate::results::CaseResult;
use serde_json::Value as Json;

/// Writes `results.csv`.
#[derive(Debug)]
pub struct ResultsCsv;

impl Writer for ResultsCsv {
    fn files(&self, study: &StudyOutput, _options: &Json) -> Vec<(String, Vec<u8>)> {
        vec![("results.csv".into(), results_csv(study).into_bytes())]
    }
}

const BEFORE: [&str; 2] = ["id", "variant"];
const AFTER: [&str; 19] = [
    "status",
    "load_factor [-]",
    "first_limit_point [-]",
    "continuation",
    "lower_bound [-]",
    "upper_bound [-]",
    "associated_load_factor [-]",
    "kind",
    "hinge_count",
    "hinge_joints",
    "sliding_joints",
    "crushing_joints",
    "unique",
    "flow_read_as",
    "certificate_passed",
    "largest_residual [-]",
    "solver",
    "seconds [s]",
    "notes",
];

/// The table of a study: a cell is empty where a case has no such value; lists are separated by
/// blanks, notes by ` | `.
pub fn results_csv(study: &StudyOutput) -> String {
    let scenes = study.results.cases.iter().any(|case| case.label.scene.is_some());
    let rows = study.results.cases.iter().map(|case| row(case, scenes, &study.sweep_keys));
    csv_table(header(study.sweep_columns(), scenes), rows)
}

/// Names of the columns. `keys` are the columns of the swept keys; `scenes` adds one for the compared scenes.
pub(super) fn header(keys: impl Iterator<Item = String>, scenes: bool) -> Vec<String> {
    let before = BEFORE.iter().copied().chain(scenes.then_some("scene"));
    before.map(|s| s.to_string()).chain(keys).chain(AFTER.iter().map(|s| s.to_string())).collect()
}

/// The row of a case under that header.
pub(super) fn row(case: &CaseResult, scenes: bool, keys: &[String]) -> Vec<String> {
    let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    let joints = |list: Vec<usize>| list.iter().map(usize::to_string).collect::<Vec<_>>().join(" ");
    let mechanism = case.mechanism.as_ref();
    let residual = case.certificate.residuals.values().copied().fold(f64::NAN, f64::max);
    let mut row = vec![case.label.id.to_string(), case.label.variant.clone().unwrap_or_default()];
    row.extend(scenes.then(|| case.label.scene.clone().unwrap_or_default()));
    row.extend(keys.iter().map(|key| case.label.parameters.get(key).map(format_value).unwrap_or_default()));
    row.extend([
        status_word(case.status).to_string(),
        number(case.load_factor),
        number(case.path.first_limit_point),
        case.path.continuation.map_or(String::new(), |end| continuation_word(end).into()),
        number(case.bounds.and_then(|bounds| bounds[0])),
        number(case.bounds.and_then(|bounds| bounds[1])),
        number(case.non_associated.associated_load_factor),
        mechanism.map_or(String::new(), |m| kind_word(m.kind).into()),
        mechanism.map_or(String::new(), |m| m.hinge_count.to_string()),
        mechanism.map_or(String::new(), |m| joints(m.hinges.iter().map(|h| h.joint).collect())),
        mechanism.map_or(String::new(), |m| joints(m.sliding.iter().map(|s| s.joint).collect())),
        mechanism.map_or(String::new(), |m| joints(m.crushing.iter().map(|c| c.joint).collect())),
        mechanism.and_then(|m| m.unique).map_or(String::new(), |unique| unique.to_string()),
        case.flow_read_as.clone().unwrap_or_default(),
        case.certificate.passed.to_string(),
        if residual.is_nan() { String::new() } else { format!("{residual:e}") },
        case.solver.clone(),
        case.seconds.to_string(),
        case.notes.join(" | "),
    ]);
    row
}

register!(
    "results_csv",
    ResultsCsv,
    "results.csv: one row per case, units in the column names",
    "# `results_csv`\n\nWrites `results.csv`: one row per case. Empty cells have no value; joints are separated by blanks.\n"
);
