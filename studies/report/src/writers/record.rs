//! The inputs of a study for a page: geometry, materials, joints, loads, stages and solver in words, with units.

use super::assumptions::{assumptions, sources};
use maud::{Markup, html};
use serde_json::Value as Json;
use std::collections::HashSet;
use voussoir_study::config::dotted_key::join;
use voussoir_study::config::key_meaning::KeyMeaning;
use voussoir_study::results::format::{format_quantity, format_value};
use voussoir_study::study::{Case, Study, meaning_in};

/// Greatest length of a list of numbers that is shown completely.
const LISTED: usize = 8;

/// Headings of the record, with the tables of a study file that belong to each.
const SECTIONS: [(&str, &str); 7] = [
    ("Geometry", "scene"),
    ("Materials", "materials"),
    ("Joints", "joints"),
    ("Vehicles", "vehicles"),
    ("Stages and loads", "stages"),
    ("Partial factors on these values", "factors"),
    ("Solver", "solver"),
];

/// The calculation record of a study: the inputs of its first case in SI units, including defaults, then the values
/// that differ between cases.
pub fn record(study: &Study) -> Markup {
    html! {
        @if let Some(case) = study.case(0) {
            @let case = case.as_ref();
            div class="record" {
                @for (heading, table) in SECTIONS {
                    @let value = &case.resolved[table];
                    @if !value.is_null() && value.as_object().is_none_or(|map| !map.is_empty()) {
                        (section(heading, &rows_of(table, value, case)))
                    }
                }
                (section("What varies", &varied(study)))
                (section("Assumptions", &assumptions(case)))
                (section("Sources", &sources(case)))
            }
        }
    }
}

/// A table of words and values under a heading; empty if it has no rows.
pub fn section(heading: &str, rows: &[(String, String)]) -> Markup {
    html! {
        @if !rows.is_empty() {
            section {
                h4 { (heading) }
                table class="inputs" { @for (words, value) in rows { tr { th scope="row" { (words) } td { (value) } } } }
            }
        }
    }
}

fn rows_of(table: &str, value: &Json, case: &Case) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    gather(&mut rows, table, value, case);
    if table == "scene" {
        let free = case.assembly.bodies.iter().filter(|body| !body.fixed).count();
        rows.push(("free blocks".into(), free.to_string()));
        rows.push(("joints".into(), case.assembly.joints.len().to_string()));
    }
    rows
}

/// Adds rows for all keys below a value.
fn gather(rows: &mut Vec<(String, String)>, key: &str, value: &Json, case: &Case) {
    match value {
        Json::Object(map) => {
            // The descriptions of the other keys contain the name of the table.
            let below = map.iter().filter(|(name, value)| *name != "name" || !value.is_string());
            below.for_each(|(name, inner)| gather(rows, &join(key, name), inner, case));
        }
        Json::Array(items) if items.iter().any(Json::is_object) => {
            let entries = items.iter().enumerate();
            entries.for_each(|(index, item)| gather(rows, &join(key, &index.to_string()), item, case));
        }
        Json::Null => {}
        Json::Array(items) if items.is_empty() => {}
        value => {
            let meaning = meaning_in(&case.resolved, key);
            // The descriptions of the other keys contain the kind of the load.
            if meaning.as_ref().is_some_and(|meaning| is_in_place(meaning, value)) {
                return;
            }
            let words = meaning.map_or(key.to_string(), |meaning| meaning.words_in_place());
            rows.push((words, shown(key, value, case)));
        }
    }
}

/// Returns true if a word that chooses the keys of a table is also the name of the table.
fn is_in_place(meaning: &KeyMeaning, value: &Json) -> bool {
    let name = meaning.place.last().zip(value.as_str());
    meaning.tag && name.is_some_and(|(name, word)| name.split(' ').next() == Some(word))
}

/// Formats a value with its unit.
fn shown(key: &str, value: &Json, case: &Case) -> String {
    let unit = meaning_in(&case.resolved, key).and_then(|meaning| meaning.unit()).unwrap_or_default();
    match value {
        Json::Number(_) => format_quantity(value.as_f64().unwrap_or(f64::NAN), unit),
        Json::Array(items) => {
            // If the list has no common unit, each entry shows its unit.
            let entry = |(index, item): (usize, &Json)| match unit {
                "" => shown(&join(key, &index.to_string()), item, case),
                _ => plain(item),
            };
            let listed: Vec<String> = items.iter().enumerate().take(LISTED).map(entry).collect();
            let more = items.len().saturating_sub(LISTED);
            let more = if more > 0 { format!(", and {more} more") } else { String::new() };
            format!("[{}{more}] {unit}", listed.join(", ")).trim_end().to_string()
        }
        other => plain(other),
    }
}

/// Formats a value without a unit.
fn plain(value: &Json) -> String {
    match value {
        Json::Array(items) => {
            let listed: Vec<String> = items.iter().take(LISTED).map(plain).collect();
            let more = items.len().saturating_sub(LISTED);
            let more = if more > 0 { format!(", and {more} more") } else { String::new() };
            format!("[{}{more}]", listed.join(", "))
        }
        Json::Bool(truth) => if *truth { "yes" } else { "no" }.into(),
        other => format_value(other),
    }
}

/// The axes of the sweep with their values, and the variants.
fn varied(study: &Study) -> Vec<(String, String)> {
    let (mut rows, keys) = (Vec::new(), study.swept_keys());
    for key in study.outline.axes.iter().flat_map(|(keys, _)| keys) {
        let mut seen = HashSet::new();
        let values: Vec<Json> = study.values(key).into_iter().filter(|value| seen.insert(value.to_string())).collect();
        // Texts contain their units.
        let unit = keys.unit(key).filter(|_| values.iter().all(|value| value.is_number()));
        let unit = unit.map_or(String::new(), |unit| format!(" {unit}"));
        let words = match values.as_slice() {
            [] => continue,
            [first, .., last] if values.len() > LISTED => {
                format!("{} … {}{unit} ({} values)", format_value(first), format_value(last), values.len())
            }
            few => format!("{}{unit}", few.iter().map(format_value).collect::<Vec<_>>().join(", ")),
        };
        rows.push((keys.words_in_place(key), words));
    }
    if !study.outline.variants.is_empty() {
        rows.push(("variants".into(), study.outline.variants.join("; ")));
    }
    rows
}
