//! The table of a plug-in where a study says nothing but its name.

use crate::config::document::parse_value;
use crate::config::origin::Origin;
use serde_json::{Map, Value as Json};
use voussoir_core::plugin::{Card, Need};

/// A plug-in's tag with the defaults of its keys.
pub fn default_table(card: &Card) -> Json {
    let tag = [(card.kind.tag_key().to_string(), Json::from(card.tag))];
    let defaults = card.parameters.iter().filter_map(|parameter| match parameter.need {
        Need::Default(value) => Some((parameter.name.to_string(), default_of(value)?)),
        _ => None,
    });
    Json::Object(tag.into_iter().chain(defaults).collect::<Map<_, _>>())
}

/// A default of a card as a value; `None` where it is no TOML.
pub fn default_of(default: &str) -> Option<Json> {
    Some(parse_value(default, &Origin::Set("".into()))?.to_json())
}
