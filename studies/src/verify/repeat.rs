//! A stored result against the same case solved again: every number and every word but what work cost.
//!
//! Solvers are deterministic: on the machine that wrote a result, solving again gives the same bits. Another
//! machine may round otherwise, which changes many numbers a little; a changed file changes few, or much.

use serde_json::Value as Json;

/// Entries of a case that say what work cost, not what the structure does.
const COST: [&str; 2] = ["counters", "seconds"];
/// Differences of one case that are listed; the others are counted.
const LISTED: usize = 4;
/// Relative difference that rounding of another machine may leave after a path.
const ROUNDING: f64 = 1e-7;
/// The same relative to the greatest number of the same entry.
const FLOOR: f64 = 1e-10;
/// Least share of the numbers of a case that differ where another machine computed them.
const SPREAD: f64 = 0.1;

/// Where two JSON values differ.
#[derive(Debug, Default)]
struct Comparison {
    /// Words, whole numbers, lists and keys that differ.
    words: Vec<String>,
    /// Numbers that differ by rounding or more.
    numbers: Vec<String>,
    /// Notes that differ.
    notes: Vec<String>,
    /// Whether some number differs by more than rounding.
    beyond: bool,
    /// Numbers compared that are not zero.
    compared: usize,
}

/// What is different in `stored` from `again`, in words; nothing where they are the same, or the same but for the
/// rounding of another machine. Keys of `COST` at the top are not looked at.
pub fn differences(stored: &Json, again: &Json) -> Vec<String> {
    let mut comparison = Comparison::default();
    comparison.entry(&without_cost(stored), &without_cost(again), "", 0.0);
    let Comparison { mut words, numbers, notes, beyond, compared } = comparison;
    let rounded = !beyond && words.is_empty() && numbers.len() as f64 >= SPREAD * compared as f64;
    if !rounded || numbers.is_empty() {
        words.extend(numbers);
        words.extend(notes);
    }
    let more = words.len().saturating_sub(LISTED);
    words.truncate(LISTED);
    if more > 0 {
        words.push(format!("{more} more entries are not those of solving again"));
    }
    words
}

fn without_cost(value: &Json) -> Json {
    let mut value = value.clone();
    if let Some(map) = value.as_object_mut() {
        COST.iter().for_each(|key| drop(map.shift_remove(*key)));
    }
    value
}

/// The greatest number anywhere below a value.
fn greatest(value: &Json) -> f64 {
    match value {
        Json::Number(number) => number.as_f64().map_or(0.0, f64::abs),
        Json::Array(items) => items.iter().map(greatest).fold(0.0, f64::max),
        Json::Object(map) => map.values().map(greatest).fold(0.0, f64::max),
        _ => 0.0,
    }
}

/// A value in a sentence: whole where it is short.
fn shown(value: &Json) -> String {
    let text = value.to_string();
    if text.chars().count() <= 60 { text } else { text.chars().take(57).chain("…".chars()).collect() }
}

impl Comparison {
    fn differ(&mut self, stored: &Json, again: &Json, path: &str) {
        let text = format!("{path} is {}, solving again gives {}", shown(stored), shown(again));
        let list = if path.starts_with("notes") { &mut self.notes } else { &mut self.words };
        list.push(text);
    }

    /// Compares what stands at `path`; `scale` is the greatest number of the entry at the top.
    fn entry(&mut self, stored: &Json, again: &Json, path: &str, scale: f64) {
        match (stored, again) {
            (Json::Number(a), Json::Number(b)) if a.is_f64() || b.is_f64() => self.number(stored, again, path, scale),
            (Json::Array(a), Json::Array(b)) if a.len() == b.len() => {
                for (index, (a, b)) in a.iter().zip(b).enumerate() {
                    self.entry(a, b, &format!("{path}[{index}]"), scale);
                }
            }
            (Json::Object(a), Json::Object(b)) => {
                for (key, again) in b {
                    let place = if path.is_empty() { key.clone() } else { format!("{path}.{key}") };
                    let scale = if path.is_empty() { greatest(again) } else { scale };
                    match a.get(key) {
                        Some(stored) => self.entry(stored, again, &place, scale),
                        None => self.words.push(format!("there is no {place}, solving again gives {}", shown(again))),
                    }
                }
                let foreign = a.keys().filter(|key| !b.contains_key(*key));
                self.words.extend(foreign.map(|key| format!("{path}{key} is not in what solving again gives")));
            }
            _ if stored == again => {}
            _ => self.differ(stored, again, path),
        }
    }

    fn number(&mut self, stored: &Json, again: &Json, path: &str, scale: f64) {
        let (a, b) = (stored.as_f64().unwrap_or(f64::NAN), again.as_f64().unwrap_or(f64::NAN));
        self.compared += usize::from(b != 0.0);
        if a == b {
            return;
        }
        let close = (a - b).abs() <= ROUNDING * b.abs() + FLOOR * scale;
        // A residual is rounding itself.
        self.beyond |= !close && !path.starts_with("certificate.residuals");
        self.numbers.push(format!("{path} is {stored}, solving again gives {again}"));
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

    /// One number changed by 1e-12, a word, a missing and a foreign key are found; seconds are not looked at.
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
    }

    /// Rounding of another machine touches many numbers by little; the same with one of them changed is found.
    #[test]
    fn another_machine_is_not_a_forgery() {
        let mut rounded = case();
        for entry in rounded["field"].as_array_mut().expect("a list") {
            entry["force"][0] = json!(entry["force"][0].as_f64().expect("a number") * (1.0 + 1e-13));
        }
        assert_eq!(differences(&rounded, &case()), Vec::<String>::new());
        rounded["load_factor"] = json!(0.1 * (1.0 + 1e-6));
        assert!(!differences(&rounded, &case()).is_empty());
    }
}
