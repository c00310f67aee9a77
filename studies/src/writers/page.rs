//! Pieces of the report's page: style, tables, standing texts.

use crate::figures::format::{escape, format_short, format_value};
use voussoir_core::limit::Status;

/// Order of statuses in the summary.
pub(crate) const STATUSES: [Status; 6] =
    [Status::Collapse, Status::Stands, Status::Unbounded, Status::NoEquilibrium, Status::LimitPoint, Status::Stalled];

/// The page's style sheet.
pub(crate) const STYLE: &str = "
body { font: 16px/1.5 system-ui, -apple-system, 'Segoe UI', Helvetica, Arial, sans-serif; color: #222; background: #fff;
       max-width: 1060px; margin: 2rem auto; padding: 0 1rem; }
h1 { font-size: 1.8rem; margin: 0 0 .5rem; } h2 { font-size: 1.25rem; margin: 2rem 0 .5rem; border-bottom: 1px solid #ddd; }
.summary { font-size: 1.05rem; } .quiet { color: #666; } .bad, td.bad { color: #b00020; font-weight: bold; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: .82rem; font-variant-numeric: tabular-nums; }
th, td { padding: .25rem .45rem; border-bottom: 1px solid #e4e4e4; text-align: left; white-space: nowrap; }
th { border-bottom: 2px solid #999; vertical-align: bottom; white-space: normal; } td.number { text-align: right; }
details { margin: .5rem 0; border: 1px solid #ddd; border-radius: 4px; padding: .4rem .8rem; }
summary { cursor: pointer; font-weight: 600; }
figure { margin: 1rem 0; } figure svg { max-width: 100%; height: auto; } figcaption { font-size: .86rem; color: #555; }
footer { margin-top: 3rem; font-size: .86rem; color: #666; border-top: 1px solid #ddd; padding-top: .5rem; }
@media print { body { margin: 0; max-width: none; font-size: 11px; } details { border: 0; padding: 0; }
  figure, tr { break-inside: avoid; } .wide { overflow: visible; } }
";

/// A whole page: its title for the browser, and its body as HTML.
pub(crate) fn whole(title: &str, body: &str) -> String {
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" \
         content=\"width=device-width, initial-scale=1\">\n<title>{}</title>\n<style>{STYLE}</style>\n</head>\n<body>\n{body}</body>\n</html>\n",
        escape(title)
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

/// A swept value in a cell.
pub(crate) fn value(value: &serde_json::Value) -> String {
    value.as_f64().map_or_else(|| format_value(value), |x| format_short(x, 7))
}

/// The drawing with ids of its own, since ids are shared by all drawings of a page.
pub(crate) fn own_ids(svg: &str, prefix: &str) -> String {
    svg.replace("id=\"ground\"", &format!("id=\"{prefix}\"")).replace("url(#ground)", &format!("url(#{prefix})"))
}
