//! Parts of every page: head, style, scripts and tables.

pub mod sha256;

use maud::{DOCTYPE, Markup, PreEscaped, html};
use serde_json::Value as Json;
use std::sync::LazyLock;
use voussoir_plot::colours::dark_rules;

/// The style sheet of the page: its own rules, then the colours of figures on dark screens.
static STYLE: LazyLock<String> =
    LazyLock::new(|| unix(include_str!("page/style.css")) + &dark_rules("figure svg", |_| true) + "\n");
/// The script that draws a case.
const DRAW: &str = include_str!("page/draw.js");
/// The script of interactive pages: sorting, filtering, values under the pointer, moving drawings.
const SCRIPT: &str = concat!(include_str!("page/script.js"), include_str!("page/space.js"));
/// The script of a served page, which follows its sliders.
const LIVE: &str = include_str!("page/live.js");

/// Creates a complete page from its title, its body, and the cases that the script draws. Each printed page shows the title.
pub(crate) fn whole(title: &str, body: &Markup, cases: &[Json]) -> String {
    let styles = [STYLE.as_str(), &title_in_margin(title)];
    page((title, None), body, cases, (&styles, SCRIPT), &policy(&styles, &[SCRIPT], &[]))
}

/// The rule that prints a title in the lower margin of each page.
fn title_in_margin(title: &str) -> String {
    // Every other character is escaped by its number, so that a title cannot end the text or the style sheet.
    let plain = |c: char| c.is_ascii_alphanumeric() || matches!(c, ' ' | '-' | '_' | ',');
    let escaped = title.chars().map(|c| if plain(c) { c.to_string() } else { format!("\\{:x} ", u32::from(c)) });
    format!("@page {{ @bottom-left {{ content: \"{}\"; }} }}\n", escaped.collect::<String>())
}

/// Creates a page that requests its drawings from the server.
pub fn served(title: &str, body: &Markup) -> String {
    // An empty icon, so that browsers do not request one from the server.
    page((title, Some("data:,")), body, &[], (&[STYLE.as_str()], LIVE), &served_policy())
}

/// The Content-Security-Policy of a served page. The report that it opens is a `blob:`, which inherits this policy. The
/// script of reports is therefore allowed as well.
pub fn served_policy() -> String {
    policy(&[STYLE.as_str()], &[LIVE, SCRIPT], &["connect-src 'self'", "img-src data:"])
}

/// A policy that allows these style sheets and scripts by their hashes, and no external sources.
fn policy(styles: &[&str], scripts: &[&str], more: &[&str]) -> String {
    let scripts: Vec<String> = scripts.iter().map(|script| sha256::source(&element(script))).collect();
    let styles: Vec<String> = styles.iter().map(|style| sha256::source(style)).collect();
    let own = [format!("script-src {}", scripts.join(" ")), format!("style-src {}", styles.join(" "))];
    let fixed = ["base-uri 'none'", "form-action 'none'"];
    let all = own.iter().map(String::as_str).chain(more.iter().copied()).chain(fixed);
    ["default-src 'none'"].into_iter().chain(all).collect::<Vec<_>>().join("; ")
}

/// The text of a script's element.
fn element(script: &str) -> String {
    unix(&format!("'use strict';\n{{\n{DRAW}\n{script}}}"))
}

/// Converts line ends to the form that browsers hash.
fn unix(text: &str) -> String {
    text.replace("\r\n", "\n")
}

fn page(
    (title, icon): (&str, Option<&str>),
    body: &Markup,
    cases: &[Json],
    (styles, script): (&[&str], &str),
    policy: &str,
) -> String {
    // The data cannot contain the end of the script element.
    let data = Json::from_iter(cases.iter().cloned()).to_string().replace('<', "\\u003c");
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta http-equiv="Content-Security-Policy" content=(policy);
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { (title) }
                @if let Some(icon) = icon { link rel="icon" href=(icon); }
                @for style in styles { style { (PreEscaped(style)) } }
            }
            body {
                (body)
                script type="application/json" id="cases" { (PreEscaped(data)) }
                script { (PreEscaped(element(script))) }
            }
        }
    };
    page.into_string() + "\n"
}

/// Returns true if a cell is a number, with or without unit.
fn is_number(cell: &str) -> bool {
    cell.split(' ').next().is_some_and(|word| word.parse::<f64>().is_ok()) && !cell.contains(',')
}

/// A table. Columns of numbers are aligned right.
pub(crate) fn table(header: &[String], rows: impl Iterator<Item = Vec<String>>) -> Markup {
    let rows: Vec<Vec<String>> = rows.collect();
    let number = |column: usize| {
        let mut filled =
            rows.iter().filter_map(|row| row.get(column)).filter(|cell| !["", "–"].contains(&cell.as_str()));
        filled.clone().next().is_some() && filled.all(|cell| is_number(cell))
    };
    let numbers: Vec<bool> = (0..header.len()).map(number).collect();
    let class = |column: usize, cell: &str| match cell {
        "failed" => Some("bad"),
        _ => numbers.get(column).is_some_and(|number| *number).then_some("number"),
    };
    html! {
        div class="wide" {
            table {
                thead { tr { @for cell in header { th { (cell) } } } }
                tbody {
                    @for row in &rows {
                        tr { @for (column, cell) in row.iter().enumerate() { td class=[class(column, cell)] { (cell) } } }
                    }
                }
            }
        }
    }
}

/// A drawing with its caption.
pub(crate) fn figure(svg: &str, caption: &str) -> Markup {
    html! { figure { (PreEscaped(svg)) figcaption { (caption) } } }
}
