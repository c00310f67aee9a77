//! Keys that no variant, scene or axis of a study changes: they are checked once, not once for each case.

use crate::config::check::{Checker, Unused};
use crate::config::checked_value::CheckedValue;
use crate::config::document::{Node, Table};
use crate::config::expand::Expansion;
use std::collections::BTreeMap;
use std::sync::{Arc, OnceLock};
use voussoir_core::plugin::Parameter;

/// The checked value of a top-level key, and the other data on which the check depends.
#[derive(Debug, Clone)]
pub struct CheckedKey {
    /// The normalised value; `None` if the key is optional and absent.
    pub value: Option<Arc<CheckedValue>>,
    /// Unused keys below it.
    pub unused: Vec<Unused>,
    gravity: f64,
    /// Tables in which names were looked up, with the names that they had then.
    names: Vec<(&'static str, Vec<String>)>,
}

impl CheckedKey {
    /// Returns true if a check of the same value in another case must give the same result.
    pub fn holds_for(&self, checker: &Checker<'_>) -> bool {
        let same = |(table, names): &(&'static str, Vec<String>)| {
            names.iter().map(String::as_str).eq(names_in(checker.root, table))
        };
        self.gravity.to_bits() == checker.gravity.to_bits() && self.names.iter().all(same)
    }
}

fn names_in<'a>(root: &'a Node, table: &str) -> impl Iterator<Item = &'a str> {
    root.table().and_then(|root| root.get(table)?.table()).into_iter().flat_map(Table::keys)
}

/// The keys that all cases of a study share, by name; each is checked on first use.
#[derive(Debug, Clone, Default)]
pub struct CheckedKeys(Arc<OnceLock<BTreeMap<&'static str, CheckedKey>>>);

impl CheckedKeys {
    /// Returns the checked key if it is the same in all cases of `expansion`. `keys` are all keys of the study file. `None` if
    /// each case has to check the key itself.
    pub fn get(
        &self,
        expansion: &Expansion,
        keys: impl Iterator<Item = &'static Parameter>,
        name: &str,
    ) -> Option<&CheckedKey> {
        self.0.get_or_init(|| checked(expansion, keys)).get(name)
    }
}

/// Checks the keys that no case changes. Keys with a mistake are omitted: the cases report it.
fn checked(
    expansion: &Expansion,
    keys: impl Iterator<Item = &'static Parameter>,
) -> BTreeMap<&'static str, CheckedKey> {
    let mut found = BTreeMap::new();
    let root = expansion.base();
    let Some(table) = root.table() else { return found };
    for parameter in keys.filter(|key| !expansion.changes(key.name)) {
        let mut checker = Checker::new(root);
        let Ok(value) = checker.parameter(root, table, parameter, "") else { continue };
        if checker.diagnostics.is_empty() {
            let names = |table: &&'static str| (*table, names_in(root, table).map(String::from).collect());
            let names = checker.references.iter().map(names).collect();
            let value = value.map(|value| Arc::new(value.into()));
            let key = CheckedKey { value, unused: checker.unused, gravity: checker.gravity, names };
            found.insert(parameter.name, key);
        }
    }
    found
}
