//! The checked value of a top-level key with its hash, which cases share.

use crate::fnv::Fnv128;
use serde::Serialize;
use serde_json::Value as Json;
use std::sync::OnceLock;

/// Returns the hash of a value's JSON.
pub fn hash_of(value: &impl Serialize) -> Fnv128 {
    let mut hash = Fnv128::new();
    // A hash accepts every byte.
    let _ = serde_json::to_writer(&mut hash, value);
    hash
}

/// The checked value of a top-level key.
#[derive(Debug, Clone, Default)]
pub struct CheckedValue {
    value: Json,
    hash: OnceLock<Fnv128>,
}

impl CheckedValue {
    /// Returns the value.
    pub fn value(&self) -> &Json {
        &self.value
    }

    /// Returns the value for a change; its hash is computed again.
    pub fn value_mut(&mut self) -> &mut Json {
        self.hash = OnceLock::new();
        &mut self.value
    }

    /// Returns the hash of the value.
    pub fn hash(&self) -> Fnv128 {
        *self.hash.get_or_init(|| hash_of(&self.value))
    }
}

impl From<Json> for CheckedValue {
    fn from(value: Json) -> Self {
        CheckedValue { value, hash: OnceLock::new() }
    }
}
