//! The table of a plug-in if a study gives only its name.

use crate::config::document::parse_value;
use crate::config::origin::Origin;
use serde_json::{Map, Value as Json};
use voussoir_core::plugin::{Card, Need};

/// Returns the tag of a plug-in with the defaults of its keys.
pub fn default_table(card: &Card) -> Json {
    let tag = [(card.kind.tag_key().to_string(), Json::from(card.tag))];
    let defaults = card.parameters.iter().filter_map(|parameter| match parameter.need {
        Need::Default(value) => Some((parameter.name.to_string(), default_of(value)?)),
        _ => None,
    });
    Json::Object(tag.into_iter().chain(defaults).collect::<Map<_, _>>())
}

/// Returns a default of a card as a value; `None` if it is not valid TOML.
pub fn default_of(default: &str) -> Option<Json> {
    Some(parse_value(default, &Origin::Set("".into()))?.to_json())
}
