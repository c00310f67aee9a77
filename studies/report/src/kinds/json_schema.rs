//! The JSON Schema of study files, for editors: keys of all study kinds and all cards.

use serde_json::{Value as Json, json};
use voussoir_study::config::json_schema::{definitions, table};
use voussoir_study::kind::kinds;
use voussoir_study::study::study_keys;

/// Returns the schema of study files: the schema of studies with a scene, unless their kind has its own keys.
pub fn json_schema() -> Json {
    let mut definitions = definitions();
    definitions.insert("study".into(), table(study_keys(), None));
    let mut schema = json!({ "$ref": "#/$defs/study" });
    for entry in kinds() {
        let Some(keys) = entry.kind.file_keys() else { continue };
        let name = format!("{}_study", entry.tag);
        schema = json!({
            "if": { "properties": { "kind": { "const": entry.tag } }, "required": ["kind"] },
            "then": { "$ref": format!("#/$defs/{name}") },
            "else": schema,
        });
        definitions.insert(name, table(keys, None));
    }
    schema["$schema"] = "https://json-schema.org/draft/2020-12/schema".into();
    schema["title"] = "Voussoir study".into();
    schema["$defs"] = definitions.into();
    schema
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_reference_has_a_definition_and_every_law_its_own() {
        let schema = json_schema();
        let text = schema.to_string();
        for target in text.split("\"#/$defs/").skip(1).filter_map(|rest| rest.split('"').next()) {
            assert!(schema["$defs"].get(target).is_some(), "{target}");
        }
        let coulomb = &schema["$defs"]["interface_law_coulomb"];
        assert_eq!(coulomb["properties"]["law"]["const"], "coulomb");
        assert_eq!(coulomb["properties"]["friction"]["anyOf"][0]["minimum"], 0.0);
        assert_eq!(coulomb["additionalProperties"], false);
    }
}
