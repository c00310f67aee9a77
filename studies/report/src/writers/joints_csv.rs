//! Loads that are carried: `joints.csv` with the forces of all joints, and a section of the report.

use super::csv_table::csv_row;
use super::page;
use super::register::register;
use super::writer::{CaseTable, Writer};
use crate::output::StudyOutput;
use crate::output::columns::Cell;
use maud::{Markup, html};
use serde_json::Value as Json;
use std::io::{self, Write};
use voussoir_core::plugin::OutputOf;
use voussoir_study::results::carried::{BlockEntry, JointEntry, PermissibleEntry, ReserveEntry, ReserveFlow};
use voussoir_study::results::format::{capitalised, format_force, format_number, status_word};
use voussoir_study::results::{CaseResult, OutputColumn};

/// Greatest number of joints of a case in the report; the file contains all.
const ROWS: usize = 400;
/// Greatest number of cases whose joints are in the report.
const CASES: usize = 10;

/// The columns without outputs.
pub(crate) const HEADER: [&str; 17] = [
    "id",
    "variant",
    "joint",
    "minus",
    "plus",
    "normal [N]",
    "shear [N]",
    "moment [N m]",
    "eccentricity [m]",
    "contact_length [m]",
    "greatest_stress [Pa]",
    "block_length [m]",
    "block_stress [Pa]",
    "strength [Pa]",
    "sliding_reserve",
    "zone_least [m]",
    "zone_greatest [m]",
];

/// Writes `joints.csv`.
#[derive(Debug)]
pub struct Joints;

impl Writer for Joints {
    fn table<'a>(&self, study: &StudyOutput<'a>, _options: &Json) -> Option<Box<dyn CaseTable + 'a>> {
        let outputs = study.totals.outputs.iter().filter(|output| output.of == OutputOf::Joint).cloned();
        study.totals.joints.then(|| Box::new(Rows(outputs.collect())) as Box<dyn CaseTable>)
    }
}

/// One row for each joint of each case, with the outputs of joints.
struct Rows(Vec<OutputColumn>);

impl CaseTable for Rows {
    fn name(&self) -> String {
        "joints.csv".into()
    }

    fn begin(&mut self, out: &mut dyn Write) -> io::Result<()> {
        let outputs = self.0.iter().map(|output| format!("{} [{}]", output.name_among(&self.0), output.unit));
        let header = HEADER.into_iter().map(String::from).chain(outputs);
        out.write_all(&csv_row(header))
    }

    fn add(&mut self, case: &CaseResult, out: &mut dyn Write) -> io::Result<()> {
        case.carried.joints.iter().try_for_each(|entry| {
            let value = |output: &OutputColumn| Cell::Number(output.value(&case.outputs, Some(entry.joint))).text();
            let outputs: Vec<String> = self.0.iter().map(value).collect();
            out.write_all(&csv_row(row(case, entry).into_iter().chain(outputs)))
        })
    }
}

fn row(case: &CaseResult, entry: &JointEntry) -> Vec<String> {
    let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
    let block = |part: fn(&BlockEntry) -> f64| number(entry.block.as_ref().map(part));
    let [minus, plus] = entry.between.clone();
    vec![
        case.label.id.to_string(),
        case.label.variant.clone().unwrap_or_default(),
        entry.joint.to_string(),
        minus,
        plus,
        entry.normal.to_string(),
        entry.shear.to_string(),
        entry.moment.to_string(),
        number(entry.eccentricity),
        entry.contact_length.to_string(),
        number(entry.greatest_stress),
        block(|block| block.length),
        block(|block| block.stress),
        block(|block| block.strength),
        number(entry.sliding_reserve),
        number(entry.zone.map(|zone| zone[0])),
        number(entry.zone.map(|zone| zone[1])),
    ]
}

/// The reserve in a sentence.
fn reserve_words(reserve: &ReserveEntry) -> String {
    let flow = match reserve.flow {
        ReserveFlow::Associated => "associated flow, as the laws have it",
        ReserveFlow::ReadAsAssociated => "read with associated flow: an upper bound, because a law slides otherwise",
    };
    let carried = format!("carried factor {}", format_number(reserve.target, 6));
    match reserve.factor {
        Some(factor) => {
            let end = |end: Option<f64>| end.map_or("–".into(), |end| format_number(end, 6));
            let [lower, upper] = reserve.bounds.unwrap_or_default().map(end);
            format!("{carried}; collapse at factor {} (bounds {lower} to {upper}; {flow})", format_number(factor, 6))
        }
        None => format!("{carried}; search for collapse: {} ({flow})", status_word(reserve.status)),
    }
}

/// The check of the permissible limit state in a sentence.
fn permissible_words(check: &PermissibleEntry) -> String {
    let verdict = match check.holds {
        Some(true) => "fulfilled",
        Some(false) => "not fulfilled",
        None => "not proved",
    };
    format!(
        "permissible limit state {verdict}: the load uses {:.1} % of the collapse load; {}",
        100.0 * check.used,
        check.rule
    )
}

/// Describes a load that is carried: reserve, permissible limit state, the joints with the greatest stress and with the
/// least sliding reserve.
pub(super) fn carried_lines(case: &CaseResult) -> Vec<String> {
    let carried = &case.carried;
    let mut lines: Vec<String> = carried.reserve.iter().map(reserve_words).collect();
    lines.extend(carried.permissible.iter().map(permissible_words));
    let name = |entry: &JointEntry| format!("joint {} ({})", entry.joint, entry.between.join(" – "));
    let stressed = carried.joints.iter().filter_map(|entry| Some((entry.greatest_stress?, entry)));
    if let Some((stress, entry)) = stressed.max_by(|a, b| a.0.total_cmp(&b.0)) {
        lines.push(format!("greatest stress {} at {}", format_stress(stress), name(entry)));
    }
    let sliding = carried.joints.iter().filter_map(|entry| Some((entry.sliding_reserve?, entry)));
    if let Some((reserve, entry)) = sliding.min_by(|a, b| a.0.total_cmp(&b.0)) {
        lines.push(format!("least sliding reserve {} at {}", format_number(reserve, 4), name(entry)));
    }
    lines
}

/// The same lines as sentences of one paragraph.
pub(super) fn carried_sentences(case: &CaseResult) -> String {
    let sentences: Vec<String> = carried_lines(case).iter().map(|line| format!("{}.", capitalised(line))).collect();
    sentences.join(" ")
}

fn format_stress(pascals: f64) -> String {
    format!("{} kPa", format_number(pascals / 1e3, 4))
}

/// The section of the report; empty if no case has a load that is carried.
pub(super) fn section(study: &StudyOutput) -> Markup {
    let carried: Vec<&CaseResult> = study.results.cases.iter().filter(|case| !case.carried.is_empty()).collect();
    html! {
        @if !carried.is_empty() {
            h2 { "Loads that are carried" }
            p {
                "N presses if it is positive. V acts on the second block, from end 0 to end 1 of the joint. The eccentricity e = M/N \
                 is positive towards end 1, on arches the extrados. Contact length and stress belong to a linear pressure without \
                 tension. The zone of thrust is the interval of e over all admissible fields."
            }
            @for case in carried.iter().take(CASES) {
                h3 { "Case " (case.label.id) }
                // The answer to a single case already contains them.
                @if study.totals.cases > 1 { p { (carried_sentences(case)) } }
                (joints(&case.carried.joints))
            }
            @if carried.len() > CASES { p { "The first " (CASES) " of " (carried.len()) " cases; all are in joints.csv." } }
        }
    }
}

fn joints(entries: &[JointEntry]) -> Markup {
    if entries.is_empty() {
        return html! {};
    }
    let crushes = entries.iter().any(|entry| entry.block.is_some());
    let zones = entries.iter().any(|entry| entry.zone.is_some());
    let mut header = vec!["joint", "between", "N", "V", "M", "e", "contact length", "greatest stress"];
    header.extend(if crushes { &["block length", "block stress", "of strength"][..] } else { &[] });
    header.push("sliding reserve");
    header.extend(zones.then_some("zone of thrust"));
    // One unit for all values, so that columns can be compared.
    let metres = |x: f64| format!("{} m", format_number(x, 3));
    let length = |x: Option<f64>| x.map_or("–".into(), metres);
    let stress = |x: Option<f64>| x.map_or("–".into(), format_stress);
    let rows = entries.iter().take(ROWS).map(|entry| {
        let mut cells = vec![
            entry.joint.to_string(),
            entry.between.join(" – "),
            format_force(entry.normal),
            format_force(entry.shear),
            format!("{} m", format_force(entry.moment)),
            length(entry.eccentricity),
            metres(entry.contact_length),
            stress(entry.greatest_stress),
        ];
        if crushes {
            let share = entry.block.map(|block| format!("{:.1} %", 100.0 * block.stress / block.strength));
            cells.extend([
                length(entry.block.map(|block| block.length)),
                stress(entry.block.map(|block| block.stress)),
                share.unwrap_or("–".into()),
            ]);
        }
        cells.push(entry.sliding_reserve.map_or("–".into(), |x| format_number(x, 4)));
        if zones {
            cells.push(entry.zone.map_or("–".into(), |[a, b]| format!("{} to {}", metres(a), metres(b))));
        }
        cells
    });
    let header: Vec<String> = header.into_iter().map(String::from).collect();
    html! {
        (page::table(&header, rows))
        @if entries.len() > ROWS { p { "The first " (ROWS) " of " (entries.len()) " joints; all are in joints.csv." } }
    }
}

register!(
    "joints_csv",
    Joints,
    "joints.csv: forces, stresses and zones of thrust of joints under loads that are carried",
    "# `joints_csv`\n\nWrites `joints.csv` if a case carries its loads: one row for each case and joint, with N, V, M, eccentricity, contact \
     length, stresses, sliding reserve and zone of thrust, and the outputs of joints that plug-ins declare.\n"
);
