//! Units and descriptions of the swept keys of a study, for columns, axes and titles.

use super::keys::study_keys;
use super::model::{Case, Study};
use super::resolved::Resolved;
use crate::config::expand::Expansion;
use crate::config::key_meaning::{KeyMeaning, key_meaning};
use crate::results::format::{format_quantity, format_value};
use serde_json::{Map, Value as Json};
use voussoir_core::plugin::Parameter;

/// Greatest number of cases in which keys are looked up.
const MAX_CASES: usize = 1000;

/// A swept key.
#[derive(Debug, Clone)]
struct SweptKey {
    key: String,
    /// Its different meanings in the variants and scenes.
    meanings: Vec<KeyMeaning>,
    /// True if all values are numbers.
    number: bool,
}

/// The swept keys of a study.
#[derive(Debug, Clone, Default)]
pub struct SweptKeys(Vec<SweptKey>);

/// Returns the meaning of a key in a case; `None` if the schema does not have the key.
pub fn meaning_in(resolved: &Resolved, key: &str) -> Option<KeyMeaning> {
    key_meaning(study_keys(), &|name| resolved.get(name), key)
}

impl SweptKeys {
    /// Returns the axes of an expansion. `parameters` are the top-level keys of the study file. One case is read for each
    /// variant, scene and text of an axis, because these decide which plug-in owns a key.
    pub fn of_expansion(parameters: &'static [Parameter], expansion: &Expansion) -> Self {
        let swept = |(key, number)| SweptKey { key, meanings: Vec::new(), number };
        let mut keys = SweptKeys(expansion.number_keys().into_iter().map(swept).collect());
        let ids = if keys.0.is_empty() { Vec::new() } else { expansion.one_of_each(MAX_CASES) };
        for case in ids.into_iter().filter_map(|id| expansion.case(id).ok()) {
            let root = case.root.to_json();
            for SweptKey { key, meanings, .. } in &mut keys.0 {
                let meaning = key_meaning(parameters, &|name| root.get(name), key);
                meanings.extend(meaning.filter(|meaning| !meanings.contains(meaning)));
            }
        }
        for SweptKey { meanings, .. } in &mut keys.0 {
            if meanings.iter().any(|meaning| meaning.used) {
                meanings.retain(|meaning| meaning.used);
            }
        }
        keys
    }

    /// Adds the keys of cases that a study kind has made.
    pub fn add_keys_of<'a>(&mut self, cases: impl Iterator<Item = &'a Case>) {
        for case in cases {
            for (key, value) in &case.parameters {
                if self.0.iter().all(|known| known.key != *key) {
                    let meanings = meaning_in(&case.resolved, key).into_iter().collect();
                    self.0.push(SweptKey { key: key.clone(), meanings, number: value.is_number() });
                }
            }
        }
    }

    fn meanings(&self, key: &str) -> &[KeyMeaning] {
        self.0.iter().find(|own| own.key == key).map_or(&[], |own| &own.meanings)
    }

    /// Returns true if all values of a key are numbers.
    pub fn is_number(&self, key: &str) -> bool {
        self.0.iter().any(|own| own.key == key && own.number)
    }

    /// Returns the first meaning of a key.
    pub fn first(&self, key: &str) -> Option<&KeyMeaning> {
        self.meanings(key).first()
    }

    /// Joins the different texts of the meanings of a key.
    fn joined(&self, key: &str, text: impl Fn(&KeyMeaning) -> String) -> String {
        let mut texts: Vec<String> = Vec::new();
        for text in self.meanings(key).iter().map(text) {
            if !texts.contains(&text) {
                texts.push(text);
            }
        }
        texts.join(" or ")
    }

    /// Returns the unit of a key; `m or -` if it has several. `None` for pure numbers, texts and unknown keys.
    pub fn unit(&self, key: &str) -> Option<String> {
        let unit = self.joined(key, |meaning| meaning.unit().unwrap_or("-").into());
        Some(unit).filter(|unit| !["", "-"].contains(&unit.as_str()))
    }

    /// Returns the name of a column: the key with its unit.
    pub fn column(&self, key: &str) -> String {
        self.with_unit(key, key.into())
    }

    /// Returns the description of a key; the key itself if the schema does not have it.
    pub fn words(&self, key: &str) -> String {
        self.told_apart(key, KeyMeaning::words, KeyMeaning::words_in_place)
    }

    /// Returns the description of a key, after the names of the tables above it.
    pub fn words_in_place(&self, key: &str) -> String {
        Some(self.joined(key, KeyMeaning::words_in_place)).filter(|words| !words.is_empty()).unwrap_or(key.into())
    }

    /// Returns the title of an axis or a column: `rise of the intrados [m]`.
    pub fn title(&self, key: &str) -> String {
        self.with_unit(key, self.words(key))
    }

    /// Returns values of keys in one line: `rise = 2.99 m, friction = 0.6`.
    pub fn text(&self, values: &Map<String, Json>) -> String {
        let entries = values.iter().map(|(key, value)| format!("{} = {}", self.name(key), self.value(key, value)));
        entries.collect::<Vec<_>>().join(", ")
    }

    /// Returns names (such as the variant) and values of keys in one line: `10 MPa, rise = 2.99 m`; empty without any of them.
    pub fn named<'a>(&self, names: impl IntoIterator<Item = &'a str>, values: &Map<String, Json>) -> String {
        let swept = Some(self.text(values)).filter(|text| !text.is_empty());
        names.into_iter().map(String::from).chain(swept).collect::<Vec<_>>().join(", ")
    }

    /// Returns the short name of a key; the whole key if another one has the same name.
    pub fn name(&self, key: &str) -> String {
        self.told_apart(key, KeyMeaning::short_name, |_| key.into())
    }

    /// Returns the value of a key with its unit; a text already contains its unit. Stresses have the unit that gives the
    /// shortest number.
    pub fn value(&self, key: &str, value: &Json) -> String {
        match value.as_f64() {
            Some(number) => format_quantity(number, &self.unit(key).unwrap_or_default()),
            None => format_value(value),
        }
    }

    fn with_unit(&self, key: &str, words: String) -> String {
        self.unit(key).map_or(words.clone(), |unit| format!("{words} [{unit}]"))
    }

    /// Returns the short text of a key, or the long one if another key has the same short one.
    fn told_apart(&self, key: &str, short: fn(&KeyMeaning) -> String, long: impl Fn(&KeyMeaning) -> String) -> String {
        if self.meanings(key).is_empty() {
            return key.into();
        }
        let own = self.joined(key, short);
        let shared = self.0.iter().any(|other| other.key != key && self.joined(&other.key, short) == own);
        if shared { self.joined(key, long) } else { own }
    }
}

impl Study {
    /// Units and words of the swept keys.
    pub fn swept_keys(&self) -> SweptKeys {
        SweptKeys::of_expansion(study_keys(), &self.expansion)
    }
}
