//! The page in the browser: drawings, result, sliders.

use super::controls::controls;
use crate::figures::plot::svg::escape;
use crate::writers::page;
use serde_json::Value as Json;

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
    /// The checked keys of the case.
    pub resolved: &'a Json,
}

/// Returns the page of a case as HTML.
pub(super) fn page(shown: &Shown) -> String {
    let mut body = format!("<h1>{}</h1>\n", escape(shown.name));
    if shown.kind != "run" {
        body += &format!(
            "<p class=\"quiet\">Its kind is {}: here its cases are answered one at a time.</p>\n",
            escape(shown.kind)
        );
    }
    body += &choice(shown);
    body += &format!(
        "<div id=\"live\" data-case=\"{}\">\n{SEEN}<form>\n{}</form>\n</div>\n",
        shown.case,
        controls(shown.resolved)
    );
    body += "<noscript>This page needs its script.</noscript>\n";
    page::served(shown.name, &body)
}

/// Returns a list of the study's cases.
fn choice(shown: &Shown) -> String {
    let labels = match &shown.labels {
        Some(labels) if labels.len() > 1 => labels,
        Some(_) => return String::new(),
        None => return format!("<p class=\"quiet\">Case {} of {}.</p>\n", shown.case, shown.count),
    };
    let options = labels.iter().enumerate().map(|(id, label)| {
        let selected = if id == shown.case { " selected" } else { "" };
        format!("<option value=\"{id}\"{selected}>{}</option>", escape(label))
    });
    format!("<p><label>Case <select id=\"case\">{}</select></label></p>\n", options.collect::<String>())
}

/// Section for the result; the script of the page fills it.
const SEEN: &str = "<section class=\"seen\">\n<p class=\"summary\" role=\"status\"><strong id=\"headline\">…</strong></p>\n\
<pre id=\"mistakes\" class=\"bad\" role=\"alert\" hidden></pre>\n\
<figure class=\"moving\"><svg id=\"statics\" role=\"img\" aria-label=\"the scene with its thrust line and loads\"></svg>\
<figcaption>Forces at the answer. Drag a load by its arrow, or move it with the arrow keys.</figcaption></figure>\n\
<figure class=\"moving\"><svg id=\"mechanism\" role=\"img\" aria-label=\"the mechanism\"></svg>\
<figcaption><span id=\"kind\"></span> <label>motion <input id=\"motion\" type=\"range\" min=\"0\" max=\"100\" value=\"60\"></label>\
</figcaption></figure>\n<p class=\"quiet\"><span id=\"proof\"></span> <span id=\"time\"></span></p>\n<ul id=\"notes\" class=\"quiet\"></ul>\n\
<p class=\"buttons\"><button type=\"button\" id=\"copy\">Copy the study file</button> \
<button type=\"button\" id=\"reset\">Reset</button> <button type=\"button\" id=\"report\">Its report</button> \
<span id=\"said\" role=\"status\"></span></p>\n<details><summary>Study file</summary><pre id=\"toml\"></pre></details>\n</section>\n";
