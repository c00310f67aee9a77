//! The unit and the description of a key, from the schema of the plug-in that owns it. Both are looked up only here.
//!
//! The key is followed segment by segment, through the schema and through the values of a study at the same time. Only the
//! values name the owner: the law of this joint, the kind of this load, the shape of this profile.

use super::common_keys::{common_parameters, word_for};
use super::dotted_key::segments;
use serde_json::Value as Json;
use voussoir_core::plugin::{Parameter, PluginKind, Quantity, Shape, candidate, candidates};

/// Greatest length of the description of a key \[bytes\].
const MAX_WORDS: usize = 60;

/// The meaning of a key by the schema.
#[derive(Debug, Clone, PartialEq)]
pub struct KeyMeaning {
    /// Name of the parameter in the schema.
    pub name: &'static str,
    /// Text of the schema.
    pub doc: &'static str,
    /// Name of the table that holds the parameter, in the schema.
    pub table: Option<&'static str>,
    /// Names of the tables and list entries above the key: `live`, `axle 1`.
    pub place: Vec<String>,
    /// Entries of lists below the parameter: `x`, `number 2`.
    pub entries: Vec<String>,
    /// True if the chosen plug-in has the key. Otherwise another plug-in of the same kind has it, and the key is unused.
    pub used: bool,
    /// True if the word under the key chooses a plug-in, or the keys of its table.
    pub tag: bool,
    /// Quantity of the number, or of all numbers of the list.
    pub quantity: Option<Quantity>,
}

impl KeyMeaning {
    /// Returns the unit; `None` for pure numbers, texts and tables.
    pub fn unit(&self) -> Option<&'static str> {
        self.quantity.map(Quantity::unit).filter(|unit| !unit.is_empty())
    }

    /// Returns a short description for an axis or a row: `rise of the intrados`.
    pub fn words(&self) -> String {
        if self.tag {
            return self.doc.into();
        }
        let entries = self.entries.iter().map(|entry| format!(", {entry}"));
        short_words(self.name, self.doc) + &entries.collect::<String>()
    }

    /// Returns the description after the names of the tables above: `live: vehicle: at, x of the vehicle's origin`.
    pub fn words_in_place(&self) -> String {
        self.place.iter().cloned().chain([self.words()]).collect::<Vec<_>>().join(": ")
    }

    /// Returns the description with the unit.
    pub fn title(&self) -> String {
        self.unit().map_or(self.words_in_place(), |unit| format!("{} [{unit}]", self.words_in_place()))
    }

    /// Returns the name of the key without the tables above, for lists of values: `rise`, `force, y`.
    pub fn short_name(&self) -> String {
        let entries = self.entries.iter().map(|entry| format!(", {entry}"));
        self.name.to_string() + &entries.collect::<String>()
    }
}

/// Returns the first clause of the schema's text, with the name of the key if the clause does not contain it.
fn short_words(name: &str, doc: &str) -> String {
    let end = doc.find([',', ':', ';', '(']).unwrap_or(doc.len());
    let (clause, name) = (doc[..end].trim(), name.replace('_', " "));
    // A clause before a colon explains the choices, not the key.
    if clause.is_empty() || clause.len() > MAX_WORDS || doc[end..].starts_with(':') {
        return name;
    }
    if clause.starts_with("of ") {
        return format!("{name} {clause}");
    }
    let lower = clause.to_lowercase();
    let start = |word: &str| word.chars().take(5).collect::<String>().to_lowercase();
    let named = name.split(' ').any(|word| lower.contains(&start(word)));
    if named { clause.into() } else { format!("{name}, {clause}") }
}

/// Returns the quantity of a number, or of a list if all its numbers have the same one; whole numbers are ratios.
pub fn quantity_of(shape: &Shape) -> Option<Quantity> {
    match shape {
        Shape::Number(quantity, _) => Some(*quantity),
        Shape::Integer { .. } => Some(Quantity::Ratio),
        Shape::List { of, .. } => quantity_of(of),
        Shape::Tuple(entries) => {
            let first = quantity_of(&entries.first()?.1)?;
            entries.iter().all(|(_, shape)| quantity_of(shape) == Some(first)).then_some(first)
        }
        Shape::Either(shapes) => shapes.iter().find_map(quantity_of),
        _ => None,
    }
}

/// Returns the meaning of a key in a study with these tables. `parameters` are the top-level keys of the study file, `table`
/// has their values, checked or as written. `None` if the schema does not have the key.
pub fn key_meaning<'a>(
    parameters: &'static [Parameter],
    table: &dyn Fn(&str) -> Option<&'a Json>,
    key: &str,
) -> Option<KeyMeaning> {
    let segments = segments(key);
    let (first, rest) = segments.split_first()?;
    let parameter = parameters.iter().find(|parameter| parameter.name == first)?;
    let mut walk = Walk::at(parameter, table(first));
    rest.iter().try_for_each(|segment| walk.step(segment))?;
    Some(walk.meaning())
}

/// A position in the schema and in the values.
#[derive(Clone)]
struct Walk<'a> {
    shape: Shape,
    value: Option<&'a Json>,
    name: &'static str,
    doc: &'static str,
    table: Option<&'static str>,
    place: Vec<String>,
    entries: Vec<String>,
    used: bool,
    tag: bool,
    /// True if the parameter itself is a table whose name belongs to the position of keys below.
    named: bool,
}

impl<'a> Walk<'a> {
    fn at(parameter: &'static Parameter, value: Option<&'a Json>) -> Self {
        Walk {
            shape: parameter.shape,
            value,
            name: parameter.name,
            doc: parameter.doc,
            table: None,
            place: Vec::new(),
            entries: Vec::new(),
            used: true,
            tag: false,
            named: false,
        }
    }

    fn meaning(self) -> KeyMeaning {
        let quantity = match &self.shape {
            Shape::Either(shapes) => {
                // A text may be a number with its unit.
                let value = self.value.filter(|value| !value.is_string());
                let chosen = value.and_then(|value| shapes.iter().find(|shape| outer_form(shape, value)));
                chosen.map_or_else(|| shapes.iter().find_map(quantity_of), quantity_of)
            }
            shape => quantity_of(shape),
        };
        KeyMeaning {
            name: self.name,
            doc: self.doc,
            table: self.table,
            place: self.place,
            entries: self.entries,
            used: self.used,
            tag: self.tag,
            quantity,
        }
    }

    /// Moves one segment further; `None` if the schema has no such key here.
    fn step(&mut self, segment: &str) -> Option<()> {
        match self.shape {
            Shape::Table(parameters) => self.parameter(parameters, segment),
            Shape::Map(of) => {
                self.place.push(segment.into());
                (self.shape, self.value, self.named) = (*of, self.value.and_then(|value| value.get(segment)), false);
                Some(())
            }
            Shape::Tagged { key, .. } if key == segment => self.tag(key, key),
            Shape::Tagged { key, variants } => {
                let tag = self.value?.get(key)?.as_str()?;
                let variant = variants.iter().find(|variant| variant.tag == tag)?;
                self.parameter(variant.parameters, segment)
            }
            Shape::Plugin(kind) if kind.tag_key() == segment => self.tag(kind.tag_key(), word_for(kind)),
            Shape::Plugin(kind) => self.plugin(kind, segment),
            Shape::List { of, .. } => {
                let index = self.index(segment)?;
                self.entry(*of, index, format!("number {}", index + 1));
                Some(())
            }
            Shape::Tuple(shapes) => {
                let index = self.index(segment)?;
                let (name, shape) = shapes.get(index)?;
                self.entry(*shape, index, name.to_string());
                Some(())
            }
            Shape::Either(shapes) => {
                let step = |shape: &Shape| {
                    let mut walk = Walk { shape: *shape, ..self.clone() };
                    walk.step(segment).map(|()| walk)
                };
                *self = fitting(shapes, self.value).find_map(step)?;
                Some(())
            }
            _ => None,
        }
    }

    /// Moves to a key of a table.
    fn parameter(&mut self, parameters: &'static [Parameter], segment: &str) -> Option<()> {
        let parameter = parameters.iter().find(|parameter| parameter.name == segment)?;
        if self.named {
            self.place.push(self.name.replace('_', " "));
        }
        let value = self.value.and_then(|value| value.get(segment));
        (self.table, self.named) = (Some(self.name), true);
        (self.shape, self.value, self.name, self.doc) = (parameter.shape, value, parameter.name, parameter.doc);
        self.entries.clear();
        Some(())
    }

    /// Moves to the tag of a table.
    fn tag(&mut self, key: &'static str, words: &'static str) -> Option<()> {
        if self.named {
            self.place.push(self.name.replace('_', " "));
        }
        (self.table, self.shape) = (Some(self.name), Shape::Text);
        (self.name, self.doc, self.value, self.tag) = (key, words, None, true);
        Some(())
    }

    /// Moves to a key of the chosen plug-in or of all plug-ins of its kind, or, marked as unused, of another plug-in of its kind.
    fn plugin(&mut self, kind: PluginKind, segment: &str) -> Option<()> {
        let tag = self.value.and_then(|value| value.get(kind.tag_key())?.as_str()).unwrap_or_default();
        let own = candidate(kind, tag).map_or(&[][..], |card| card.parameters);
        if self.parameter(own, segment).or_else(|| self.parameter(common_parameters(kind), segment)).is_some() {
            return Some(());
        }
        self.used = false;
        candidates(kind).into_iter().find_map(|other| self.parameter(other.parameters, segment))
    }

    /// Returns the index of a list entry; the segment may be its name.
    fn index(&self, segment: &str) -> Option<usize> {
        let named = |entry: &Json| entry.get("name").and_then(Json::as_str) == Some(segment);
        let by_name = || self.value?.as_array()?.iter().position(named);
        segment.parse().ok().or_else(by_name)
    }

    /// Moves to an entry of a list: tables add a name to the position of the keys below, numbers add to the description.
    fn entry(&mut self, of: Shape, index: usize, number: String) {
        let list = self.value.and_then(Json::as_array);
        let value = list.and_then(|list| list.get(index));
        let table = value.is_some_and(Json::is_object) || matches!(of, Shape::Table(_) | Shape::Tagged { .. });
        if table {
            let word = |key: &str| value.and_then(|value| value.get(key)?.as_str()).map(str::to_string);
            let kind = |key: &str| {
                let several = list.is_some_and(|list| list.len() > 1);
                word(key).map(|word| if several { format!("{word} {}", index + 1) } else { word })
            };
            let tagged = match of {
                Shape::Tagged { key, .. } => kind(key),
                _ => None,
            };
            let numbered = || format!("{} {}", singular(self.name), index + 1);
            self.place.push(word("name").or(tagged).unwrap_or_else(numbered));
        } else {
            self.entries.push(number);
        }
        (self.shape, self.value, self.named) = (of, value, false);
    }
}

/// Returns the name of one entry of a list with this name.
fn singular(list: &str) -> String {
    list.strip_suffix('s').unwrap_or(list).replace('_', " ")
}

/// Returns the alternatives with the form of the value first, then the others.
fn fitting<'s>(shapes: &'s [Shape], value: Option<&Json>) -> impl Iterator<Item = &'s Shape> {
    let fits = move |shape: &&Shape| value.is_some_and(|value| outer_form(shape, value));
    let others = move |shape: &&Shape| !value.is_some_and(|value| outer_form(shape, value));
    shapes.iter().filter(fits).chain(shapes.iter().filter(others))
}

/// Returns true if a checked value has the outer form of a shape.
pub fn outer_form(shape: &Shape, value: &Json) -> bool {
    match shape {
        Shape::Number(..) | Shape::Integer { .. } => value.is_number(),
        Shape::List { .. } | Shape::Tuple(_) => value.is_array(),
        Shape::Table(_) | Shape::Map(_) | Shape::Tagged { .. } | Shape::Plugin(_) => value.is_object(),
        Shape::Either(shapes) => shapes.iter().any(|shape| outer_form(shape, value)),
        Shape::Boolean => value.is_boolean(),
        Shape::Text | Shape::Choice(_) | Shape::Reference(_) => value.is_string(),
        Shape::Free => false,
    }
}
