//! Pieces of the report's page: style, tables, standing texts.

mod sha256;
#[cfg(test)]
mod tests;

use crate::figures::plot::svg::escape;
use serde_json::Value as Json;
use voussoir_core::limit::Status;

/// Order of statuses in the summary.
pub(crate) const STATUSES: [Status; 7] = [
    Status::Collapse,
    Status::Stands,
    Status::Unbounded,
    Status::NoEquilibrium,
    Status::LimitPoint,
    Status::Open,
    Status::Stalled,
];

/// The page's style sheet.
const STYLE: &str = include_str!("page/style.css");
/// How the script draws a case.
const DRAW: &str = include_str!("page/draw.js");
/// What makes the page answer: sorting, filtering, values under the pointer, drawings that move.
const SCRIPT: &str = include_str!("page/script.js");
/// What makes a page that is served follow its sliders.
const LIVE: &str = include_str!("page/live.js");

/// A whole page: its title for the browser, its body as HTML, and the cases that the script draws.
pub(crate) fn whole(title: &str, body: &str, cases: &[Json]) -> String {
    page((title, ""), body, cases, SCRIPT, &policy(&[SCRIPT], &[]))
}

/// A page that asks its server for what it draws.
pub(crate) fn served(title: &str, body: &str) -> String {
    // So that no browser asks the server for one.
    page((title, "<link rel=\"icon\" href=\"data:,\">\n"), body, &[], LIVE, &served_policy())
}

/// The Content-Security-Policy of a served page. The report that it opens is a `blob:`, which inherits this policy, so
/// the script of reports is allowed as well.
pub(crate) fn served_policy() -> String {
    policy(&[LIVE, SCRIPT], &["connect-src 'self'", "img-src data:"])
}

/// A policy that allows these scripts and the page's style sheet by their hashes, and nothing from elsewhere.
fn policy(scripts: &[&str], more: &[&str]) -> String {
    let hashes: Vec<String> = scripts.iter().map(|script| sha256::source(&element(script))).collect();
    let own = [format!("script-src {}", hashes.join(" ")), format!("style-src {}", sha256::source(&unix(STYLE)))];
    let fixed = ["base-uri 'none'", "form-action 'none'"];
    let all = own.iter().map(String::as_str).chain(more.iter().copied()).chain(fixed);
    ["default-src 'none'"].into_iter().chain(all).collect::<Vec<_>>().join("; ")
}

/// The text of a script's element.
fn element(script: &str) -> String {
    unix(&format!("'use strict';\n{{\n{DRAW}\n{script}}}"))
}

/// A text with the line ends that browsers hash.
fn unix(text: &str) -> String {
    text.replace("\r\n", "\n")
}

fn page((title, icon): (&str, &str), body: &str, cases: &[Json], script: &str, policy: &str) -> String {
    // Nothing in the data can end the script's element.
    let data = Json::from_iter(cases.iter().cloned()).to_string().replace('<', "\\u003c");
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta http-equiv=\"Content-Security-Policy\" \
         content=\"{policy}\">\n<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n\
         {icon}<style>{}</style>\n</head>\n<body>\n{body}<script type=\"application/json\" id=\"cases\">{data}</script>\n\
         <script>{}</script>\n</body>\n</html>\n",
        escape(title),
        unix(STYLE),
        element(script)
    )
}

/// What the figures show.
pub(crate) const MEANING: &str = "<p>The <em>thrust line</em> is where the resultant force crosses the joints: while it stays \
within the blocks an arch without tension can stand, and where it touches a face a <em>hinge</em> can form. A hinge is drawn \
where the blocks still touch; the joint opens on the other side. In walls a bar at each joint shows where its force acts, along \
which line and how great it is. A <em>strut</em> is a set of forces that balances the load alone, without weight: a scene that \
has one carries any load. In the second figure of a case blocks are displaced as the mechanism begins to move, exaggerated.</p>\n";

/// A table; cells that begin like a number are aligned right.
pub(crate) fn table(header: &[String], rows: impl Iterator<Item = Vec<String>>) -> String {
    let head: String = header.iter().map(|cell| format!("<th>{}</th>", escape(cell))).collect();
    let body: String = rows
        .map(|row| {
            let cells: String = row
                .iter()
                .map(|cell| {
                    let number = cell.split(' ').next().is_some_and(|word| word.parse::<f64>().is_ok());
                    let class = match cell.as_str() {
                        "failed" => " class=\"bad\"",
                        _ if number && !cell.contains(',') => " class=\"number\"",
                        _ => "",
                    };
                    format!("<td{class}>{}</td>", escape(cell))
                })
                .collect();
            format!("<tr>{cells}</tr>\n")
        })
        .collect();
    format!("<div class=\"wide\"><table>\n<thead><tr>{head}</tr></thead>\n<tbody>\n{body}</tbody></table></div>\n")
}
