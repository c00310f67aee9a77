//! Files of the scene `assembly`, which become its keys.

use super::{obj, stored_assembly};
use serde_json::{Map, Value as Json};

/// The keys that a file replaces.
pub(crate) const KEYS: [&str; 2] = ["blocks", "contacts"];

/// Returns the keys of a file by its name: polyhedra of an OBJ file, or an assembly as JSON. The error is a sentence.
pub(crate) fn keys_of_file(file: &str, text: &str) -> Result<Map<String, Json>, String> {
    let lower = file.to_lowercase();
    let ends = |ending: &str| lower.trim_end_matches(".gz").ends_with(ending);
    if ends(".obj") {
        obj::read(text)
    } else if ends(".json") {
        stored_assembly::read(text)
    } else {
        Err("its ending is not one of .json, .json.gz, .obj, .obj.gz".into())
    }
}
