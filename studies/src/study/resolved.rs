//! The tables of a checked case by name. Those that cases of a study have in common are held once.

use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::{Map, Value as Json};
use std::ops::Index;
use std::sync::Arc;

/// A case's own study file, checked: top-level keys with their values, numbers in SI units, defaults filled in.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Resolved(Vec<(&'static str, Arc<Json>)>);

impl Resolved {
    /// Adds a key that is not there yet.
    pub(super) fn insert(&mut self, name: &'static str, value: Arc<Json>) {
        self.0.push((name, value));
    }

    /// Takes a key away.
    pub(super) fn remove(&mut self, name: &str) {
        self.0.retain(|(own, _)| *own != name);
    }

    /// The value of a key, to be changed in this case alone.
    pub(super) fn get_mut(&mut self, name: &str) -> Option<&mut Json> {
        self.0.iter_mut().find(|(own, _)| *own == name).map(|(_, value)| Arc::make_mut(value))
    }

    /// The value of a top-level key.
    pub fn get(&self, name: &str) -> Option<&Json> {
        self.0.iter().find(|(own, _)| *own == name).map(|(_, value)| value.as_ref())
    }

    /// The value at a dotted path; entries of lists by index.
    pub fn at(&self, path: &str) -> Option<&Json> {
        let mut keys = path.split('.');
        let table = self.get(keys.next()?)?;
        keys.try_fold(table, |value, key| match value {
            Json::Array(list) => list.get(key.parse::<usize>().ok()?),
            _ => value.get(key),
        })
    }

    /// All of it as one value.
    pub fn to_json(&self) -> Json {
        let entry = |(name, value): &(&str, Arc<Json>)| (name.to_string(), value.as_ref().clone());
        Json::Object(self.0.iter().map(entry).collect::<Map<_, _>>())
    }
}

/// The value of a key that may be absent: `null` then.
impl Index<&str> for Resolved {
    type Output = Json;

    fn index(&self, name: &str) -> &Json {
        self.get(name).unwrap_or(&Json::Null)
    }
}

impl Serialize for Resolved {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        self.0.iter().try_for_each(|(name, value)| map.serialize_entry(name, value.as_ref()))?;
        map.end()
    }
}
