//! Tables of cases, with the least load factors first; notes and certificates.

use crate::figures::hinges::hinge_list;
use crate::output::StudyOutput;
use crate::writers::page;
use crate::writers::table::{distinct_notes, id_list};
use maud::{Markup, html};
use voussoir_study::results::format::{
    certificate_verdict, contact_words, format_force, format_number, format_seconds, format_short, kind_words,
    open_bounds, proved_interval, snap_words, status_word, unit_load,
};
use voussoir_study::results::{CaseResult, load_rank};

/// Greatest number of rows of a table in the page; the CSV file contains all.
const ROWS: usize = 60;

/// Indices of the cases: first those without a valid certificate, then by increasing load factor, and last those
/// without a result.
fn worst_first(cases: &[CaseResult]) -> Vec<usize> {
    let mut places: Vec<usize> = (0..cases.len()).collect();
    let rank = |place: usize| {
        let case = &cases[place];
        let proved = certificate_verdict(case) != "failed" || load_rank(case).is_none();
        (proved, load_rank(case).is_none(), load_rank(case).unwrap_or(f64::INFINITY))
    };
    places.sort_by(|a, b| {
        let (a, b) = (rank(*a), rank(*b));
        (a.0, a.1).cmp(&(b.0, b.1)).then(a.2.total_cmp(&b.2))
    });
    places
}

/// A column: its heading, and a function that returns the cell of a case by its index.
type Column<'a> = (String, Box<dyn Fn(usize) -> String + 'a>);

/// The table of cases.
pub(super) fn table(study: &StudyOutput) -> Markup {
    let cases = &study.results.cases;
    let columns = columns(study);
    let header: Vec<String> = columns.iter().map(|(heading, _)| heading.clone()).collect();
    let rows = worst_first(cases).into_iter().take(ROWS);
    let rows = rows.map(|place| columns.iter().map(|(_, cell)| cell(place)).collect());
    let joined = cases.iter().filter_map(|case| case.mechanism.as_ref()).flat_map(hinge_list).any(|g| g.contains('+'));
    html! {
        (page::table(&header, rows))
        @if cases.len() > ROWS {
            p { "The " (ROWS) " of " (study.totals.cases) " cases with the least load factors; all are in results.csv." }
        }
        @if joined { p { "Joints joined by + are neighbours that count as one hinge." } }
    }
}

fn columns<'a>(study: &'a StudyOutput) -> Vec<Column<'a>> {
    let cases = &study.results.cases;
    let loads: Vec<Option<f64>> =
        (0..cases.len()).map(|i| study.scene(i).and_then(|(_, stages)| unit_load(stages))).collect();
    let with_load = loads.iter().any(Option::is_some);
    let mut columns: Vec<Column> = Vec::new();
    let mut add = |wanted: bool, heading: &str, cell: Box<dyn Fn(usize) -> String + 'a>| {
        columns.extend(wanted.then(|| (heading.to_string(), cell)));
    };
    for label in study.page_labels().columns() {
        add(true, &label.title.clone(), Box::new(move |place| label.words(&cases[place])));
    }
    add(true, "status", Box::new(|place| status_word(cases[place].status).replace('_', " ")));
    add(true, "load factor", Box::new(|place| factor(&cases[place])));
    let force = move |place: usize| loads[place].map_or(String::new(), |load| force(&cases[place], load));
    add(with_load, "load", Box::new(force));
    add(true, "bounds", Box::new(|place| proved_interval(&cases[place]).unwrap_or_default()));
    let associated = cases.iter().any(|case| case.non_associated.associated_load_factor.is_some());
    add(associated, "with associated flow", Box::new(|place| with_associated_flow(&cases[place])));
    add(true, "mechanism", Box::new(|place| mechanism(&cases[place])));
    let in_space = |case: &CaseResult| case.mechanism.as_ref().map(contact_words).unwrap_or_default();
    let wanted = cases.iter().any(|case| !in_space(case).is_empty());
    add(wanted, "contacts", Box::new(move |place| in_space(&cases[place])));
    add(true, "hinges at joints", Box::new(|place| hinges(&cases[place])));
    add(true, "certificate", Box::new(|place| certificate_verdict(&cases[place]).into()));
    add(true, "time", Box::new(|place| format_seconds(cases[place].seconds)));
    columns
}

fn factor(case: &CaseResult) -> String {
    case.load_factor.map_or("–".into(), |factor| match open_bounds(case) {
        Some([proved, _]) => format!("≥ {} (found {})", format_short(proved, 4), format_number(factor, 7)),
        None => snap_words(case.load_factor, case.path.first_limit_point, |x| format_number(x, 7))
            .unwrap_or_else(|| format_number(factor, 7)),
    })
}

/// The load factor with associated flow, an upper bound, and its ratio to the load factor of the laws' own flow.
fn with_associated_flow(case: &CaseResult) -> String {
    let Some(bound) = case.non_associated.associated_load_factor else { return String::new() };
    let ratio = case.load_factor.filter(|factor| *factor > 0.0).map(|factor| bound / factor);
    let ratio = ratio.map_or(String::new(), |ratio| format!(" ({} ×)", format_short(ratio, 4)));
    format!("{}{ratio}", format_number(bound, 7))
}

/// The load of a case; `unit` is the load at factor 1 \[N\].
fn force(case: &CaseResult, unit: f64) -> String {
    let force = |factor: f64| format_force(factor * unit);
    let snaps = snap_words(case.load_factor, case.path.first_limit_point, force);
    snaps.or(case.load_factor.map(force)).unwrap_or_default()
}

fn mechanism(case: &CaseResult) -> String {
    let words = |own: &voussoir_core::certificate::Mechanism| {
        format!("{}{}", kind_words(own.kind), if own.unique == Some(false) { ", not unique" } else { "" })
    };
    case.mechanism.as_ref().map_or(String::new(), words)
}

/// The joints of the hinges, or only their number if there are many.
pub(super) fn hinges(case: &CaseResult) -> String {
    let joints = case.mechanism.as_ref().map(hinge_list).unwrap_or_default();
    if joints.len() > 12 { format!("{} joints", joints.len()) } else { joints.join(", ") }
}

/// Each note once, with its cases.
pub(super) fn notes(cases: &[CaseResult]) -> Markup {
    let notes = distinct_notes(cases);
    html! {
        @if !notes.is_empty() {
            h2 { "Notes" }
            ul {
                @for (note, ids) in &notes { li { (note) " " span class="quiet" { "(" (id_list(ids, cases.len())) ")" } } }
            }
        }
    }
}

/// The residuals of each case.
pub(super) fn certificates(cases: &[CaseResult]) -> Markup {
    let mut names: Vec<&String> = cases.iter().flat_map(|case| case.certificate.residuals.keys()).collect();
    names.sort();
    names.dedup();
    let heads = names.iter().map(|name| name.replace('_', " "));
    let header: Vec<String> = ["id".to_string()].into_iter().chain(heads).chain(["verdict".into()]).collect();
    let rows = worst_first(cases).into_iter().take(ROWS).map(|place| {
        let case = &cases[place];
        let residual =
            |name: &&String| case.certificate.residuals.get(*name).map_or(String::new(), |r| format!("{r:.1e}"));
        let residuals = names.iter().map(residual);
        let id = case.label.id.to_string();
        [id].into_iter().chain(residuals).chain([certificate_verdict(case).to_string()]).collect()
    });
    html! {
        @if !names.is_empty() {
            h2 { "Certificates" }
            p {
                "Relative residuals, recomputed from the scene; 0 is perfect. Those of limit analysis share nothing with the \
                 solver; those of paths share the elastic blocks and the rule by which contact points slide."
            }
            (page::table(&header, rows))
            @if cases.len() > ROWS { p { "In the order of the table of cases; all are in results.json." } }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use voussoir_study::results::NonAssociatedAnswer;

    /// The cell has the associated load factor and its ratio to the found one; without a found one it has no ratio.
    #[test]
    fn both_flow_rules_stand_side_by_side() {
        let case = |associated_load_factor, load_factor| CaseResult {
            load_factor,
            non_associated: NonAssociatedAnswer { associated_load_factor, ..NonAssociatedAnswer::default() },
            ..CaseResult::stalled("")
        };
        assert_eq!(with_associated_flow(&case(Some(0.55), Some(0.5))), "0.5500000 (1.1 ×)");
        assert_eq!(with_associated_flow(&case(Some(0.55), None)), "0.5500000");
        assert_eq!(with_associated_flow(&case(None, Some(0.5))), "");
    }
}
