//! The inputs of a study for a page: geometry, materials, joints, loads, stages and solver in words, with units.

use super::assumptions::{assumptions, sources};
use crate::figures::format::{escape, format_short, format_value, unit_of_key};
use crate::figures::words::words_of_key;
use crate::study::{Case, Study};
use serde_json::Value as Json;
use std::collections::HashSet;
use std::fmt::Write;

/// Longest list of numbers that is written out.
const LISTED: usize = 8;

/// Headings of the record with the tables of a study file that stand under them.
const SECTIONS: [(&str, &str); 7] = [
    ("Geometry", "scene"),
    ("Materials", "materials"),
    ("Joints", "joints"),
    ("Vehicles", "vehicles"),
    ("Stages and loads", "stages"),
    ("Partial factors on these values", "factors"),
    ("Solver", "solver"),
];

/// The calculation record of a study, as HTML: what its first case was given, defaults included, in SI units, then
/// what varies from case to case.
pub fn record(study: &Study) -> String {
    let Some(case) = study.cases.first() else { return String::new() };
    let mut text = String::from("<div class=\"record\">\n");
    for (heading, table) in SECTIONS {
        let value = &case.resolved[table];
        if value.as_object().is_some_and(|map| map.is_empty()) || value.is_null() {
            continue;
        }
        text += &section(heading, &rows_of(table, value, case));
    }
    text += &section("What varies", &varied(study));
    text += &section("Assumptions", &assumptions(case));
    text += &section("Sources", &sources(case));
    text + "</div>\n"
}

/// One table of words and values under a heading; nothing where there are none.
pub fn section(heading: &str, rows: &[(String, String)]) -> String {
    if rows.is_empty() {
        return String::new();
    }
    let mut text = format!("<section><h4>{heading}</h4><table class=\"inputs\">\n");
    for (words, value) in rows {
        let _ = writeln!(text, "<tr><th scope=\"row\">{}</th><td>{}</td></tr>", escape(words), escape(value));
    }
    text + "</table></section>\n"
}

fn rows_of(table: &str, value: &Json, case: &Case) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    gather(&mut rows, table, "", value);
    if table == "scene" {
        let free = case.assembly.bodies.iter().filter(|body| !body.fixed).count();
        rows.push(("blocks that are free, joints".into(), format!("{free}, {}", case.assembly.joints.len())));
    }
    rows
}

/// Rows of everything below a value; names that a user has chosen stand before the words.
fn gather(rows: &mut Vec<(String, String)>, key: &str, before: &str, value: &Json) {
    match value {
        Json::Object(map) => {
            for (name, inner) in map {
                let path = format!("{key}.{name}");
                // Names of materials and joints are the user's.
                let named = ["materials", "joints", "vehicles"].contains(&key);
                // Fill, haunching and mesh have keys of the same names as the scene.
                let part = key == "scene" && inner.is_object() && name != "profile";
                let before = if named || part { format!("{name}: ") } else { before.to_string() };
                gather(rows, &path, &before, inner);
            }
        }
        Json::Array(items) if items.iter().any(Json::is_object) => {
            for (index, item) in items.iter().enumerate() {
                let name = item["name"].as_str().or(item["kind"].as_str()).map(str::to_string);
                let list = key.rsplit('.').next().unwrap_or_default();
                let one = list.strip_suffix('s').unwrap_or(list);
                let before = format!("{before}{}: ", name.unwrap_or_else(|| format!("{one} {}", index + 1)));
                gather(rows, &format!("{key}.{index}"), &before, item);
            }
        }
        Json::Null => {}
        Json::Array(items) if items.is_empty() => {}
        value => {
            // Both stand before the words already.
            if ["name", "kind"].contains(&key.rsplit('.').next().unwrap_or_default()) {
                return;
            }
            rows.push((format!("{before}{}", words(key)), shown(key, value)));
        }
    }
}

/// A key in words; the word that chooses a plug-in says of what.
fn words(key: &str) -> String {
    let mut names = key.rsplit('.');
    match names.next().unwrap_or_default() {
        "law" if key.starts_with("scene.") => names.next().unwrap_or("law").into(),
        "law" => "law".into(),
        "scene" => "scene".into(),
        "solver" => "solver".into(),
        "strategy" => "continuation".into(),
        _ => words_of_key(key),
    }
}

/// A value with its unit.
fn shown(key: &str, value: &Json) -> String {
    let unit = unit_of_key(key).map_or(String::new(), |unit| format!(" {unit}"));
    match value {
        Json::Number(_) => quantity(value.as_f64().unwrap_or(f64::NAN), unit.trim()),
        Json::Array(items) => {
            let listed: Vec<String> = items.iter().take(LISTED).map(|item| shown("", item)).collect();
            let more = items.len().saturating_sub(LISTED);
            let more = if more > 0 { format!(", and {more} more") } else { String::new() };
            format!("[{}{more}]{unit}", listed.join(", "))
        }
        Json::String(word) => word.clone(),
        Json::Bool(truth) => if *truth { "yes" } else { "no" }.into(),
        other => other.to_string(),
    }
}

/// A number with its unit; stresses in the unit in which they are short.
fn quantity(x: f64, unit: &str) -> String {
    let (x, unit) = match unit {
        "Pa" if x.abs() >= 1e9 => (x / 1e9, "GPa"),
        "Pa" if x.abs() >= 1e5 => (x / 1e6, "MPa"),
        unit => (x, unit),
    };
    format!("{} {unit}", format_short(x, 7)).trim_end().to_string()
}

/// Axes of the sweep with their values, and the variants.
fn varied(study: &Study) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    for key in study.outline.axes.iter().flat_map(|(keys, _)| keys) {
        let mut seen = HashSet::new();
        let swept = study.cases.iter().filter_map(|case| case.parameters.get(key));
        let values: Vec<&Json> = swept.filter(|value| seen.insert(value.to_string())).collect();
        let unit = unit_of_key(key).map_or(String::new(), |unit| format!(" {unit}"));
        let words = match values.as_slice() {
            [] => continue,
            [first, .., last] if values.len() > LISTED => {
                format!("{} … {}{unit} ({} values)", format_value(first), format_value(last), values.len())
            }
            few => format!("{}{unit}", few.iter().map(|value| format_value(value)).collect::<Vec<_>>().join(", ")),
        };
        rows.push((words_of_key(key), words));
    }
    if !study.outline.variants.is_empty() {
        rows.push(("variants".into(), study.outline.variants.join("; ")));
    }
    rows
}
