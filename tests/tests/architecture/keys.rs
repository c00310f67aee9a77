//! Each key of a study file is declared once: by a field of a struct.

use super::source::{each_source, workspace};

/// The text without the tests at its end.
fn without_tests(text: &str) -> &str {
    text.split("#[cfg(test)]\nmod tests {").next().unwrap_or(text)
}

/// Only the core describes keys by hand, and no card lists parameters: `Card::of` takes them from the type, whose derive makes
/// the reader and its defaults from the same fields.
#[test]
fn keys_are_declared_by_structs() {
    for folder in ["laws", "laws/external", "solvers", "studies"] {
        each_source(&workspace().join(folder).join("src"), &mut |path, text| {
            let text = without_tests(text);
            // The type of an argument is not a list of keys.
            let text = &text.replace("parameters: &[Parameter]", "");
            let place = path.display();
            for by_hand in ["Parameter::number(", "Quantity::of_unit(", "parameters: &[", "check: |value|"] {
                assert!(!text.contains(by_hand), "{place} declares a key by {by_hand}");
            }
            for part in text.split("Parameter {").skip(1) {
                assert!(!part.trim_start().starts_with("name: \""), "{place} declares a key beside its struct");
            }
            let cards = text.matches(" Card {\n").count();
            let of_types = text.matches("..Card::of::<").count() + text.matches("..Card::BLANK").count();
            assert!(cards <= of_types, "{place}: a card without `..Card::of` or `..Card::BLANK`");
        });
    }
}

/// A default is written once: serde's own attribute of defaults is in no struct whose keys a study file has.
#[test]
fn defaults_of_keys_have_one_source() {
    for folder in [
        "laws",
        "laws/external",
        "solvers",
        "studies/study/src/scenes",
        "studies/study/src/loads",
        "studies/report/src/kinds",
    ] {
        let root = workspace().join(folder);
        let root = if root.join("src").is_dir() { root.join("src") } else { root };
        each_source(&root, &mut |path, text| {
            let text = without_tests(text);
            for word in ["#[serde(default", "serde(flatten"] {
                assert!(!text.contains(word), "{} has {word}", path.display());
            }
        });
    }
}
