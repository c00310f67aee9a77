//! Suggestions for wrong names: by meaning, from the last table of the glossary, and by spelling.

use std::sync::LazyLock;
use voussoir_core::plugin::nearest;

/// The glossary, a copy of `docs/reference/glossary.md` in the package.
pub const GLOSSARY: &str = include_str!("../../templates/glossary.md");

/// The heading of the table of synonyms.
const HEADING: &str = "## Keys of study files by other words";

/// A row of the table.
struct Row {
    words: Vec<String>,
    name: &'static str,
    /// The table that has the key; empty if several tables have it.
    place: &'static str,
}

static ROWS: LazyLock<Vec<Row>> = LazyLock::new(|| {
    let (_, table) = GLOSSARY.split_once(HEADING).unwrap_or_default();
    let row = |line: &'static str| {
        let (words, right) = line.strip_prefix("| ")?.split_once(" | ")?;
        let (name, place) = right.strip_prefix('`')?.split_once('`')?;
        Some(Row { words: words.split(", ").map(plain).collect(), name, place: place.trim_end_matches([' ', '|']) })
    };
    table.lines().filter_map(row).collect()
});

/// Small letters; all other characters but letters and digits count as `_`.
fn plain(word: &str) -> String {
    let letters = word.trim().chars().map(|c| if c.is_alphanumeric() { c } else { '_' });
    letters.flat_map(char::to_lowercase).collect()
}

/// Returns the valid name with the same meaning; if no spelling is close either, the only name that contains the word.
pub fn nearest_name<'a>(wrong: &str, names: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    let names: Vec<&str> = names.into_iter().collect();
    let word = plain(wrong);
    let of_meaning = ROWS.iter().filter(|row| row.words.contains(&word)).find_map(|row| find(&names, row.name));
    of_meaning.or_else(|| nearest(wrong, names.iter().copied())).or_else(|| {
        let bare = |word: &str| word.replace('_', "");
        let contains = |name: &&&str| {
            let name = plain(name);
            bare(&name) == bare(&word) || name.split('_').any(|part| part == word)
        };
        let mut found = names.iter().filter(contains);
        found.next().copied().filter(|_| found.next().is_none())
    })
}

fn find<'a>(names: &[&'a str], name: &str) -> Option<&'a str> {
    names.iter().copied().find(|own| *own == name)
}

/// Returns the key with the meaning of a word, and its table: `"factor" of [[stages]]`.
pub fn key_elsewhere(wrong: &str) -> Option<String> {
    let word = plain(wrong);
    let row = ROWS.iter().find(|row| !row.place.is_empty() && row.words.contains(&word))?;
    Some(format!("\"{}\"{}", row.name, row.place.replace('`', "")))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::common_keys::common_parameters;
    use crate::study::study_keys;
    use std::collections::BTreeSet;
    use voussoir_core::plugin::{Parameter, PluginKind, Shape, cards};

    /// A word of the glossary leads to the key with its meaning, also if another key has a closer spelling.
    #[test]
    fn a_name_is_suggested_by_its_meaning() {
        let keys = ["friction", "friction_angle", "psi", "density", "cap_friction_angle"];
        for (wrong, right) in [
            ("friction_coefficient", "friction"),
            ("phi", "friction_angle"),
            ("Coefficient of friction", "friction"),
            ("unit-weight", "density"),
            ("frictoin", "friction"),
        ] {
            assert_eq!(nearest_name(wrong, keys), Some(right), "{wrong}");
        }
        assert_eq!(nearest_name("D4", ["en15528_d4", "en15528_d3", "cs454_single"]), Some("en15528_d4"));
        assert_eq!(nearest_name("EN 15528 D4", ["en15528_d4", "en15528_d3"]), Some("en15528_d4"));
        assert_eq!(nearest_name("cs454", ["cs454_single", "cs454_bogie_8t"]), None, "two names contain it");
        assert_eq!(key_elsewhere("thrust_line").as_deref(), Some("\"thrust_zone\" of [output]"));
    }

    fn names(parameters: &[Parameter], found: &mut BTreeSet<&'static str>) {
        for parameter in parameters {
            found.insert(parameter.name);
            of_shape(&parameter.shape, found);
        }
    }

    fn of_shape(shape: &Shape, found: &mut BTreeSet<&'static str>) {
        match shape {
            Shape::Table(keys) => names(keys, found),
            Shape::Choice(words) => found.extend(words.iter().copied()),
            Shape::List { of, .. } | Shape::Map(of) => of_shape(of, found),
            Shape::Either(shapes) => shapes.iter().for_each(|shape| of_shape(shape, found)),
            Shape::Tagged { variants, .. } => variants.iter().for_each(|variant| {
                found.insert(variant.tag);
                names(variant.parameters, found);
            }),
            _ => {}
        }
    }

    /// Every right name is a key, a choice or a tag, and no synonym is in two rows.
    #[test]
    fn the_table_names_keys_that_exist() {
        let mut known = BTreeSet::from(["auto"]);
        names(study_keys(), &mut known);
        PluginKind::ALL.into_iter().for_each(|kind| names(common_parameters(kind), &mut known));
        cards().iter().for_each(|card| {
            known.insert(card.tag);
            names(card.parameters, &mut known);
        });
        let mut seen = BTreeSet::new();
        assert!(ROWS.len() > 40, "{} rows", ROWS.len());
        for row in ROWS.iter() {
            assert!(known.contains(row.name), "{} is not a key", row.name);
            assert!(row.words.iter().all(|word| seen.insert(word.clone())), "a word of {} is there twice", row.name);
        }
    }
}
