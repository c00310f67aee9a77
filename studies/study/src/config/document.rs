//! A TOML document as a tree in which every key and value has its place.
//!
//! This module reads only the form; [`super::check`] checks the keys.

use crate::config::diagnostic::{LocatedDiagnostic, sort};
use crate::config::dotted_key::{join, segments};
use crate::config::limits::MAX_DEPTH;
use crate::config::nesting::too_deep;
use crate::config::origin::Origin;
use std::sync::Arc;
use toml::Spanned;
use toml::de::{DeTable, DeValue};

/// A value with its place.
#[derive(Debug, Clone, PartialEq)]
pub struct Node {
    /// The value.
    pub value: Value,
    /// Its place; for a `[table]` the place of its header.
    pub origin: Origin,
}

/// A TOML value.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// A text.
    String(String),
    /// A whole number.
    Integer(i64),
    /// A number, possibly nan or inf.
    Float(f64),
    /// `true` or `false`.
    Boolean(bool),
    /// A date or time. No key of a study accepts it.
    Date(String),
    /// A list.
    Array(Vec<Node>),
    /// A table, in the order of the file.
    Table(Table),
}

/// A table in the order of the file.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Table {
    /// Its entries.
    pub entries: Vec<Entry>,
}

/// A key with its value.
#[derive(Debug, Clone, PartialEq)]
pub struct Entry {
    /// The key.
    pub key: String,
    /// Place of the key.
    pub origin: Origin,
    /// Its value.
    pub node: Node,
}

impl Table {
    /// Returns the entry under `key`.
    pub fn entry(&self, key: &str) -> Option<&Entry> {
        self.entries.iter().find(|entry| entry.key == key)
    }

    /// Returns the value under `key`.
    pub fn get(&self, key: &str) -> Option<&Node> {
        self.entry(key).map(|entry| &entry.node)
    }

    /// Returns the value under `key` for changes.
    pub fn get_mut(&mut self, key: &str) -> Option<&mut Node> {
        self.entries.iter_mut().find(|entry| entry.key == key).map(|entry| &mut entry.node)
    }

    /// Returns the keys in order.
    pub fn keys(&self) -> impl Iterator<Item = &str> {
        self.entries.iter().map(|entry| entry.key.as_str())
    }
}

impl Value {
    /// Describes the type of the value in words.
    pub fn describe(&self) -> String {
        match self {
            Value::String(text) => format!("the text \"{text}\""),
            Value::Integer(whole) => format!("the number {whole}"),
            Value::Float(number) => format!("the number {number}"),
            Value::Boolean(value) => format!("{value}"),
            Value::Date(_) => "a date".into(),
            Value::Array(_) => "a list".into(),
            Value::Table(_) => "a table".into(),
        }
    }
}

impl Node {
    /// The table, if it is one.
    pub fn table(&self) -> Option<&Table> {
        match &self.value {
            Value::Table(table) => Some(table),
            _ => None,
        }
    }

    /// The list, if it is one.
    pub fn array(&self) -> Option<&[Node]> {
        match &self.value {
            Value::Array(nodes) => Some(nodes),
            _ => None,
        }
    }

    /// The text, if it is one.
    pub fn text(&self) -> Option<&str> {
        match &self.value {
            Value::String(text) => Some(text),
            _ => None,
        }
    }

    /// The number, if it is one.
    pub fn number(&self) -> Option<f64> {
        match self.value {
            Value::Integer(whole) => Some(whole as f64),
            Value::Float(number) => Some(number),
            _ => None,
        }
    }

    /// Describes the type of the value in words.
    pub fn describe(&self) -> String {
        self.value.describe()
    }

    /// Returns the place of the entry or list element at a dotted path with list indices, or of its nearest existing ancestor.
    pub fn place(&self, path: &str) -> Origin {
        let mut node = self;
        let mut origin = &self.origin;
        for segment in segments(path) {
            match &node.value {
                Value::Table(table) => match table.entry(&segment) {
                    Some(entry) => {
                        // The place of a value is more precise than the place of its key, except for tables with a header.
                        origin = &entry.node.origin;
                        node = &entry.node;
                    }
                    None => break,
                },
                Value::Array(nodes) => match segment.parse::<usize>().ok().and_then(|i| nodes.get(i)) {
                    Some(next) => {
                        origin = &next.origin;
                        node = next;
                    }
                    None => break,
                },
                _ => break,
            }
        }
        origin.clone()
    }

    /// Returns the value as plain TOML.
    pub fn to_toml(&self) -> toml::Value {
        match &self.value {
            Value::String(text) | Value::Date(text) => toml::Value::String(text.clone()),
            Value::Integer(whole) => toml::Value::Integer(*whole),
            Value::Float(number) => toml::Value::Float(*number),
            Value::Boolean(value) => toml::Value::Boolean(*value),
            Value::Array(nodes) => toml::Value::Array(nodes.iter().map(Node::to_toml).collect()),
            Value::Table(table) => toml::Value::Table(
                table.entries.iter().map(|entry| (entry.key.clone(), entry.node.to_toml())).collect(),
            ),
        }
    }

    /// Returns the value as JSON; a number that is not finite becomes `null`.
    pub fn to_json(&self) -> serde_json::Value {
        match &self.value {
            Value::String(text) | Value::Date(text) => text.clone().into(),
            Value::Integer(whole) => (*whole).into(),
            Value::Float(number) => (*number).into(),
            Value::Boolean(value) => (*value).into(),
            Value::Array(nodes) => nodes.iter().map(Node::to_json).collect(),
            Value::Table(table) => serde_json::Value::Object(
                table.entries.iter().map(|entry| (entry.key.clone(), entry.node.to_json())).collect(),
            ),
        }
    }

    /// Sets one origin for the whole tree.
    pub fn set_origin(&mut self, to: &Origin) {
        self.origin = to.clone();
        match &mut self.value {
            Value::Array(nodes) => nodes.iter_mut().for_each(|node| node.set_origin(to)),
            Value::Table(table) => {
                for entry in &mut table.entries {
                    entry.origin = to.clone();
                    entry.node.set_origin(to);
                }
            }
            _ => {}
        }
    }
}

/// Advice for a file with wrong syntax.
const TOML: &str = "a study file has lines KEY = VALUE, tables in [brackets] and texts in quotes";

/// Reads a document. The error lists all syntax errors.
pub fn parse(text: &str, file: &str) -> Result<Node, Vec<LocatedDiagnostic>> {
    let reader = Reader::new(text, file);
    if let Some(byte) = too_deep(text) {
        return Err(vec![nested_too_deep(&reader.origin(byte), "")]);
    }
    let (root, errors) = DeTable::parse_recoverable(text);
    let mut mistakes: Vec<LocatedDiagnostic> = Vec::new();
    for error in &errors {
        let origin = reader.origin(error.span().map_or(0, |span| span.start));
        let mistake = reader.syntax_mistake(origin, error, text);
        if !mistakes.iter().any(|earlier| earlier.origin == mistake.origin) {
            mistakes.push(mistake);
        }
    }
    if !mistakes.is_empty() {
        sort(&mut mistakes);
        // One piece of advice is enough for all mistakes.
        if let Some(first) = mistakes.first_mut().filter(|first| first.help.is_none()) {
            first.help = Some(TOML.into());
        }
        return Err(mistakes);
    }
    let node = reader.table(root.get_ref(), reader.origin(0), &mut mistakes);
    if mistakes.is_empty() { Ok(node) } else { Err(mistakes) }
}

fn nested_too_deep(origin: &Origin, key: &str) -> LocatedDiagnostic {
    let message = format!("is nested more than {MAX_DEPTH} deep");
    LocatedDiagnostic::new(origin, key, message)
        .help("no key of a study needs that; look for a bracket that is not closed")
}

/// Reads one value, in the form that it has after `=`. The value and all its parts get the origin `origin`. Returns `None`
/// if the text is not a TOML value.
pub fn parse_value(text: &str, origin: &Origin) -> Option<Node> {
    if let Some(value) = plain_scalar(text) {
        return Some(Node { value, origin: origin.clone() });
    }
    let Ok(Node { value: Value::Table(mut table), .. }) = parse(&format!("value = {text}"), "") else {
        return None;
    };
    if table.entries.len() != 1 {
        return None;
    }
    let mut node = table.entries.pop()?.node;
    node.set_origin(origin);
    Some(node)
}

/// Reads a whole number, a decimal, a truth value or a text in its simplest form. Most defaults have this form, and every
/// case of a study reads them.
fn plain_scalar(text: &str) -> Option<Value> {
    let digits = |part: &str| !part.is_empty() && part.bytes().all(|byte| byte.is_ascii_digit());
    let letters = |c: char| c.is_ascii_alphanumeric() || "_- ".contains(c);
    if let Some(word) = text.strip_prefix('"').and_then(|rest| rest.strip_suffix('"')) {
        return word.chars().all(letters).then(|| Value::String(word.into()));
    }
    match text.split_once('.') {
        _ if text == "true" || text == "false" => Some(Value::Boolean(text == "true")),
        None if digits(text) && (text == "0" || !text.starts_with('0')) => text.parse().ok().map(Value::Integer),
        Some((whole, part)) if digits(part) && digits(whole) && (whole == "0" || !whole.starts_with('0')) => {
            text.parse().ok().map(Value::Float)
        }
        _ => None,
    }
}

/// Converts a value that a program has made into a document; every part gets the origin [`Origin::Value`]. The error lists
/// all values that a study cannot contain, by key.
pub fn from_json(value: &serde_json::Value) -> Result<Node, Vec<LocatedDiagnostic>> {
    let mut mistakes = Vec::new();
    let node = json_node(value, "", MAX_DEPTH, &mut mistakes);
    if mistakes.is_empty() { Ok(node) } else { Err(mistakes) }
}

/// Converts a value. `depth` is the number of further levels that are allowed.
fn json_node(value: &serde_json::Value, path: &str, depth: usize, mistakes: &mut Vec<LocatedDiagnostic>) -> Node {
    use serde_json::Value as Json;
    let value = match value {
        Json::Array(_) | Json::Object(_) if depth == 0 => {
            mistakes.push(nested_too_deep(&Origin::Value, path));
            Value::Boolean(false)
        }
        Json::Null => {
            let mistake = LocatedDiagnostic::new(&Origin::Value, path, "is null");
            mistakes.push(mistake.help("leave the key out, or give it a value"));
            Value::Boolean(false)
        }
        Json::Bool(value) => Value::Boolean(*value),
        Json::Number(number) => {
            number.as_i64().map_or(Value::Float(number.as_f64().unwrap_or(f64::NAN)), Value::Integer)
        }
        Json::String(text) => Value::String(text.clone()),
        Json::Array(values) => {
            let entry = |(index, value)| json_node(value, &join(path, &format!("{index}")), depth - 1, mistakes);
            Value::Array(values.iter().enumerate().map(entry).collect())
        }
        Json::Object(entries) => {
            let entry = |(key, value): (&String, &Json)| {
                let node = json_node(value, &join(path, key), depth - 1, mistakes);
                Entry { key: key.clone(), origin: Origin::Value, node }
            };
            Value::Table(Table { entries: entries.iter().map(entry).collect() })
        }
    };
    Node { value, origin: Origin::Value }
}

struct Reader {
    file: Arc<str>,
    /// First byte of each line.
    lines: Vec<usize>,
    text: String,
}

impl Reader {
    fn new(text: &str, file: &str) -> Self {
        let lines = std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Reader { file: file.into(), lines, text: text.into() }
    }

    fn origin(&self, byte: usize) -> Origin {
        let line = self.lines.partition_point(|&start| start <= byte);
        let start = self.lines[line - 1];
        let column = self.text.get(start..byte).map_or(1, |before| before.chars().count() + 1);
        Origin::File { file: self.file.clone(), line, column }
    }

    fn syntax_mistake(&self, origin: Origin, error: &toml::de::Error, text: &str) -> LocatedDiagnostic {
        let message = error.message();
        if message.contains("duplicate key") {
            let key = error.span().and_then(|span| text.get(span)).unwrap_or_default().trim();
            let help = match self.is_list_of_tables(&origin) {
                true => format!("write each entry of a list under its own [[{key}]], with two brackets"),
                false => "keep one of the two".into(),
            };
            return LocatedDiagnostic::new(&origin, key, "is given twice in the same table").help(help);
        }
        let after = error.span().and_then(|span| text.get(span.start..)).and_then(|rest| rest.lines().next());
        let nothing = after.is_none_or(|rest| rest.trim().is_empty());
        let why = match message {
            _ if after.is_some_and(|rest| rest.contains(" //")) => "a comment begins with #, not with //",
            _ if message.contains("expected nothing") => "there is more text after the value",
            _ if message.contains("invalid boolean") => "true and false have small letters",
            _ if message.contains("string values must be quoted") && nothing => "there is no value after =",
            _ if message.contains("string values must be quoted") => "a text must be in quotes, as in \"arch\"",
            _ if message.contains("key with no value") => "there is no = and no value after this key",
            other => other,
        };
        LocatedDiagnostic::new(&origin, "", format!("this is not TOML: {why}"))
    }

    /// Returns true if the line begins an entry of a list of tables: `[[stages]]`.
    fn is_list_of_tables(&self, origin: &Origin) -> bool {
        let Origin::File { line, .. } = origin else { return false };
        self.text.lines().nth(line - 1).is_some_and(|line| line.trim_start().starts_with("[["))
    }

    fn table(&self, table: &DeTable<'_>, origin: Origin, mistakes: &mut Vec<LocatedDiagnostic>) -> Node {
        let entries = table
            .iter()
            .map(|(key, value)| {
                let place = self.origin(key.span().start);
                Entry { key: key.get_ref().to_string(), node: self.node(value, &place, mistakes), origin: place }
            })
            .collect();
        Node { value: Value::Table(Table { entries }), origin }
    }

    /// Converts a parsed value. `key` is the place of the key, which is the place of tables with a header.
    fn node(&self, value: &Spanned<DeValue<'_>>, key: &Origin, mistakes: &mut Vec<LocatedDiagnostic>) -> Node {
        let origin = self.origin(value.span().start);
        let value = match value.get_ref() {
            DeValue::String(text) => Value::String(text.to_string()),
            DeValue::Integer(whole) => match i64::from_str_radix(whole.as_str(), whole.radix()) {
                Ok(whole) => Value::Integer(whole),
                Err(_) => {
                    let message = format!("{whole} is too large for a whole number");
                    mistakes.push(LocatedDiagnostic::new(&origin, "", message).help("write it with a decimal point"));
                    Value::Integer(0)
                }
            },
            DeValue::Float(number) => Value::Float(number.as_str().parse().unwrap_or(f64::NAN)),
            DeValue::Boolean(value) => Value::Boolean(*value),
            DeValue::Datetime(date) => Value::Date(date.to_string()),
            DeValue::Array(values) => Value::Array(
                values.iter().map(|value| self.node(value, &self.origin(value.span().start), mistakes)).collect(),
            ),
            DeValue::Table(table) => {
                let inline = self.text.as_bytes().get(self.byte(&origin)) == Some(&b'{');
                let origin = if inline { origin } else { key.clone() };
                return self.table(table, origin, mistakes);
            }
        };
        Node { value, origin }
    }

    fn byte(&self, origin: &Origin) -> usize {
        let Origin::File { line, column, .. } = origin else {
            return 0;
        };
        let start = self.lines[line - 1];
        self.text[start..].char_indices().nth(column - 1).map_or(self.text.len(), |(at, _)| start + at)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(origin: &Origin) -> (usize, usize) {
        match origin {
            Origin::File { line, column, .. } => (*line, *column),
            Origin::Set(_) | Origin::Value => (0, 0),
        }
    }

    /// Values that are read without the parser of whole documents are equal to its values; other forms are left to the parser.
    #[test]
    fn plain_values_are_those_of_the_parser() {
        let plain = ["0", "7", "250", "0.0", "1.0", "12.750", "true", "false", "\"\"", "\"jointed\"", "\"a b-c_1\""];
        for text in plain {
            let parsed = parse(&format!("value = {text}"), "").unwrap();
            let Value::Table(table) = parsed.value else { panic!("{text}") };
            assert_eq!(plain_scalar(text), Some(table.get("value").unwrap().value.clone()), "{text}");
        }
        for text in [
            "",
            "-1",
            "007",
            "00.5",
            "1.",
            ".5",
            "1e3",
            "1_000",
            "inf",
            "\"",
            "\"\"\"",
            "\"x\\n\"",
            "\"a\" \"b\"",
            "'x'",
            "99999999999999999999",
        ] {
            assert_eq!(plain_scalar(text), None, "{text}");
        }
    }

    #[test]
    fn values_and_headers_know_their_place() {
        let text = "name = \"x\"\n[scene]\n\"µ\" = 1 # two-byte key\nprofile = { rise = 2.0 }\n\n[[stages]]\nname = \"live\"\n\n[joints.dry]\nlaw = \"coulomb\"\n";
        let root = parse(text, "a.toml").unwrap();
        assert_eq!(at(&root.place("scene")), (2, 2));
        assert_eq!(at(&root.place("scene.µ")), (3, 7));
        assert_eq!(at(&root.place("scene.profile.rise")), (4, 20));
        assert_eq!(at(&root.place("scene.profile.span")), (4, 11), "an absent key is its table's");
        assert_eq!(at(&root.place("stages.0.name")), (7, 8));
        assert_eq!(at(&root.place("stages.0.factor")), (6, 1));
        assert_eq!(at(&root.place("joints.dry.friction")), (9, 9));
    }

    #[test]
    fn order_of_keys_is_kept() {
        let root = parse("[b]\nz = 1\na = 2\n[a]\n", "a.toml").unwrap();
        assert_eq!(root.table().unwrap().keys().collect::<Vec<_>>(), ["b", "a"]);
        assert_eq!(root.table().unwrap().get("b").unwrap().table().unwrap().keys().collect::<Vec<_>>(), ["z", "a"]);
    }

    #[test]
    fn several_syntax_errors_are_found_at_once() {
        let mistakes = parse("a = \nb = 1\nc = [1,, 2]\nb = 3\n", "a.toml").unwrap_err();
        let lines: Vec<_> = mistakes.iter().map(|mistake| at(&mistake.origin).0).collect();
        assert_eq!(lines, [1, 3, 4]);
    }
}
