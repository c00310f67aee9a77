//! JSON Schema (draft 2020-12) of tables and of all plug-ins, from the shapes of their keys.

use crate::config::common_keys::{common_parameters, common_words};
use crate::config::document::parse_value;
use crate::config::key_meaning::quantity_of;
use crate::config::origin::Origin;
use serde_json::{Map, Value as Json, json};
use voussoir_core::plugin::{Card, Need, Parameter, PluginKind, Quantity, Range, Shape, candidates};

/// Returns the definitions of all plug-ins that study files configure, by name.
pub fn definitions() -> Map<String, Json> {
    let mut definitions = Map::new();
    for kind in [
        PluginKind::InterfaceLaw,
        PluginKind::BulkMaterial,
        PluginKind::Scene,
        PluginKind::LimitSolver,
        PluginKind::Continuation,
        PluginKind::Dispersion,
        PluginKind::FillResistance,
    ] {
        let mut choices = Vec::new();
        for word in common_words(kind) {
            choices.push(plugin(&mut definitions, kind, word, "chosen by the program", &[]));
        }
        for Card { tag, summary, parameters, .. } in candidates(kind) {
            choices.push(plugin(&mut definitions, kind, tag, summary, parameters));
        }
        definitions.insert(name_of(kind), json!({ "oneOf": choices }));
    }
    definitions
}

fn name_of(kind: PluginKind) -> String {
    kind.describe().replace(' ', "_")
}

fn plugin(defs: &mut Map<String, Json>, kind: PluginKind, tag: &str, summary: &str, own: &[Parameter]) -> Json {
    let common = common_parameters(kind).iter().filter(|p| own.iter().all(|o| o.name != p.name));
    let mut parameters: Vec<Parameter> = own.iter().chain(common).copied().collect();
    // Keys of other plug-ins of the kind are accepted, so that you can change the plug-in in a single line.
    for other in candidates(kind).iter().flat_map(|card| card.parameters) {
        if parameters.iter().all(|p| p.name != other.name) {
            parameters.push(other.optional("not used here"));
        }
    }
    let mut schema = table(&parameters, Some((kind.tag_key(), tag)));
    schema["description"] = summary.into();
    let name = format!("{}_{tag}", name_of(kind));
    defs.insert(name.clone(), schema);
    json!({ "$ref": format!("#/$defs/{name}") })
}

/// Returns the schema of a table with these keys; `tag` is the key of the plug-in's tag, with its value.
pub fn table(parameters: &[Parameter], tag: Option<(&str, &str)>) -> Json {
    let mut properties = Map::new();
    let mut required = Vec::new();
    if let Some((key, word)) = tag {
        properties.insert(key.into(), json!({ "const": word }));
        required.push(Json::from(key));
    }
    for parameter in parameters {
        let mut schema = shape(&parameter.shape);
        let mut text = parameter.doc.to_string();
        if let Some(quantity) = quantity_of(&parameter.shape).filter(|quantity| *quantity != Quantity::Ratio) {
            text = format!("{text} [{}]", quantity.unit());
        }
        match parameter.need {
            Need::Required => required.push(parameter.name.into()),
            Need::Optional(otherwise) => text = format!("{text}; if absent: {otherwise}"),
            Need::Default(value) => {
                if let Some(value) = parse_value(value, &Origin::Set("".into())) {
                    schema["default"] = value.to_json();
                }
            }
        }
        schema["description"] = text.into();
        properties.insert(parameter.name.into(), schema);
    }
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}

fn number(range: &Range) -> Json {
    let mut schema = json!({ "type": "number" });
    if range.min.is_finite() {
        schema[if range.min_open { "exclusiveMinimum" } else { "minimum" }] = range.min.into();
    }
    if range.max.is_finite() {
        schema[if range.max_open { "exclusiveMaximum" } else { "maximum" }] = range.max.into();
    }
    schema
}

fn shape(of: &Shape) -> Json {
    match of {
        Shape::Number(_, range) => json!({ "anyOf": [number(range), { "type": "string" }] }),
        Shape::Integer { min, max } => json!({ "type": "integer", "minimum": min, "maximum": max }),
        Shape::Boolean => json!({ "type": "boolean" }),
        Shape::Text | Shape::Reference(_) => json!({ "type": "string" }),
        Shape::Choice(words) => json!({ "enum": words }),
        Shape::List { of, min, max } => {
            let mut schema = json!({ "type": "array", "items": shape(of), "minItems": min });
            if *max < usize::MAX {
                schema["maxItems"] = (*max).into();
            }
            schema
        }
        Shape::Tuple(shapes) => {
            let entries: Vec<_> = shapes.iter().map(|(_, of)| shape(of)).collect();
            json!({ "type": "array", "prefixItems": entries, "items": false, "minItems": shapes.len() })
        }
        Shape::Table(parameters) => table(parameters, None),
        Shape::Tagged { key, variants } => {
            let choices: Vec<_> = variants
                .iter()
                .map(|variant| {
                    let mut schema = table(variant.parameters, Some((key, variant.tag)));
                    schema["description"] = variant.doc.into();
                    schema
                })
                .collect();
            json!({ "oneOf": choices })
        }
        Shape::Either(shapes) => json!({ "anyOf": shapes.iter().map(shape).collect::<Vec<_>>() }),
        Shape::Plugin(kind) => json!({ "$ref": format!("#/$defs/{}", name_of(*kind)) }),
        Shape::Map(of) => json!({ "type": "object", "additionalProperties": shape(of) }),
        Shape::Free => json!({}),
    }
}
