//! The table that is printed on the terminal.

use super::joints_csv::carried_lines;
use crate::figures::hinges::hinge_list;
use crate::output::StudyOutput;
use crate::output::columns::{CellKind, Column};
use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use std::collections::HashMap;
use voussoir_core::limit::Status;
use voussoir_study::results::CaseResult;
use voussoir_study::results::format::{
    format_number, format_short, kind_word, open_bounds, proved_interval, snap_words, status_word,
};

/// One row for each case, then each distinct note once with the ids of its cases.
pub fn results_table(study: &StudyOutput) -> String {
    let cases = &study.results.cases;
    let labels = study.page_labels().columns();
    let mut header: Vec<String> = labels.iter().map(Column::header).collect();
    header.extend(["status", "load factor", "kind", "hinges", "certificate", "notes"].map(String::from));
    let mut table = Table::new();
    table.load_style(presets::NOTHING).set_content_arrangement(ContentArrangement::Disabled).set_header(header);
    let notes = distinct_notes(cases);
    let mut marks: HashMap<usize, String> = HashMap::new();
    for (i, (_, ids)) in notes.iter().enumerate() {
        let mark = format!("[{}]", i + 1);
        for id in ids {
            let own = marks.entry(*id).or_default();
            // A case may have the same note twice.
            if !own.ends_with(&mark) {
                *own += &mark;
            }
        }
    }
    let factors = aligned(&cases.iter().map(factor).collect::<Vec<_>>());
    let cells = |column: &Column| {
        let cells: Vec<String> = cases.iter().map(|case| column.words(case)).collect();
        if column.is_swept() { aligned(&cells) } else { cells }
    };
    let label_cells: Vec<Vec<String>> = labels.iter().map(cells).collect();
    for (place, case) in cases.iter().enumerate() {
        let mut row: Vec<String> = label_cells.iter().map(|column| column[place].clone()).collect();
        row.push(status_word(case.status).into());
        row.push(factors[place].clone());
        row.push(case.mechanism.as_ref().map_or(String::new(), |m| kind_word(m.kind).into()));
        row.push(hinges(case));
        row.push(certificate(case).into());
        row.push(marks.get(&case.label.id).cloned().unwrap_or_default());
        table.add_row(row);
    }
    for (index, column) in table.column_iter_mut().enumerate() {
        let number = match labels.get(index) {
            Some(label) => label.kind == CellKind::Whole || label.is_swept(),
            None => index == labels.len() + 1,
        };
        column.set_cell_alignment(if number { CellAlignment::Right } else { CellAlignment::Left });
    }
    let mut text: String = table.to_string().lines().map(|line| line.trim_end().to_string() + "\n").collect();
    for (i, (note, ids)) in notes.iter().enumerate() {
        text.push_str(&format!("[{}] {note} ({})\n", i + 1, id_list(ids, cases.len())));
    }
    if let [case] = cases.as_slice() {
        carried_lines(case).iter().for_each(|line| text.push_str(&format!("{line}\n")));
    }
    text
}

/// The verdict of the certificate. For an open result only the bounds are proved.
fn certificate(case: &CaseResult) -> &'static str {
    match (case.certificate.passed, case.status) {
        (true, _) => "ok",
        (false, Status::Open) => "bounds",
        (false, _) => "FAILED",
    }
}

fn factor(case: &CaseResult) -> String {
    match (case.status, case.load_factor) {
        (Status::Unbounded, _) => "unbounded".into(),
        (Status::Open, _) => {
            let interval = proved_interval(case).unwrap_or_else(|| "-".into());
            let snaps = case.snaps_from().map(|first| format!("; snaps from {}", format_number(first, 7)));
            interval + &snaps.unwrap_or_default()
        }
        (_, Some(factor)) => match open_bounds(case) {
            Some([proved, _]) => format!("≥ {} (found {})", format_short(proved, 4), format_number(factor, 7)),
            None => snap_words(case.load_factor, case.path.first_limit_point, |x| format_number(x, 7))
                .unwrap_or_else(|| format_number(factor, 7)),
        },
        (_, None) => "-".into(),
    }
}

fn hinges(case: &CaseResult) -> String {
    let Some(mechanism) = &case.mechanism else { return String::new() };
    let joints = hinge_list(mechanism);
    if joints.len() > 8 { format!("{} joints", joints.len()) } else { joints.join(" ") }
}

/// Pads numbers on the right so that their decimal points are aligned in a right-aligned column.
fn aligned(cells: &[String]) -> Vec<String> {
    let decimals = |cell: &str| cell.find('.').map_or(0, |dot| cell.len() - dot);
    let is_number = |cell: &str| cell.parse::<f64>().is_ok();
    let longest = cells.iter().filter(|cell| is_number(cell)).map(|cell| decimals(cell)).max().unwrap_or(0);
    let pad = |cell: &String| {
        if is_number(cell) { format!("{cell}{}", " ".repeat(longest - decimals(cell))) } else { cell.clone() }
    };
    cells.iter().map(pad).collect()
}

/// Each distinct note with the ids of its cases, in order of appearance.
pub(super) fn distinct_notes(cases: &[CaseResult]) -> Vec<(String, Vec<usize>)> {
    let mut notes: Vec<(String, Vec<usize>)> = Vec::new();
    for case in cases {
        for note in case.notes.iter().chain(&case.certificate.failures) {
            match notes.iter_mut().find(|(text, _)| text == note) {
                Some((_, ids)) => ids.push(case.label.id),
                None => notes.push((note.clone(), vec![case.label.id])),
            }
        }
    }
    notes
}

/// `case 3`, `cases 0-4, 7`, `all cases`.
pub(super) fn id_list(ids: &[usize], count: usize) -> String {
    if ids.len() == count && count > 1 {
        return "all cases".into();
    }
    let mut ranges: Vec<(usize, usize)> = Vec::new();
    for &id in ids {
        match ranges.last_mut() {
            Some((_, last)) if *last == id || *last + 1 == id => *last = id,
            _ => ranges.push((id, id)),
        }
    }
    let words = ranges.iter().map(|(a, b)| if a == b { a.to_string() } else { format!("{a}-{b}") });
    format!("{} {}", if ids.len() == 1 { "case" } else { "cases" }, words.collect::<Vec<_>>().join(", "))
}
