//! Outputs of plug-ins: `outputs.csv`, and a table of the report.

use super::csv_table::csv_row;
use super::page::{self, figure};
use super::register::register;
use super::writer::{CaseTable, Writer};
use crate::figures::sweep::output_charts;
use crate::output::StudyOutput;
use crate::output::columns::Cell;
use maud::{Markup, html};
use serde_json::Value as Json;
use std::io::{self, Write};
use voussoir_core::model::Assembly;
use voussoir_core::plugin::OutputOf;
use voussoir_study::results::format::format_short;
use voussoir_study::results::{CaseResult, OutputEntry};

/// Greatest number of rows in the report's table.
const ROWS: usize = 400;

/// The columns.
pub(crate) const HEADER: [&str; 11] =
    ["id", "variant", "plugin", "output", "unit", "of", "joint", "block", "x [m]", "y [m]", "value"];

/// Writes `outputs.csv`.
#[derive(Debug)]
pub struct Outputs;

impl Writer for Outputs {
    fn table<'a>(&self, study: &StudyOutput<'a>, _options: &Json) -> Option<Box<dyn CaseTable + 'a>> {
        (!study.totals.outputs.is_empty()).then(|| Box::new(Rows) as Box<dyn CaseTable>)
    }
}

/// One row for each value of each output.
struct Rows;

impl CaseTable for Rows {
    fn name(&self) -> String {
        "outputs.csv".into()
    }

    fn begin(&mut self, out: &mut dyn Write) -> io::Result<()> {
        out.write_all(&csv_row(HEADER.into_iter().map(String::from)))
    }

    fn add(&mut self, case: &CaseResult, out: &mut dyn Write) -> io::Result<()> {
        let values = case.outputs.iter().flat_map(|entry| (0..entry.values.len()).map(move |index| (entry, index)));
        values.into_iter().try_for_each(|(entry, index)| out.write_all(&csv_row(row(case, entry, index).into_iter())))
    }
}

fn row(case: &CaseResult, entry: &OutputEntry, index: usize) -> Vec<String> {
    let place = entry.places.get(index).map_or(String::new(), usize::to_string);
    let [joint, block] = if entry.is_of_blocks() { [String::new(), place] } else { [place, String::new()] };
    let position = entry.positions.get(index);
    let number = |value: Option<f64>| Cell::Number(value).text();
    vec![
        case.label.id.to_string(),
        case.label.variant.clone().unwrap_or_default(),
        entry.plugin.clone(),
        entry.name.clone(),
        entry.unit.clone(),
        entry.of.word().into(),
        joint,
        block,
        number(position.map(|own| own[0])),
        number(position.map(|own| own[1])),
        number(entry.values[index]),
    ]
}

/// The place of a value in words.
fn place_words(assembly: Option<&Assembly>, entry: &OutputEntry, index: usize) -> String {
    let Some(&place) = entry.places.get(index) else { return "the case".into() };
    let name = |block: usize| assembly.and_then(|own| own.bodies.get(block)).map_or("", |body| body.name.as_str());
    let mut words = if entry.is_of_blocks() {
        format!("block {}", name(place))
    } else {
        let joint = assembly.and_then(|own| own.joints.get(place));
        let between = joint.map_or(String::new(), |own| format!(" ({} – {})", name(own.minus), name(own.plus)));
        format!("joint {place}{between}")
    };
    if let (OutputOf::Point, Some([x, y])) = (entry.of, entry.positions.get(index)) {
        words += &format!(", at ({}, {}) m", format_short(*x, 4), format_short(*y, 4));
    }
    words
}

/// The charts and the table of the report; empty if no plug-in has outputs.
pub(super) fn section(study: &StudyOutput) -> Markup {
    let count = study.results.cases.iter().map(|case| case.outputs.len()).sum::<usize>();
    if count == 0 {
        return html! {};
    }
    let header = ["case", "plug-in", "output", "unit", "meaning", "of", "greatest", "where"];
    let entries = study.results.cases.iter().enumerate();
    let entries = entries.flat_map(|(place, case)| case.outputs.iter().map(move |entry| (place, case, entry)));
    let rows = entries.take(ROWS).map(|(place, case, entry)| {
        let greatest = entry.greatest();
        let value = greatest.and_then(|index| entry.values[index]);
        let assembly = study.scene(place).map(|(assembly, _)| assembly);
        vec![
            case.label.id.to_string(),
            entry.plugin.clone(),
            entry.name.replace('_', " "),
            entry.unit.clone(),
            entry.declaration().map_or(String::new(), |own| own.doc.into()),
            entry.of.word().into(),
            value.map_or("–".into(), |value| format_short(value, 6)),
            greatest.map_or(String::new(), |index| place_words(assembly, entry, index)),
        ]
    });
    let of_solvers = study.results.cases.iter().flat_map(|case| &case.outputs).any(|entry| !entry.is_of_law());
    html! {
        h2 { "Outputs of plug-ins" }
        p {
            "Quantities that plug-ins declare, at the state of the stored forces. Verification computes outputs of laws again from this \
             state." @if of_solvers { " No check proves outputs of solvers." }
        }
        (page::table(&header.map(String::from), rows))
        @if count > ROWS { p { "The first " (ROWS) " of " (count) " outputs; all values are in outputs.csv." } }
        @if study.output.figures.anything() {
            @for (name, chart) in output_charts(study) { (figure(&chart, &format!("The output {name} of each case."))) }
        }
    }
}

register!(
    "outputs_csv",
    Outputs,
    "outputs.csv: outputs that plug-ins declare on their cards, value by value",
    "# `outputs_csv`\n\nWrites `outputs.csv` if a plug-in of a case declares outputs: one row for each value, with its joint or block \
     and, for points, its position. Outputs of cases are also columns of `results.csv`, outputs of joints columns of `joints.csv`. An \
     empty value is not finite.\n"
);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::writers::joints_csv;
    use voussoir_core::plugin::{Card, FIXED_COLUMNS, Output, PluginKind};
    use voussoir_study::study::SweptKeys;

    /// The audit of cards refuses outputs with the name of a fixed column. Its list has all of them.
    #[test]
    fn the_fixed_columns_are_those_of_the_core() {
        let keys = SweptKeys::default();
        let labels =
            crate::output::columns::Labels { swept: &[], keys: &keys, variants: true, scenes: true, outputs: &[] };
        let names: Vec<String> = labels.with_results().into_iter().map(|column| column.name).collect();
        let files = joints_csv::HEADER.iter().chain(&HEADER).map(|header| header.split(" [").next().unwrap_or(header));
        for name in names.iter().map(String::as_str).chain(files) {
            assert!(FIXED_COLUMNS.contains(&name), "{name} is missing in FIXED_COLUMNS");
        }
    }

    #[test]
    fn a_value_has_its_place_in_its_row() {
        const OUTPUT: Output = Output::point("damage", "-", "damage");
        let card = Card { kind: PluginKind::BulkMaterial, tag: "own", ..Card::BLANK };
        let (places, positions, values) = (vec![2, 3], vec![[0.5, 1.0], [1.5, 1.0]], vec![Some(0.25), None]);
        let entry = OutputEntry { places, positions, values, ..OutputEntry::new(&card, &OUTPUT) };
        let case = CaseResult::empty();
        assert_eq!(row(&case, &entry, 0).join(","), "0,,own,damage,-,point,,2,0.5,1,0.25");
        assert_eq!(row(&case, &entry, 1).join(","), "0,,own,damage,-,point,,3,1.5,1,");
        assert_eq!(place_words(None, &entry, 1), "block , at (1.5, 1) m");
    }
}
