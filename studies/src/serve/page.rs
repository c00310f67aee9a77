//! The page in the browser: drawings, result, sliders.

use maud::{Markup, PreEscaped, html};
use voussoir_report::writers::page;

/// The data of a page.
#[derive(Debug)]
pub(super) struct Shown<'a> {
    /// Name of the study.
    pub name: &'a str,
    /// Purpose of the study's kind.
    pub kind: &'a str,
    /// Id of the case.
    pub case: usize,
    /// Number of cases.
    pub count: usize,
    /// Labels of the cases; `None` if there are too many for a list.
    pub labels: Option<Vec<String>>,
    /// The controls of the case, as HTML.
    pub controls: String,
}

/// Returns the page of a case as HTML.
pub(super) fn page(shown: &Shown) -> String {
    let body = html! {
        h1 { (shown.name) }
        @if shown.kind != "run" {
            p class="quiet" { "The kind of this study is " (shown.kind) ". This page computes its cases one at a time." }
        }
        (choice(shown))
        div id="live" data-case=(shown.case) {
            (seen())
            form id="controls" { (PreEscaped(&shown.controls)) }
        }
        noscript { "This page needs its script." }
    };
    page::served(shown.name, &body)
}

/// A list of the study's cases.
fn choice(shown: &Shown) -> Markup {
    html! {
        @match &shown.labels {
            Some(labels) if labels.len() > 1 => p {
                label {
                    "Case "
                    select id="case" {
                        @for (id, label) in labels.iter().enumerate() {
                            option value=(id) selected[id == shown.case] { (label) }
                        }
                    }
                }
            },
            Some(_) => {},
            None => p class="quiet" { "Case " (shown.case) " of " (shown.count) "." },
        }
    }
}

/// The places of an answer; the script fills them.
fn seen() -> Markup {
    html! {
        section class="seen" {
            p class="summary" role="status" { strong id="headline" { "…" } }
            pre id="mistakes" class="bad" role="alert" hidden {}
            p id="progress" class="quiet" role="status" hidden {
                span class="spinner" {} " " span id="doing" {} " " button type="button" id="stop" { "Stop" }
            }
            div class="case" {
                figure class="scene" id="scene" hidden {
                    div id="picture" {}
                    figcaption { span id="kind" {} " " span id="drag" { "Drag a load, or move it with the arrow keys." } }
                }
                figure id="curve" hidden {}
            }
            p id="sampled" class="bad" hidden {}
            p class="quiet" { span id="proof" {} " " span id="time" {} }
            ul id="notes" class="quiet" {}
            p class="buttons" {
                button type="button" id="copy" { "Copy the study file" } " "
                button type="button" id="reset" { "Reset" } " "
                button type="button" id="report" { "Report" } " "
                span id="said" role="status" {}
            }
            details { summary { "Study file" } pre id="toml" {} }
        }
    }
}
