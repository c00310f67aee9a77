//! The topics of `voussoir explain` besides plug-ins: words about studies, and every key of a study file.

use std::collections::BTreeSet;
use voussoir_core::plugin::{Card, Need, Parameter, PluginKind, Quantity, Shape, Variant, cards, cards_of};
use voussoir_study::config::documented_vehicles;
use voussoir_study::config::key_meaning::quantity_of;
use voussoir_study::config::synonyms::GLOSSARY;
use voussoir_study::study::study_keys;

/// Words with their own page. The first word of each row is the name of the page.
const PAGES: [(&[&str], &str); 9] = [
    (&["auto"], include_str!("topics/auto.md")),
    (&["loads", "load"], include_str!("topics/loads.md")),
    (&["profiles", "profile", "shape", "shapes"], include_str!("topics/profiles.md")),
    (&["results", "result", "output"], include_str!("topics/results.md")),
    (&["settlement", "settlements"], include_str!("topics/settlement.md")),
    (&["stages", "stage"], include_str!("topics/stages.md")),
    (&["status", "statuses"], include_str!("topics/status.md")),
    (&["sweep", "sweeps", "variants", "variant", "zip"], include_str!("topics/sweep.md")),
    (&["units", "unit"], include_str!("topics/units.md")),
];

/// Words of the glossary with their meaning. Each row of its tables explains the words of its first column.
fn glossary() -> impl Iterator<Item = (&'static str, &'static str)> {
    let rows = GLOSSARY.lines().filter_map(|line| line.strip_prefix("| ")?.split_once(" | "));
    let rows = rows.filter(|(words, _)| *words != "word");
    rows.flat_map(|(words, meaning)| {
        words.split(", ").map(move |word| (word.trim(), meaning.trim_end_matches([' ', '|'])))
    })
}

/// Names of the pages, and all words other than tags that `explain` accepts.
pub fn words() -> BTreeSet<String> {
    let mut words: BTreeSet<String> =
        PAGES.iter().flat_map(|(names, _)| names.iter()).map(ToString::to_string).collect();
    each_key(&mut |place| {
        words.insert(place.name().into());
    });
    words.extend(glossary().map(|(word, _)| word.to_string()));
    words.extend(documented_vehicles::names());
    words
}

/// Returns the explanation of a word; empty if the word is unknown.
pub fn explain(word: &str) -> String {
    let page = PAGES.iter().find(|(names, _)| names.contains(&word)).map(|(_, page)| page.to_string());
    let mut text = page.unwrap_or_default();
    if PAGES[2].0.contains(&word) {
        text += &profiles();
    }
    let mut keys: Vec<String> = Vec::new();
    each_key(&mut |place| {
        let line = place.line();
        if place.name() == word && !keys.contains(&line) {
            keys.push(line);
        }
    });
    for (name, meaning) in glossary().filter(|(name, _)| *name == word) {
        text += &format!("{name}: {meaning}\n");
    }
    if let Some(lines) = documented_vehicles::lines_of(word) {
        text += &format!("a documented vehicle, which a study may name without an entry of [vehicles]:\n\n{lines}");
    }
    if !keys.is_empty() {
        text += &format!("{}as a key of a study file:\n{}", if text.is_empty() { "" } else { "\n" }, keys.concat());
    }
    text
}

/// The shapes of profiles with their keys.
fn profiles() -> String {
    let mut text = String::new();
    each_key(&mut |place| {
        if let Place::Word { key: "shape", variant, .. } = place
            && !text.contains(&format!("\n{}:", variant.tag))
        {
            let keys = variant.parameters.iter().map(|key| format!("    {}\n", describe(key)));
            text += &format!("\n{}: {}\n{}", variant.tag, variant.doc, keys.collect::<String>());
        }
    });
    text
}

/// A key, or a word that decides which keys a table has.
enum Place<'a> {
    Key { path: &'a str, key: &'a Parameter },
    Word { path: &'a str, key: &'static str, variant: &'static Variant },
}

impl Place<'_> {
    fn name(&self) -> &'static str {
        match self {
            Place::Key { key, .. } => key.name,
            Place::Word { variant, .. } => variant.tag,
        }
    }

    fn line(&self) -> String {
        match self {
            Place::Key { path, key } => format!("  {path}: {}\n{}", describe(key), inside(&key.shape)),
            Place::Word { path, key, variant } => {
                let keys = variant.parameters.iter().map(|key| format!("    {}\n", describe(key)));
                format!("  {path} = {{ {key} = \"{}\" }}: {}\n{}", variant.tag, variant.doc, keys.collect::<String>())
            }
        }
    }
}

/// Returns name, unit, meaning and requirement of a key.
pub fn describe(key: &Parameter) -> String {
    let unit = match &key.shape {
        Shape::Number(quantity, range) => {
            let unit = if quantity.unit().is_empty() { "-" } else { quantity.unit() };
            format!(" [{unit}], {}", range.describe())
        }
        Shape::Choice(words) => format!(", one of {}", words.join(", ")),
        shape => match quantity_of(shape).map(Quantity::unit) {
            None | Some("") => String::new(),
            Some(unit) => format!(" [{unit}]"),
        },
    };
    let need = match key.need {
        Need::Required => "required".to_string(),
        Need::Optional(otherwise) => format!("optional: otherwise {otherwise}"),
        Need::Default(value) => format!("default {value}"),
    };
    format!("{}{unit}  {} ({need})", key.name, key.doc)
}

/// The keys of a table, or of the tables of a list.
fn inside(shape: &Shape) -> String {
    match shape {
        Shape::Table(keys) => keys.iter().map(|key| format!("    {}\n", describe(key))).collect(),
        Shape::List { of, .. } | Shape::Map(of) => inside(of),
        Shape::Either(shapes) => shapes.iter().map(inside).find(|text| !text.is_empty()).unwrap_or_default(),
        Shape::Plugin(kind) => format!("    one of: {}\n", tags(*kind).join(", ")),
        _ => String::new(),
    }
}

fn tags(kind: PluginKind) -> Vec<&'static str> {
    cards_of(kind).into_iter().map(|card| card.tag).collect()
}

/// Visits every key of a study file with a scene, and of every plug-in.
fn each_key(see: &mut dyn FnMut(&Place<'_>)) {
    for key in study_keys() {
        walk(key.name, key, see);
    }
    for card in cards() {
        let path = of_card(card);
        for key in card.parameters {
            walk(&format!("{path}.{}", key.name), key, see);
        }
    }
}

/// Returns the place of a plug-in's keys in a study file.
fn of_card(card: &Card) -> String {
    format!("{} \"{}\"", card.kind.describe(), card.tag)
}

fn walk(path: &str, key: &Parameter, see: &mut dyn FnMut(&Place<'_>)) {
    see(&Place::Key { path, key });
    walk_shape(path, &key.shape, see);
}

fn walk_shape(path: &str, shape: &Shape, see: &mut dyn FnMut(&Place<'_>)) {
    match shape {
        Shape::Table(keys) => keys.iter().for_each(|key| walk(&format!("{path}.{}", key.name), key, see)),
        Shape::List { of, .. } => walk_shape(&format!("{path}[]"), of, see),
        Shape::Map(of) => walk_shape(&format!("{path}.NAME"), of, see),
        Shape::Either(shapes) => shapes.iter().for_each(|shape| walk_shape(path, shape, see)),
        Shape::Tagged { key, variants } => {
            for variant in *variants {
                see(&Place::Word { path, key, variant });
                variant.parameters.iter().for_each(|key| walk(&format!("{path}.{}", key.name), key, see));
            }
        }
        _ => {}
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use voussoir_core::plugin::nearest;

    /// Words of the glossary and documented vehicles are explained, and they are suggested for similar words.
    #[test]
    fn glossary_and_vehicles_are_known() {
        assert!(explain("extrados").contains("the inner and the outer line"), "{}", explain("extrados"));
        assert!(explain("cs454_single").contains("axles = ["));
        let words = words();
        for (wrong, right) in [("extradso", "extrados"), ("cs454_singel", "cs454_single"), ("redundnats", "redundants")]
        {
            assert_eq!(nearest(wrong, words.iter().map(String::as_str)), Some(right));
        }
    }
}
