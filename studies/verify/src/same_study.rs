//! Compares two resolved studies key by key.

use serde::Serialize;
use toml::Value;
use voussoir_study::config::dotted_key::join;

/// Greatest number of characters of a value in a message.
const SHOWN: usize = 60;

/// A key with different values in two studies.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct KeyDifference {
    /// The dotted key.
    pub key: String,
    /// Its value in the first study; `None` if it is missing.
    pub a: Option<Value>,
    /// Its value in the second study.
    pub b: Option<Value>,
}

impl KeyDifference {
    /// Both values in words.
    pub fn words(&self) -> [String; 2] {
        [&self.a, &self.b].map(|value| shown(value.as_ref()))
    }
}

/// All keys in which two studies differ. The order of keys has no meaning; 5 and 5.0 are equal.
pub fn key_differences(a: &Value, b: &Value) -> Vec<KeyDifference> {
    let mut found = Vec::new();
    at("", Some(a), Some(b), &mut found);
    found
}

/// The first key in which the study of a folder differs from another one, in words; `None` if they are the same.
pub fn first_difference(folder: &Value, study: &Value) -> Option<String> {
    let found = key_differences(folder, study).into_iter().next()?;
    let [folder, study] = found.words();
    Some(format!("{} is {folder} in the folder and {study} in the study", found.key))
}

fn at(path: &str, a: Option<&Value>, b: Option<&Value>, found: &mut Vec<KeyDifference>) {
    match (a, b) {
        (Some(Value::Table(a)), Some(Value::Table(b))) => {
            let keys = b.keys().chain(a.keys().filter(|key| !b.contains_key(*key)));
            keys.for_each(|key| at(&join(path, key), a.get(key), b.get(key), found));
        }
        (Some(Value::Array(a)), Some(Value::Array(b))) => {
            (0..a.len().max(b.len()))
                .for_each(|index| at(&join(path, &index.to_string()), a.get(index), b.get(index), found));
        }
        _ if same(a, b) => {}
        _ => found.push(KeyDifference { key: path.into(), a: a.cloned(), b: b.cloned() }),
    }
}

/// Returns true for equal values; 5 and 5.0 are equal.
fn same(a: Option<&Value>, b: Option<&Value>) -> bool {
    let number = |value: Option<&Value>| match value {
        Some(Value::Integer(whole)) => Some(*whole as f64),
        Some(Value::Float(number)) => Some(*number),
        _ => None,
    };
    a == b || number(a).is_some_and(|a| Some(a) == number(b))
}

/// A value in a message.
fn shown(value: Option<&Value>) -> String {
    let Some(value) = value else { return "missing".into() };
    let text = value.to_string().replace('\n', " ");
    match text.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

#[cfg(test)]
mod tests {
    use super::first_difference;

    #[test]
    fn the_first_key_that_differs_is_named() {
        let read = |text: &str| toml::from_str::<toml::Value>(text).expect("TOML");
        let study = read("name = \"a\"\n[scene]\nrise = 2.0\nlist = [1, 2]\n");
        let first = |text: &str| first_difference(&read(text), &study);
        assert_eq!(first("scene = { list = [1, 2.0], rise = 2 }\nname = \"a\"\n"), None);
        let cases = [
            (
                "name = \"a\"\n[scene]\nrise = 2.5\nlist = [1, 2]\n",
                "scene.rise is 2.5 in the folder and 2.0 in the study",
            ),
            (
                "name = \"a\"\n[scene]\nrise = 2.0\nlist = [1]\n",
                "scene.list.1 is missing in the folder and 2 in the study",
            ),
            (
                "name = \"a\"\nx = 1\n[scene]\nrise = 2.0\nlist = [1, 2]\n",
                "x is 1 in the folder and missing in the study",
            ),
        ];
        for (text, expected) in cases {
            assert_eq!(first(text).as_deref(), Some(expected));
        }
    }
}
