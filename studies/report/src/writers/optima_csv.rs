//! The optima of a study that searches for the best value of a key: its first sentence, the table of the terminal and the page, and
//! `optima.csv`.

use super::csv_table::csv_row;
use super::page;
use super::register::register;
use super::writer::Writer;
use crate::figures::hinges::hinge_list;
use crate::output::StudyOutput;
use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use maud::{Markup, html};
use serde_json::Value as Json;
use voussoir_study::results::format::{
    certificate_verdict, format_force, format_number, kind_words, status_word, unit_load,
};
use voussoir_study::results::{CaseResult, IntervalEntry, OptimumEntry, best_of};

/// Writes `optima.csv`.
#[derive(Debug)]
pub struct Optima;

impl Writer for Optima {
    fn files(&self, study: &StudyOutput, _options: &Json) -> Vec<(String, Vec<u8>)> {
        let Some(optima) = &study.results.own.optima else { return Vec::new() };
        let Some(first) = optima.first() else { return Vec::new() };
        let title = |key: &str| format!("{key} [{}]", study.keys.unit(key).unwrap_or_else(|| "-".into()));
        let swept: Vec<&String> = first.parameters.keys().collect();
        let mut header: Vec<String> = vec!["variant".into()];
        header.extend(swept.iter().map(|key| title(key)));
        header.extend(first.keys().into_iter().map(title));
        header.extend([format!("{} [-]", first.optimised), "goal".into(), "status".into(), "case".into()]);
        header.extend(["from", "to", "possible_gain [-]", "tried"].map(String::from));
        let mut bytes = csv_row(header.into_iter());
        let number = |x: Option<f64>| x.map_or(String::new(), |x| x.to_string());
        for own in optima {
            let mut row = vec![own.variant.clone().unwrap_or_default()];
            row.extend(swept.iter().map(|key| crate::output::columns::swept_text(own.parameters.get(*key))));
            let point = own.point().unwrap_or_default();
            row.extend((0..own.keys().len()).map(|j| number(point.get(j).copied())));
            row.push(number(own.best_finite.as_ref().map(|best| best.result)));
            row.push(own.goal.clone());
            row.push(own.status.map_or("", status_word).into());
            row.push(own.best_finite.as_ref().map_or(String::new(), |best| best.case.to_string()));
            row.extend([number(own.bracket.map(|ends| ends[0])), number(own.bracket.map(|ends| ends[1]))]);
            row.extend([number(own.possible_gain), own.tried.to_string()]);
            bytes.extend(csv_row(row.into_iter()));
        }
        vec![("optima.csv".into(), bytes)]
    }
}

/// Returns the result of the search in one sentence; `None` if the study is no optimisation.
pub(super) fn sentence(study: &StudyOutput) -> Option<String> {
    let optima = study.results.own.optima.as_ref()?;
    let Some(own) = best_of(optima) else { return Some("No value was tried.".into()) };
    let (extreme, quantity) = (own.extreme(), own.quantity());
    let name = name(study, own);
    let of = if name.is_empty() { String::new() } else { format!(" ({name})") };
    let finite = own.point().zip(own.best_finite.as_ref()).map(|(point, best)| {
        let value = |(key, x): (&str, &f64)| {
            let unit =
                study.keys.unit(key).filter(|unit| *unit != "-").map_or(String::new(), |unit| format!(" {unit}"));
            format!("{} = {}{unit}", study.keys.words_in_place(key), format_number(*x, 6))
        };
        let at: Vec<String> = own.keys().into_iter().zip(&point).map(value).collect();
        let kind = study.results.case(best.case).and_then(|case| case.mechanism.as_ref());
        let kind = kind.map_or(String::new(), |own| format!(", {}", kind_words(own.kind)));
        let place = study.results.cases.iter().position(|case| case.label.id == best.case);
        let unit = place.and_then(|place| study.scene(place)).and_then(|(_, stages)| unit_load(stages));
        let force = unit.map_or(String::new(), |unit| format!(" ({})", format_force(best.result * unit)));
        (format!("{}{force} at {}{of}", format_number(best.result, 7), at.join(", ")), kind)
    });
    Some(match (own.value, finite) {
        (Some(_), Some((words, kind))) => format!("The {extreme} {quantity} is {words}{kind}."),
        (_, finite) => {
            let status = own.status.map_or("no result", status_word).replace('_', " ");
            let finite = finite.map_or(String::new(), |(words, _)| format!("; the {extreme} finite one is {words}"));
            let interval = |own: &IntervalEntry| {
                let words = own.status.replace('_', " ");
                format!("{words} from {} to {}", format_number(own.from, 8), format_number(own.to, 8))
            };
            let intervals: Vec<String> = own.intervals.iter().map(interval).collect();
            let ranges =
                if intervals.is_empty() { String::new() } else { format!(" Ranges: {}.", intervals.join("; ")) };
            format!("There is no {extreme} {quantity}: some value is {status}{finite}.{ranges}")
        }
    })
}

/// Variant and swept values of an optimum.
fn name(study: &StudyOutput, own: &OptimumEntry) -> String {
    study.keys.named(own.variant.as_deref(), &own.parameters)
}

/// States the proved part of a result.
fn scope(first: &OptimumEntry) -> &'static str {
    match first.keys().len() {
        1 => {
            "Each optimum is the best value that was tried. Between its two neighbours the result cannot change by more than the possible \
             gain if it is concave there (convex for a least one). Elsewhere the spacing of the scan limits the search. Each load factor \
             has its own certificate; no proof excludes a better value."
        }
        _ => {
            "Each optimum is the best point that was tried: a local optimum from several starts of a scan. Each load factor has its own \
             certificate; no proof excludes a better point."
        }
    }
}

/// Header and rows of the table.
fn table(study: &StudyOutput, optima: &[OptimumEntry]) -> (Vec<String>, Vec<Vec<String>>) {
    let Some(first) = optima.first() else { return Default::default() };
    let single = first.keys().len() == 1;
    let named = optima.iter().any(|own| !name(study, own).is_empty());
    let title = if first.variant.is_some() { "variant" } else { "sweep" };
    let mut header: Vec<String> = named.then(|| title.to_string()).into_iter().collect();
    header.extend(first.keys().into_iter().map(|key| study.keys.title(key)));
    header.push(format!("{} {}", first.extreme(), first.quantity()));
    header.extend(single.then(|| ["between", "and", "possible gain"].map(String::from)).into_iter().flatten());
    header.extend(["status", "kind", "hinges", "certificate", "case", "tried"].map(String::from));
    let number = |x: Option<f64>, digits: usize| x.map_or("-".into(), |x| format_number(x, digits));
    let row = |own: &OptimumEntry| {
        let best = own.best_finite.as_ref();
        let case: Option<&CaseResult> = best.and_then(|best| study.results.case(best.case));
        let mechanism = case.and_then(|case| case.mechanism.as_ref());
        let point = own.point().unwrap_or_default();
        let mut row: Vec<String> = named.then(|| name(study, own)).into_iter().collect();
        row.extend((0..first.keys().len()).map(|j| number(point.get(j).copied(), 7)));
        row.push(number(best.map(|best| best.result), 8));
        if single {
            row.extend([0, 1].map(|end| number(own.bracket.map(|ends| ends[end]), 7)));
            row.push(number(own.possible_gain, 2));
        }
        row.push(own.status.map_or("-".into(), |status| status_word(status).replace('_', " ")));
        row.push(mechanism.map_or(String::new(), |own| kind_words(own.kind).into()));
        row.push(mechanism.map_or(String::new(), |own| hinge_list(own).join(" ")));
        row.push(case.map_or("", certificate_verdict).into());
        row.push(best.map_or(String::new(), |best| best.case.to_string()));
        row.push(own.tried.to_string());
        row
    };
    (header, optima.iter().map(row).collect())
}

/// Returns the text for the terminal; `None` if the study is no optimisation.
pub fn optima_table(study: &StudyOutput) -> Option<String> {
    let optima = study.results.own.optima.as_ref()?;
    let mut text = format!("{}\n\n", sentence(study)?);
    let (header, rows) = self::table(study, optima);
    let mut table = Table::new();
    table.load_style(presets::NOTHING).set_content_arrangement(ContentArrangement::Disabled).set_header(header);
    table.add_rows(rows);
    let words = ["variant", "sweep", "status", "kind", "hinges", "certificate"];
    let header: Vec<String> =
        table.header().map(|row| row.cell_iter().map(|cell| cell.content()).collect()).unwrap_or_default();
    for (column, title) in table.column_iter_mut().zip(&header) {
        let left = words.contains(&title.as_str());
        column.set_cell_alignment(if left { CellAlignment::Left } else { CellAlignment::Right });
    }
    text.extend(table.to_string().lines().map(|line| line.trim_end().to_string() + "\n"));
    let totals = study.totals;
    let failed = totals.cases - totals.certified - totals.open;
    text += &format!("\n{} cases in results.csv", totals.cases);
    if totals.open + failed > 0 {
        text += &format!("; certificate: {} ok, {} bounds, {failed} FAILED", totals.certified, totals.open);
    }
    Some(text + "\n")
}

/// The table of the report; empty if the study is no optimisation.
pub(super) fn section(study: &StudyOutput) -> Markup {
    let Some(optima) = study.results.own.optima.as_ref().filter(|optima| !optima.is_empty()) else { return html! {} };
    let (header, rows) = self::table(study, optima);
    html! {
        h2 { "Optima" }
        (page::table(&header, rows.into_iter()))
        p { (scope(&optima[0])) " The same numbers with all digits are in optima.csv." }
    }
}

register!(
    "optima_csv",
    Optima,
    "optima.csv: one row per optimum of a study of kind optimise",
    "# `optima_csv`\n\nWrites `optima.csv` if the study is of kind `optimise`: one row for each variant and sweep point with the best \
     finite value, its result and its case, the neighbours of the value that were tried, and the possible gain between them.\n"
);
