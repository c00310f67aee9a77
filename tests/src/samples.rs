//! Laws with the sample numbers of their cards.

use serde_json::Value;
use voussoir::core::plugin::{Card, PluginKind, Sample, cards_of};

/// Every sample of every law of a kind, with its table as a study file has it.
pub fn samples(kind: PluginKind) -> Vec<(&'static Card, &'static Sample, Value)> {
    let all = cards_of(kind).into_iter().flat_map(|card| card.samples.iter().map(move |sample| (card, sample)));
    all.map(|(card, sample)| (card, sample, table(card, sample))).collect()
}

/// A sample's keys with the tag.
fn table(card: &Card, sample: &Sample) -> Value {
    let keys: toml::Table = sample.table.parse().unwrap_or_else(|wrong| panic!("a sample of {}: {wrong}", card.tag));
    let mut value = serde_json::to_value(keys).expect("TOML is JSON");
    assert_eq!((card.check)(&value), vec![], "a sample of {}", card.tag);
    value[card.kind.tag_key()] = card.tag.into();
    value
}
