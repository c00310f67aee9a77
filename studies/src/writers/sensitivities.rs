//! Derivatives of load factors: `sensitivities.csv`, and a table of the report.

use super::csv_table::csv_table;
use super::page;
use super::register::register;
use super::study_output::StudyOutput;
use super::writer::Writer;
use crate::figures::format::{format_number, format_short, unit_of_key};
use crate::figures::words::title_of_key;
use crate::results::{CaseResult, SensitivityEntry};
use serde_json::Value as Json;

/// Rows of the report's table.
const ROWS: usize = 400;

/// Writes `sensitivities.csv`.
#[derive(Debug)]
pub struct Sensitivities;

impl Writer for Sensitivities {
    fn files(&self, study: &StudyOutput, _options: &Json) -> Vec<(String, Vec<u8>)> {
        let rows: Vec<Vec<String>> = entries(&study.results.cases).map(|(case, entry)| row(case, entry)).collect();
        if rows.is_empty() {
            return Vec::new();
        }
        let header = ["id", "variant", "key", "unit", "value", "left [1/unit]", "right [1/unit]", "kink", "why"];
        vec![("sensitivities.csv".into(), csv_table(header.map(String::from).into(), rows.into_iter()).into_bytes())]
    }
}

fn entries(cases: &[CaseResult]) -> impl Iterator<Item = (&CaseResult, &SensitivityEntry)> {
    cases.iter().flat_map(|case| case.sensitivities.iter().map(move |entry| (case, entry)))
}

fn row(case: &CaseResult, entry: &SensitivityEntry) -> Vec<String> {
    let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    vec![
        case.label.id.to_string(),
        case.label.variant.clone().unwrap_or_default(),
        entry.key.clone(),
        unit_of_key(&entry.key).unwrap_or_default().into(),
        entry.value.to_string(),
        number(entry.left),
        number(entry.right),
        entry.kink.to_string(),
        entry.why.clone().unwrap_or_default(),
    ]
}

/// The report's table; empty where no case has any.
pub(super) fn table(cases: &[CaseResult]) -> String {
    let count = entries(cases).count();
    if count == 0 {
        return String::new();
    }
    let header =
        ["id", "number", "value", "per unit, falling", "per unit, growing", "% of the factor per 1 % of it", "", "key"];
    let rows = entries(cases).take(ROWS).map(|(case, entry)| {
        let slope = |x: Option<f64>| x.map_or("–".into(), |x| format_number(x, 6));
        let relative = entry.relative(case.load_factor.unwrap_or(f64::NAN));
        let share = |x: f64| format!("{x:+.3}");
        let shares = match relative {
            [Some(left), Some(right)] if entry.kink => format!("{} falling, {} growing", share(left), share(right)),
            [_, Some(slope)] | [Some(slope), None] => share(slope),
            [None, None] => String::new(),
        };
        let words = match &entry.why {
            Some(why) => why.clone(),
            None if entry.kink => "kink: the two differ".into(),
            None => String::new(),
        };
        let value = format_short(entry.value, 7);
        vec![
            case.label.id.to_string(),
            title_of_key(&entry.key),
            value,
            slope(entry.left),
            slope(entry.right),
            shares,
            words,
            entry.key.clone(),
        ]
    });
    let more = if count > ROWS {
        format!("<p>The first {ROWS} of {count} rows; all are in sensitivities.csv.</p>\n")
    } else {
        String::new()
    };
    format!(
        "<h2>Sensitivities</h2>\n<p>How the load factor changes with each number, from the optimal field and mechanism: its \
         derivatives where the number falls and where it grows. Numbers that it does not depend on are left out.</p>\n{}{more}",
        page::table(&header.map(String::from), rows)
    )
}

register!(
    "sensitivities_csv",
    Sensitivities,
    "sensitivities.csv: derivatives of load factors, where [output] asks for sensitivities",
    "# `sensitivities_csv`\n\nWrites `sensitivities.csv` where `[output] sensitivities = true`: one row for each case and number of \
     its study that the load factor of limit analysis depends on, with the derivatives on both sides.\n"
);
