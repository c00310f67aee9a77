//! `report.html`: one self-contained page for reading and printing. It begins with the result, its picture and the
//! critical numbers. Charts, cases and paths follow; inputs, assumptions, sources and certificates are at the end.

mod answer;
mod cases;
mod paths;
mod pictures;

use super::comparison::{comparison_rows, figure as comparison_figure};
use super::live::case_data;
use super::live_space::space_data;
use super::page::{self, figure};
use super::record::record;
use super::register::register;
use super::seismic;
use super::title_block::{ReportOrigin, title_block};
use super::writer::Writer;
use super::{joints_csv, optima_csv, outputs_csv, sensitivities_csv};
use crate::figures::envelope::{envelope_chart, optimum_chart};
use crate::figures::moving_load::moving_load_svg;
use crate::figures::sweep::study_chart;
use crate::output::StudyOutput;
use maud::{Markup, html};
use serde_json::Value as Json;
use voussoir_core::plugin::Keys;
use voussoir_plot::svg::own_ids;
use voussoir_study::config::common_keys::own_keys;

/// `[output.options.report]`.
#[derive(Debug, Clone, Keys)]
pub struct ReportOptions {
    /// at most so many cases are drawn
    #[key(range = "<= 100_000", default = 40)]
    drawn: usize,
}

/// Writes `report.html`.
#[derive(Debug)]
pub struct Report;

impl Writer for Report {
    fn files(&self, study: &StudyOutput, options: &Json) -> Vec<(String, Vec<u8>)> {
        let ReportOptions { drawn } = own_keys(options).unwrap_or_else(ReportOptions::defaults);
        vec![("report.html".into(), report_html(study, drawn).into_bytes())]
    }
}

/// Creates the page; at most `drawn` cases are drawn.
pub fn report_html(study: &StudyOutput, drawn: usize) -> String {
    let worst = answer::worst(study);
    let figures = study.output.figures.anything();
    let origin = study.inputs.map(|inputs| ReportOrigin {
        version: &study.results.version,
        commit: &study.results.origin.commit,
        date: study.results.date.as_deref(),
        study: &inputs.resolved,
    });
    let signed = study.inputs.and_then(|inputs| inputs.record.as_ref());
    let body = html! {
        h1 { (study.name) }
        @if let Some(origin) = origin { (title_block(study.name, signed, origin)) }
        (answer::answer(study))
        (optima_csv::section(study))
        div class="first" {
            @if figures && drawn > 0 && let Some(place) = worst { (pictures::of_case(study, place)) }
            (answer::critical_numbers(study))
        }
        (seismic::section(study))
        @if figures { (charts(study)) }
        (comparison(study))
        h2 { "Cases" }
        @if !study.totals.all_shown() {
            p {
                "The tables and the chart show " (study.results.cases.len()) " of " (study.totals.cases) " cases: the least and the \
                 greatest load factor of every few neighbours, and cases without a certified answer. All cases are in results.csv."
            }
        }
        (cases::table(study))
        (cases::notes(&study.results.cases))
        @if figures { (pictures::others(study, worst, drawn)) }
        (joints_csv::section(study))
        (outputs_csv::section(study))
        (sensitivities_csv::table(study))
        (paths::paths(study, drawn))
        @if let Some(inputs) = study.inputs {
            h2 { "Inputs, assumptions and sources" }
            (record(inputs))
        }
        (cases::certificates(&study.results.cases))
        footer {
            @if let Some(origin) = origin { (origin.sentence()) }
            "SI units; forces in N, kN or MN as marked. The numbers to the last bit are in results.json and results.csv \
             beside this page."
        }
    };
    page::whole(study.name, &body, &live(study, worst, drawn))
}

/// The charts of a sweep and of a moving load.
fn charts(study: &StudyOutput) -> Markup {
    html! {
        @if let Some(chart) = study_chart(study) {
            h2 { "The sweep" }
            (figure(&chart, "Each marker or point is one case. Lines only join neighbouring cases. An arrow at the upper edge is a case that carries \
                             any load."))
        }
        @if let Some(chart) = envelope_chart(study) {
            h2 { "Envelope" }
            (figure(&chart, "The load factor at every place that was tried."))
        }
        @if let Some(chart) = optimum_chart(study) {
            h2 { "The search" }
            (figure(&chart, "Each point is a trial. Lines only join neighbouring points. The rings are the optima."))
        }
        @if let Some(svg) = moving_load_svg(study) {
            h2 { "The load on its way" }
            (figure(&own_ids(&svg, "moving-load"), "Place by place, with the mechanism there; printed, the worst place."))
        }
    }
}

/// Greatest number of rows of a comparison in the page; its CSV file contains all.
const ROWS: usize = 60;

/// The comparison of variants, if the study compares them.
fn comparison(study: &StudyOutput) -> Markup {
    let Some(comparison) = &study.results.comparison else { return html! {} };
    let drawn = study.output.figures.anything().then(|| comparison_figure(study, comparison)).flatten();
    let caption = |name| match name {
        "map" => {
            "One cell for each point of the grid. Contours are linear between points and end at points without a ratio."
        }
        _ => "One row for each scene, one mark for each variant; words at the right name every status but collapse.",
    };
    let (header, rows) = comparison_rows(comparison, &study.keys);
    let count = rows.len();
    html! {
        h2 { "Comparison" }
        @if let Some((name, svg)) = drawn { (figure(&svg, caption(name))) }
        p {
            "Load factors, then their ratios to those of " em { (comparison.reference) } ". A number after ≥ is a proved lower \
             bound: the load factor before it was found, and no load below the bound is possible. A case without a load factor \
             has a word."
        }
        (page::table(&header, rows.into_iter().take(ROWS)))
        @if count > ROWS { p { "The first " (ROWS) " of " (count) " rows; all are in comparison.csv." } }
    }
}

/// The data for the script: the cases in pictures and in the chart.
fn live(study: &StudyOutput, worst: Option<usize>, drawn: usize) -> Vec<Json> {
    if !study.output.figures.anything() || drawn == 0 {
        return Vec::new();
    }
    let cases = &study.results.cases;
    let chosen = (0..cases.len()).filter(|place| study.drawn(cases[*place].label.id)).take(drawn);
    let mut places: Vec<usize> = chosen.chain(worst).collect();
    places.sort_unstable();
    places.dedup();
    let data = |place: usize| match study.scenes.get(place)?.space {
        Some(space) => space_data(space, &cases[place]),
        None => case_data(study.scene(place)?.0, &cases[place], study.scenes[place].finite),
    };
    places.into_iter().filter_map(data).collect()
}

register!(
    "report",
    Report,
    "report.html: one self-contained page with tables, figures and certificates",
    ReportOptions,
    "# `report`\n\nWrites `report.html`, one page without external resources. At most `drawn` cases are drawn in it: \n\n```toml\n[output.options.report]\ndrawn = 10\n```\n"
);
