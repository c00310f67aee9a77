//! Outputs that a solver declares on its card, from its answer.

use crate::results::OutputEntry;
use std::collections::BTreeMap;
use voussoir_core::plugin::{PluginKind, card, nearest};

/// Returns the outputs of a solver that its card declares, with notes on values that are missing or not on the card.
pub(super) fn solver_outputs(
    kind: PluginKind,
    tag: &str,
    given: &BTreeMap<String, f64>,
) -> (Vec<OutputEntry>, Vec<String>) {
    let Some(card) = card(kind, tag) else { return Default::default() };
    let value = |name: &str| given.get(name).copied().filter(|value| value.is_finite());
    let entry = |output| {
        let entry = OutputEntry::new(card, output);
        OutputEntry { values: vec![value(output.name)], ..entry }
    };
    let found: Vec<OutputEntry> = card.outputs.iter().map(entry).collect();
    let mut notes: Vec<String> = found.iter().filter_map(OutputEntry::note).collect();
    for name in given.keys().filter(|name| card.outputs.iter().all(|output| output.name != **name)) {
        let near = nearest(name, card.outputs.iter().map(|output| output.name));
        let near = near.map_or(String::new(), |near| format!("; did you mean \"{near}\"?"));
        notes.push(format!("{tag}: its answer has an output \"{name}\" that its card does not declare{near}"));
    }
    (found, notes)
}
