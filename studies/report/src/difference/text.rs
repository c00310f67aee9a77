//! The differences of two runs as a table for the terminal.

use super::compare::{CaseDifference, CaseName, Change, RunDifference};
use comfy_table::{ContentArrangement, Table, presets};
use serde_json::Value as Json;
use voussoir_study::results::format::format_short;

/// Greatest number of rows of a list.
const MAX_ROWS: usize = 40;
/// Significant digits of a result.
const DIGITS: usize = 9;
/// Significant digits of a change.
const CHANGE_DIGITS: usize = 4;

impl RunDifference {
    /// The differences in words, the largest changes first. Long lists are cut; [`RunDifference`] as JSON has all entries.
    pub fn text(&self) -> String {
        let mut text: String = [("A", &self.runs[0]), ("B", &self.runs[1])]
            .iter()
            .map(|(side, run)| format!("{side}: study \"{}\", voussoir {}\n", run.study, run.program))
            .collect();
        text += &self.inputs_text();
        for (side, cases) in [("A", &self.only_a), ("B", &self.only_b)] {
            let lines: Vec<String> = cases.iter().map(|case| format!("  {}", case_words(case))).collect();
            text += &section(&format!("cases that only {side} has"), lines);
        }
        if !self.cases.is_empty() {
            text += &format!("\nresults that differ by more than {:e}, the largest change first:\n", self.tolerance);
            let shown: Vec<&CaseDifference> = self.cases.iter().take(MAX_ROWS).collect();
            text += &cases_table(&shown);
            text += &more(self.cases.len(), "cases");
        }
        if !self.others.is_empty() {
            let rows: Vec<[String; 5]> = self.others.iter().take(MAX_ROWS).map(change_cells).collect();
            text += &format!("\nother results that differ by more than {:e}:\n", self.tolerance);
            text += &table(["entry", "A", "B", "B - A", "relative"], rows);
            text += &more(self.others.len(), "entries");
        }
        text + &self.summary()
    }

    fn inputs_text(&self) -> String {
        let Some(inputs) = &self.inputs else {
            return "\nkeys of the studies are not compared: a folder has no resolved.toml\n".into();
        };
        if inputs.is_empty() {
            return String::new();
        }
        let rows = inputs.iter().take(MAX_ROWS).map(|own| {
            let [a, b] = own.words();
            [own.key.clone(), a, b]
        });
        let rows = table(["key", "A", "B"], rows.collect());
        format!("\nkeys of the studies that differ:\n{rows}{}", more(inputs.len(), "keys"))
    }

    /// The last line: the counts.
    fn summary(&self) -> String {
        let same = self.compared - self.cases.len();
        if self.is_equal() {
            return format!("\n{}: equal within {:e}\n", count(self.compared, "case"), self.tolerance);
        }
        let mut parts = vec![format!("{} equal", count(same, "case")), format!("{} differ", self.cases.len())];
        let only = [("A", &self.only_a), ("B", &self.only_b)];
        let only = only.iter().filter(|(_, cases)| !cases.is_empty());
        parts.extend(only.map(|(side, cases)| format!("{} only in {side}", cases.len())));
        format!("\n{}\n", parts.join(", "))
    }
}

fn count(count: usize, what: &str) -> String {
    format!("{count} {what}{}", if count == 1 { "" } else { "s" })
}

/// A heading with lines, cut at [`MAX_ROWS`]; empty without lines.
fn section(heading: &str, lines: Vec<String>) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let shown: String = lines.iter().take(MAX_ROWS).map(|line| format!("{line}\n")).collect();
    format!("\n{heading}:\n{shown}{}", more(lines.len(), "cases"))
}

/// States how many entries are not shown.
fn more(count: usize, what: &str) -> String {
    match count.saturating_sub(MAX_ROWS) {
        0 => String::new(),
        rest => format!("  {rest} more {what} are not shown; --json lists all\n"),
    }
}

fn case_words(case: &CaseName) -> String {
    let name = if case.name.is_empty() { String::new() } else { format!(": {}", case.name) };
    format!("case {}{name}", case.id)
}

/// One row for each change; the first row of a case has its name.
fn cases_table(cases: &[&CaseDifference]) -> String {
    let named = cases.iter().any(|case| !case.a.name.is_empty());
    let mut rows: Vec<Vec<String>> = Vec::new();
    for case in cases {
        let id = if case.a.id == case.b.id { case.a.id.to_string() } else { format!("{}, {}", case.a.id, case.b.id) };
        for (place, change) in case.changes.iter().enumerate() {
            let own = |text: &str| if place == 0 { text.to_string() } else { String::new() };
            let mut row = vec![own(&id)];
            row.extend(named.then(|| own(&case.a.name)));
            row.extend(change_cells(change));
            rows.push(row);
        }
    }
    let mut header = vec!["case"];
    header.extend(named.then_some("variant and swept values"));
    header.extend(["result", "A", "B", "B - A", "relative"]);
    lines(&header, &rows)
}

/// Name, both values, absolute and relative change.
fn change_cells(change: &Change) -> [String; 5] {
    let difference = change.a.as_f64().zip(change.b.as_f64()).map(|(a, b)| signed(b - a, ""));
    let relative = change.relative.map(|share| signed(100.0 * share, " %"));
    [
        change.entry.replace('_', " "),
        value(&change.a),
        value(&change.b),
        difference.unwrap_or_default(),
        relative.unwrap_or_default(),
    ]
}

fn signed(x: f64, unit: &str) -> String {
    format!("{}{}{unit}", if x > 0.0 { "+" } else { "" }, format_short(x, CHANGE_DIGITS))
}

/// A value in a cell; `-` without a value.
fn value(value: &Json) -> String {
    match value {
        Json::Null => "-".into(),
        Json::Bool(truth) => if *truth { "yes" } else { "no" }.into(),
        Json::String(text) => text.clone(),
        Json::Array(items) if items.is_empty() => "-".into(),
        Json::Array(items) => items
            .iter()
            .map(|item| match item {
                Json::Array(pair) => pair.iter().map(self::value).collect::<Vec<_>>().join(" "),
                item => self::value(item),
            })
            .collect::<Vec<_>>()
            .join(", "),
        other => other.as_f64().map_or_else(|| other.to_string(), |x| format_short(x, DIGITS)),
    }
}

fn table<const N: usize>(header: [&str; N], rows: Vec<[String; N]>) -> String {
    lines(&header, &rows.into_iter().map(Vec::from).collect::<Vec<_>>())
}

fn lines(header: &[&str], rows: &[Vec<String>]) -> String {
    let mut table = Table::new();
    table.load_style(presets::NOTHING).set_content_arrangement(ContentArrangement::Disabled).set_header(header);
    for row in rows {
        table.add_row(row);
    }
    table.to_string().lines().map(|line| line.trim_end().to_string() + "\n").collect()
}
