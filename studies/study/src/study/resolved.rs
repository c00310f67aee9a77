//! The tables of a checked case by name. Tables that cases share are stored and hashed once.

use crate::config::checked_value::CheckedValue;
use crate::fnv::Fnv128;
use serde::de::DeserializeOwned;
use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::{Map, Value as Json};
use std::ops::Index;
use std::sync::Arc;

/// A case's own study file, checked: top-level keys with their values, numbers in SI units, defaults filled in.
#[derive(Debug, Clone, Default)]
pub struct Resolved(Vec<(&'static str, Arc<CheckedValue>)>);

impl Resolved {
    /// Adds a new key.
    pub(crate) fn insert(&mut self, name: &'static str, value: Arc<CheckedValue>) {
        self.0.push((name, value));
    }

    /// Removes a key.
    pub(crate) fn remove(&mut self, name: &str) {
        self.0.retain(|(own, _)| *own != name);
    }

    /// Returns the value of a key for changes in this case alone.
    pub(crate) fn get_mut(&mut self, name: &str) -> Option<&mut Json> {
        let (_, checked) = self.0.iter_mut().find(|(own, _)| *own == name)?;
        Some(Arc::make_mut(checked).value_mut())
    }

    /// Adds all names and the hashes of their values.
    pub(crate) fn add_hashes(&self, hash: &mut Fnv128) {
        for (name, checked) in &self.0 {
            hash.add(name.as_bytes());
            hash.add_hash(checked.hash());
        }
    }

    /// Returns the value of a top-level key.
    pub fn get(&self, name: &str) -> Option<&Json> {
        self.0.iter().find(|(own, _)| *own == name).map(|(_, checked)| checked.value())
    }

    /// Returns the value of a top-level key as a type; `None` if it is absent or has another form.
    pub fn read<T: DeserializeOwned>(&self, name: &str) -> Option<T> {
        T::deserialize(self.get(name)?).ok()
    }

    /// Returns the value at a dotted path with indices for entries of lists.
    pub fn at(&self, path: &str) -> Option<&Json> {
        let mut keys = path.split('.');
        let table = self.get(keys.next()?)?;
        keys.try_fold(table, |value, key| match value {
            Json::Array(list) => list.get(key.parse::<usize>().ok()?),
            _ => value.get(key),
        })
    }

    /// Returns all names with their values.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &Json)> {
        self.0.iter().map(|(name, checked)| (*name, checked.value()))
    }

    /// Returns all values as one table.
    pub fn to_json(&self) -> Json {
        Json::Object(self.iter().map(|(name, value)| (name.to_string(), value.clone())).collect::<Map<_, _>>())
    }
}

impl PartialEq for Resolved {
    fn eq(&self, other: &Self) -> bool {
        self.iter().eq(other.iter())
    }
}

/// Returns the value of a key that may be absent; `null` if it is.
impl Index<&str> for Resolved {
    type Output = Json;

    fn index(&self, name: &str) -> &Json {
        self.get(name).unwrap_or(&Json::Null)
    }
}

impl Serialize for Resolved {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let mut map = serializer.serialize_map(Some(self.0.len()))?;
        self.iter().try_for_each(|(name, value)| map.serialize_entry(name, value))?;
        map.end()
    }
}
