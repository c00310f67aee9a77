//! The page of a study of studies: verdicts first, then each study with its text, inputs and results.

use super::claims::{Answer, Test, Verdict};
use super::contents::Contents;
use super::expression::Expression;
use super::figures::Image;
use super::parts::Parts;
use super::sentence::sentence;
use super::value::Value;
use crate::writers::markdown::markdown;
use crate::writers::page;
use crate::writers::title_block::{ReportOrigin, title_block};
use maud::{Markup, PreEscaped, html};
use voussoir_plot::svg::own_ids;
use voussoir_study::kind::{Part, Piece};
use voussoir_study::results::format::format_seconds;
use voussoir_study::study::RecordTable;

/// Returns the page as HTML.
pub fn results_page(
    name: &str,
    contents: &Contents,
    parts: &Parts,
    answers: &[Answer],
    (record, origin): (Option<&RecordTable>, ReportOrigin),
) -> String {
    let title = contents.title.as_deref().unwrap_or(name);
    let drawn = std::cell::Cell::new(0);
    let text = |words: &str| {
        markdown(words, &|place| {
            drawn.set(drawn.get() + 1);
            image(contents, parts, place).map(|image| own_ids(&image, &format!("drawn-{}", drawn.get())))
        })
    };
    let last = contents.text.get(contents.studies.len());
    let body = html! {
        h1 { (title) }
        (title_block(name, record, origin))
        (text(&contents.introduction))
        (claims(answers, contents, &text))
        @for (place, part) in parts.list().iter().enumerate().take(contents.studies.len()) {
            @let words = contents.text.get(place).map_or("", |words| words.trim());
            section id=(part.folder) {
                (heading(words, &part.folder))
                (text(words))
                (answered(parts, place, part))
            }
        }
        @if let Some(words) = last { (text(words)) }
        h2 { "Time" }
        p { "Time of each study's cases, summed; studies with several jobs take less." }
        (times(parts))
        footer {
            (origin.sentence()) "Each study has a folder beside this page with its results, tables and figures."
        }
    };
    page::whole(title, &body, &[])
}

fn times(parts: &Parts) -> Markup {
    let header = ["study", "cases", "time"].map(String::from);
    let rows = parts.list().iter().enumerate().map(|(place, part)| {
        vec![part.folder.clone(), parts.cases(place).len().to_string(), format_seconds(parts.seconds(place))]
    });
    page::table(&header, rows)
}

/// The heading of a part: its text's own, or else the name of its study. A part without a text has none.
fn heading(words: &str, study: &str) -> Markup {
    html! { @if !words.is_empty() && !words.starts_with('#') { h2 { (study) } } }
}

/// The claims with their verdicts; the tests of each can be opened.
fn claims(answers: &[Answer], contents: &Contents, text: &dyn Fn(&str) -> Markup) -> Markup {
    let count = |verdict: Verdict| answers.iter().filter(|answer| answer.verdict == verdict).count();
    let all = [Verdict::Reproduced, Verdict::Refuted, Verdict::DependsOn, Verdict::Undecided];
    let words = |verdict: &Verdict| match verdict {
        Verdict::DependsOn => "depend on what is assumed",
        other => other.words(),
    };
    let some = all.iter().filter(|verdict| count(**verdict) > 0);
    let counted: Vec<String> = some.map(|verdict| format!("{} {}", count(*verdict), words(verdict))).collect();
    html! {
        @if !answers.is_empty() {
            h2 { "Claims" }
            p class="summary" {
                "Of " (answers.len()) " claims " strong { (counted.join(", ")) }
                ". Every verdict is computed from the numbers below it."
            }
            @for answer in answers { (claim(answer, contents, text)) }
        }
    }
}

/// The numbers with coarser settings, in words.
fn coarser(values: &[Value]) -> String {
    let words: Vec<String> = values.iter().map(Value::describe).collect();
    if words.is_empty() { String::new() } else { format!(" (coarser: {})", words.join("; ")) }
}

/// The condition of a test as a sentence; a series with a label has the label's words.
fn condition(test: &Test, contents: &Contents) -> String {
    let label = |name: &str| contents.series.get(name).and_then(|series| series.label.clone());
    let words = |name: &str| label(name).map_or_else(|| name.into(), |label| format!("“{label}”"));
    match Expression::parse(&test.holds) {
        Ok(holds) => sentence(&holds, Expression::parse(&test.value).ok().as_ref(), &words),
        Err(_) => test.holds.clone(),
    }
}

fn claim(answer: &Answer, contents: &Contents, text: &dyn Fn(&str) -> Markup) -> Markup {
    let claim = answer.claim;
    let class = match answer.verdict {
        Verdict::Reproduced => "verdict yes",
        Verdict::Refuted => "verdict no",
        Verdict::DependsOn => "verdict partly",
        Verdict::Undecided => "verdict bad",
    };
    let header = ["", "number", "", "condition"].map(String::from);
    let rows = claim.tests.iter().zip(&answer.tests).map(|(test, tested)| {
        let unit = if test.unit.is_empty() || tested.value.number().is_none_or(f64::is_infinite) {
            String::new()
        } else {
            format!(" {}", test.unit)
        };
        let holds = match tested.holds {
            Some(true) => "holds",
            Some(false) => "does not hold",
            None => "undecided",
        };
        vec![
            test.of.clone(),
            format!("{}{unit}{}", tested.value.describe(), coarser(&tested.coarser)),
            holds.into(),
            condition(test, contents),
        ]
    });
    let expressions = ["", "value", "condition"].map(String::from);
    let terms = claim.tests.iter().map(|test| vec![test.of.clone(), test.value.clone(), test.holds.clone()]);
    html! {
        details class="claim" id={ "claim-" (claim.id) } {
            summary {
                span class=(class) { (answer.words()) } " " (claim.id) ". " (claim.claim)
                @if !claim.source.is_empty() { " " span class="quiet" { "(" (claim.source) ")" } }
                @if let Some(reading) = &claim.reading { span class="reading" { (reading) } }
            }
            (page::table(&header, rows))
            details { summary { "Expressions" } (page::table(&expressions, terms)) }
            (text(&claim.remark))
        }
    }
}

/// The cases of a part, how they ended and the inputs of its study.
fn answered(parts: &Parts, place: usize, part: &Part) -> Markup {
    let statuses = parts.statuses(place);
    let words: Vec<String> =
        statuses.iter().map(|(status, count)| format!("{count} {}", status.replace('_', " "))).collect();
    let failed = parts.uncertified(place);
    html! {
        p class="quiet" {
            code { (part.folder) } ", " (parts.cases(place).len()) " cases: " (words.join(", ")) "; "
            @if failed == 0 { "every answer certified" } @else { strong class="bad" { (failed) " not certified" } }
            ". " a href={ (part.folder.replace(' ', "%20")) "/report.html" } { "All cases of this study" } "."
        }
        @if let Some(record) = parts.piece(&part.folder, Piece::Record) {
            details { summary { "Inputs" } (PreEscaped(record)) }
        }
    }
}

/// The drawing or table at the place of an image.
fn image(contents: &Contents, parts: &Parts, place: &str) -> Option<String> {
    match Image::parse(place)? {
        Image::Table(name) => contents
            .tables
            .iter()
            .find(|table| table.name == name)
            .map(|table| table.html(&contents.series, parts).into_string()),
        _ if !parts.figures => Some(String::new()),
        Image::Chart(name) => {
            contents.charts.iter().find(|chart| chart.name == name).map(|chart| chart.svg(&contents.series, parts))
        }
        Image::Study(name) => parts.piece(&name, Piece::Chart),
        Image::Case(what, series, x) => {
            let selection = contents.series.get(&series)?;
            let name = selection.study.as_deref()?;
            let results = parts.json(name)?;
            let chosen = selection.choose(results);
            let case = &chosen.iter().find(|chosen| (chosen.x - x).abs() <= 1e-6 * x.abs().max(1e-6))?.head;
            let id = case.id.or(case.case)?;
            let piece = match what.as_str() {
                "scene" => Piece::Scene(id),
                "mechanism" => Piece::Mechanism(id),
                _ => Piece::Curve(id),
            };
            parts.piece(name, piece)
        }
    }
}
