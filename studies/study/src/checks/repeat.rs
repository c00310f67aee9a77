//! Compares a stored result with the same case solved again by the same program on the same kind of processor. All
//! numbers and words must be equal, except counters and seconds. Solvers are deterministic, so a difference means that
//! something has changed.

use serde_json::Value as Json;

/// Keys at the top of a case that are not compared.
const COST: [&str; 2] = ["counters", "seconds"];
/// Greatest number of listed differences of one case; the others are counted.
const LISTED: usize = 4;

/// Returns the differences of `stored` from `again` in words.
pub fn differences(stored: &Json, again: &Json) -> Vec<String> {
    let mut found = Vec::new();
    entry(&without_cost(stored), &without_cost(again), "", &mut found);
    listed(found)
}

/// The first differences, and the number of the others.
pub(crate) fn listed(mut found: Vec<String>) -> Vec<String> {
    let more = found.len().saturating_sub(LISTED);
    found.truncate(LISTED);
    if more > 0 {
        found.push(format!("{more} more entries differ when the case is solved again"));
    }
    found
}

fn without_cost(value: &Json) -> Json {
    let mut value = value.clone();
    if let Some(map) = value.as_object_mut() {
        COST.iter().for_each(|key| drop(map.shift_remove(*key)));
    }
    value
}

/// A value in a sentence, at most 60 characters of it.
pub(crate) fn shown(value: &Json) -> String {
    let text = value.to_string();
    if text.chars().count() <= 60 { text } else { text.chars().take(57).chain("…".chars()).collect() }
}

/// The message for a value that differs.
pub(crate) fn differs(path: &str, stored: &Json, again: &Json) -> String {
    format!("{path} is {}, but solving the case again gives {}", shown(stored), shown(again))
}

/// The pairs of values below two maps, each with its path, and messages for keys that only one of them has.
pub(crate) fn pairs<'a>(
    (stored, again): (&'a serde_json::Map<String, Json>, &'a serde_json::Map<String, Json>),
    path: &str,
    found: &mut Vec<String>,
) -> Vec<(String, &'a Json, &'a Json)> {
    let place = |key: &str| if path.is_empty() { key.to_string() } else { format!("{path}.{key}") };
    let foreign = stored.keys().filter(|key| !again.contains_key(*key));
    found.extend(foreign.map(|key| format!("{}: solving the case again gives no such value", place(key))));
    let mut both = Vec::new();
    for (key, again) in again {
        match stored.get(key) {
            Some(stored) => both.push((place(key), stored, again)),
            None => {
                found.push(format!("there is no {}, but solving the case again gives {}", place(key), shown(again)))
            }
        }
    }
    both
}

fn entry(stored: &Json, again: &Json, path: &str, found: &mut Vec<String>) {
    match (stored, again) {
        (Json::Number(a), Json::Number(b)) if a.as_f64() == b.as_f64() => {}
        (Json::Array(a), Json::Array(b)) if a.len() == b.len() => {
            for (index, (a, b)) in a.iter().zip(b).enumerate() {
                entry(a, b, &format!("{path}[{index}]"), found);
            }
        }
        (Json::Object(a), Json::Object(b)) => {
            for (path, a, b) in pairs((a, b), path, found) {
                entry(a, b, &path, found);
            }
        }
        _ if stored == again => {}
        _ => found.push(differs(path, stored, again)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn case() -> Json {
        let field: Vec<Json> =
            (0..20).map(|i| json!({ "joint": i, "force": [1000.0 / 3.0 + f64::from(i), 0.1] })).collect();
        json!({ "status": "collapse", "load_factor": 0.1, "field": field, "notes": ["a"], "seconds": 1.0 })
    }

    /// One number changed by 1e-12, a word, a missing and a foreign key are found; seconds are not compared.
    #[test]
    fn a_change_is_found() {
        assert_eq!(differences(&case(), &case()), Vec::<String>::new());
        let changed = |path: &str, value: Json| {
            let mut changed = case();
            *changed.pointer_mut(path).expect("a path") = value;
            differences(&changed, &case())
        };
        assert_eq!(changed("/seconds", json!(3.0)), Vec::<String>::new());
        for (path, value) in [
            ("/load_factor", json!(0.1 * (1.0 + 1e-12))),
            ("/load_factor", json!(null)),
            ("/status", json!("stands")),
            ("/field/3/joint", json!(4)),
            ("/field/3/force/1", json!(-0.1)),
            ("/field", json!([])),
            ("/notes/0", json!("b")),
        ] {
            assert_eq!(changed(path, value).len(), 1, "{path}");
        }
        let (mut missing, mut foreign) = (case(), case());
        missing.as_object_mut().expect("a map").remove("notes");
        foreign["own"] = json!(1);
        assert_eq!((differences(&missing, &case()).len(), differences(&foreign, &case()).len()), (1, 1));
        let mut rounded = case();
        for entry in rounded["field"].as_array_mut().expect("a list") {
            entry["force"][0] = json!(entry["force"][0].as_f64().expect("a number") * (1.0 + 1e-15));
        }
        assert!(!differences(&rounded, &case()).is_empty(), "bits are compared");
    }
}
