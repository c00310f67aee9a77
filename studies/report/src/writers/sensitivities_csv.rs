//! Derivatives of load factors: `sensitivities.csv`, and a table of the report.

use super::csv_table::csv_row;
use super::page;
use super::register::register;
use super::writer::{CaseTable, Writer};
use crate::output::StudyOutput;
use maud::{Markup, html};
use serde_json::Value as Json;
use std::io::{self, Write};
use voussoir_study::config::key_meaning::KeyMeaning;
use voussoir_study::results::format::{format_number, format_short};
use voussoir_study::results::{CaseResult, SensitivityEntry};
use voussoir_study::study::{Study, meaning_in};

/// Greatest number of rows in the report's table.
const ROWS: usize = 400;

/// Writes `sensitivities.csv`.
#[derive(Debug)]
pub struct Sensitivities;

impl Writer for Sensitivities {
    fn table<'a>(&self, study: &StudyOutput<'a>, _options: &Json) -> Option<Box<dyn CaseTable + 'a>> {
        let study = study.inputs.filter(|_| study.totals.sensitivities)?;
        Some(Box::new(Rows(study)))
    }
}

/// The study, which defines the units of keys.
struct Rows<'a>(&'a Study);

impl CaseTable for Rows<'_> {
    fn name(&self) -> String {
        "sensitivities.csv".into()
    }

    fn begin(&mut self, out: &mut dyn Write) -> io::Result<()> {
        let header = ["id", "variant", "key", "unit", "value", "left [1/unit]", "right [1/unit]", "kink", "why"];
        out.write_all(&csv_row(header.into_iter().map(String::from)))
    }

    fn add(&mut self, case: &CaseResult, out: &mut dyn Write) -> io::Result<()> {
        let Some(own) = self.0.case_of(&case.label).filter(|_| !case.sensitivities.is_empty()) else { return Ok(()) };
        case.sensitivities.iter().try_for_each(|entry| {
            let meaning = meaning_in(&own.resolved, &entry.key);
            out.write_all(&csv_row(row(&Entry { case, own: entry, meaning }).into_iter()))
        })
    }
}

/// A derivative with its case and the meaning of its key in this case.
struct Entry<'a> {
    case: &'a CaseResult,
    own: &'a SensitivityEntry,
    meaning: Option<KeyMeaning>,
}

fn entries<'a>(study: &'a StudyOutput) -> impl Iterator<Item = Entry<'a>> {
    study.results.cases.iter().zip(&study.scenes).flat_map(|(case, scene)| {
        let entry = |own| Entry { case, own, meaning: meaning_in(scene.resolved, &own.key) };
        case.sensitivities.iter().map(entry)
    })
}

fn row(Entry { case, own: entry, meaning }: &Entry) -> Vec<String> {
    let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    vec![
        case.label.id.to_string(),
        case.label.variant.clone().unwrap_or_default(),
        entry.key.clone(),
        meaning.as_ref().and_then(KeyMeaning::unit).unwrap_or_default().into(),
        entry.value.to_string(),
        number(entry.left),
        number(entry.right),
        entry.kink.to_string(),
        entry.why.clone().unwrap_or_default(),
    ]
}

/// The table of the report; empty if no case has derivatives.
pub(super) fn table(study: &StudyOutput) -> Markup {
    let count = study.results.cases.iter().map(|case| case.sensitivities.len()).sum::<usize>();
    if count == 0 {
        return html! {};
    }
    let header =
        ["id", "number", "value", "per unit, falling", "per unit, growing", "% of the factor per 1 % of it", "", "key"];
    let rows = entries(study).take(ROWS).map(|Entry { case, own: entry, meaning }| {
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
            meaning.map_or(entry.key.clone(), |meaning| meaning.title()),
            value,
            slope(entry.left),
            slope(entry.right),
            shares,
            words,
            entry.key.clone(),
        ]
    });
    html! {
        h2 { "Sensitivities" }
        p {
            "How the load factor changes with each number, from the optimal field and mechanism: its derivatives where the number \
             falls and where it grows. Numbers that it does not depend on are left out."
        }
        (page::table(&header.map(String::from), rows))
        @if count > ROWS { p { "The first " (ROWS) " of " (count) " rows; all are in sensitivities.csv." } }
    }
}

register!(
    "sensitivities_csv",
    Sensitivities,
    "sensitivities.csv: derivatives of load factors, if [output] requests them",
    "# `sensitivities_csv`\n\nWrites `sensitivities.csv` where `[output] sensitivities = true`: one row for each case and number of \
     its study that the load factor of limit analysis depends on, with the derivatives on both sides.\n"
);
