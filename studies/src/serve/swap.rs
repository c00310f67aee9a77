//! Replaces the law or the solver of a table. Keys that both plug-ins have keep their values.

use serde_json::{Map, Value as Json};
use voussoir_core::plugin::{Card, Need, PluginKind, candidates};
use voussoir_study::config::common_keys::common_parameters;
use voussoir_study::config::diagnostic::LocatedDiagnostic;
use voussoir_study::config::document::{Node, from_json};
use voussoir_study::config::dotted_key::join;
use voussoir_study::config::origin::Origin;
use voussoir_study::config::overlay::set;
use voussoir_study::study::{Case, PluginTable, plugin_tables, study_keys};

/// The tag of the choice of a solver by the program.
pub(super) const AUTO: &str = "auto";

/// The kinds that the page offers.
const KINDS: [PluginKind; 6] = [
    PluginKind::InterfaceLaw,
    PluginKind::BulkMaterial,
    PluginKind::Dispersion,
    PluginKind::FillResistance,
    PluginKind::LimitSolver,
    PluginKind::PathSolver,
];

/// Returns the tables of a case whose law or solver can be replaced.
pub(super) fn tables(resolved: &Json) -> Vec<PluginTable> {
    plugin_tables(study_keys(), resolved, &KINDS)
}

/// Returns tags and summaries of the plug-ins that a table may name.
pub(super) fn choices(table: &PluginTable) -> Vec<(&'static str, &'static str)> {
    let auto = table.key == "solver";
    let auto = auto.then_some((AUTO, "the fastest solver that supports the case"));
    auto.into_iter().chain(candidates(table.kind).iter().map(|card| (card.tag, card.summary))).collect()
}

/// A table after a replacement.
pub(super) struct Swapped {
    /// Dotted key of the table.
    table: String,
    /// The keys that its new plug-in accepts.
    accepted: Vec<&'static str>,
    /// The keys whose values come from the sample of its new plug-in.
    pub sampled: Vec<String>,
}

impl Swapped {
    /// Returns true if a key was one of the table, but is unknown to its new plug-in.
    pub fn drops(&self, key: &str) -> bool {
        let inside = key.strip_prefix(&self.table).and_then(|rest| rest.strip_prefix('.'));
        inside.is_some_and(|rest| !self.accepted.contains(&rest.split('.').next().unwrap_or(rest)))
    }
}

/// Replaces the plug-in of a table of a study. `case` is the case before the replacement. Required keys that the table does not
/// have get the values of the first sample on the card of the plug-in.
pub(super) fn swap(root: &mut Node, case: &Case, key: &str, tag: &str) -> Result<Swapped, Vec<LocatedDiagnostic>> {
    let origin = Origin::Set(key.into());
    let wrong = |message: String| vec![LocatedDiagnostic::new(&origin, key, message)];
    let resolved = case.resolved.to_json();
    let table = tables(&resolved).into_iter().find(|table| table.key == key);
    let table = table.ok_or_else(|| wrong("has no law or solver that can be replaced".into()))?;
    let tag_key = table.kind.tag_key();
    let card = candidates(table.kind).into_iter().find(|card| card.tag == tag);
    if card.is_none() && !choices(&table).iter().any(|(known, _)| *known == tag) {
        return Err(wrong(format!("there is no {} \"{tag}\"", table.kind.describe())));
    }
    let (given, checked) = (at(root, key).map(Node::to_json).unwrap_or_default(), case.resolved.at(key));
    let own = card.map_or(&[][..], |card| card.parameters).iter().chain(common_parameters(table.kind));
    let accepted: Vec<&'static str> = own.map(|parameter| parameter.name).collect();
    let kept = |from: Option<&Json>| -> Map<String, Json> {
        let tagged = [(tag_key.to_string(), Json::from(tag))].into_iter();
        let value = |name: &&'static str| given.get(*name).and(from?.get(*name)).cloned();
        tagged.chain(accepted.iter().filter_map(|name| Some((name.to_string(), value(name)?)))).collect()
    };
    let mut new = kept(Some(&given));
    let sampled = card.map_or(Vec::new(), |card| from_sample(card, kept(checked)));
    let names = sampled.iter().map(|(name, _)| join(key, name)).collect();
    new.extend(sampled);
    let mut node = from_json(&Json::Object(new))?;
    node.set_origin(&origin);
    set(root, key, node, &origin).map_err(|wrong| vec![*wrong])?;
    Ok(Swapped { table: key.into(), accepted, sampled: names })
}

/// Returns the values that a table needs from the sample of a card: required keys, or all if the table is otherwise wrong.
fn from_sample(card: &Card, mut table: Map<String, Json>) -> Vec<(String, Json)> {
    // The check of a card reads the concrete type, which has neither the tag nor the common keys.
    table.retain(|name, _| card.parameters.iter().any(|own| own.name == name));
    let sample: Option<toml::Table> = card.samples.first().and_then(|sample| sample.table.parse().ok());
    let required =
        |name: &str| card.parameters.iter().any(|own| own.name == name && matches!(own.need, Need::Required));
    let mut added = Vec::new();
    for all in [false, true] {
        if all && (card.check)(&Json::Object(table.clone())).is_empty() {
            break;
        }
        for (name, value) in sample.iter().flatten().filter(|(name, _)| all || required(name)) {
            let Some(value) = serde_json::to_value(value).ok().filter(|_| !table.contains_key(name)) else { continue };
            table.insert(name.clone(), value.clone());
            added.push((name.clone(), value));
        }
    }
    added
}

/// Returns the node at a dotted key of tables.
fn at<'a>(root: &'a Node, key: &str) -> Option<&'a Node> {
    key.split('.').try_fold(root, |node, name| node.table()?.get(name))
}
