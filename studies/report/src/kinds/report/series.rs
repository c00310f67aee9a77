//! Series: the study and the results from which they are made.

use super::types::Type;
use super::value::Value;
use crate::figures::hinges::{DrawnHinge, named_hinges};
use crate::kinds::point::result::PointRows;
use serde::Deserialize;
use serde_json::{Map, Value as Json};
use voussoir_core::certificate::{Hinge, Side};
use voussoir_core::plugin::{Keys, OutputOf};
use voussoir_study::results::{OutputEntry, PathRecord, StoredEntry};

/// The table `[report.series.NAME]`.
#[derive(Debug, Clone, PartialEq, Keys)]
pub struct Selection {
    /// name of one of the studies
    #[key(optional = "points are given")]
    pub study: Option<String>,
    /// name of its variant
    #[key(optional = "entries of every variant")]
    pub variant: Option<String>,
    /// swept keys, whole or by their last name, with the value that is meant
    #[key(default = {}, name = "where")]
    pub fixed: Map<String, Json>,
    /// the key that makes the abscissa
    #[key(optional = "the first swept key that `where` leaves free")]
    pub over: Option<String>,
    /// least abscissa
    #[key(unit = "-", optional = "no bound")]
    pub from: Option<f64>,
    /// greatest abscissa
    #[key(unit = "-", optional = "no bound")]
    pub to: Option<f64>,
    /// path of a result in an entry: "mechanism.hinges.*.joint"
    #[key(default = "load_factor")]
    pub result: String,
    /// list of results.json that is read: cases, optima, worsts, curve
    #[key(default = "cases")]
    pub entries: String,
    /// expression of `x`, for charts and tables: "9.42 / x"
    #[key(default = "x")]
    pub x: String,
    /// expression of `y`, for charts and tables
    #[key(default = "y")]
    pub y: String,
    /// words for legends
    #[key(optional = "the name of the series")]
    pub label: Option<String>,
    /// published numbers instead of results: \[\[x, y\], ...\]
    #[key(unit = "-", len = ">= 1, <= 1000", optional = "a study is given")]
    pub points: Option<Vec<[f64; 2]>>,
}

/// An entry of results with its abscissa.
#[derive(Debug, Clone)]
pub struct Chosen<'a> {
    /// Abscissa.
    pub x: f64,
    /// The head of the entry.
    pub head: StoredEntry,
    entry: &'a Json,
}

/// Returns true if a name means a whole key: it is the key itself, or its last segments.
fn meant(key: &str, name: &str) -> bool {
    key == name || key.strip_suffix(name).is_some_and(|before| before.ends_with('.'))
}

fn same(a: &Json, b: &Json) -> bool {
    match (a.as_f64(), b.as_f64()) {
        (Some(a), Some(b)) => (a - b).abs() <= 1e-9 * a.abs().max(b.abs()),
        _ => a == b,
    }
}

/// Returns a named value of an entry: a swept key, or an entry in the table itself.
fn named<'a>(head: &'a StoredEntry, entry: &'a Json, name: &str) -> Option<&'a Json> {
    let swept = head.parameters.iter().find(|(key, _)| meant(key, name)).map(|(_, value)| value);
    swept.or_else(|| entry.get(name))
}

impl Selection {
    /// Returns the selected entries by ascending abscissa; `results` is the results.json of the study.
    pub fn choose<'a>(&self, results: &'a Json) -> Vec<Chosen<'a>> {
        let entries = results[self.entries.as_str()].as_array().into_iter().flatten();
        let choose = |entry: &'a Json| {
            let head = StoredEntry::of(entry);
            let fits = |(name, value): (&String, &Json)| named(&head, entry, name).is_some_and(|own| same(own, value));
            let of_variant = self.variant.is_none() || self.variant == head.variant;
            let x = self.abscissa(&head, entry).filter(|_| of_variant && self.fixed.iter().all(fits))?;
            let inside = self.from.is_none_or(|low| x >= low) && self.to.is_none_or(|high| x <= high);
            inside.then_some(Chosen { x, head, entry })
        };
        let mut chosen: Vec<Chosen> = entries.filter_map(choose).collect();
        chosen.sort_by(|a, b| a.x.total_cmp(&b.x));
        chosen
    }

    fn abscissa(&self, head: &StoredEntry, entry: &Json) -> Option<f64> {
        if let Some(over) = &self.over {
            return named(head, entry, over)?.as_f64();
        }
        if self.entries == "curve" {
            return head.value;
        }
        let free = |key: &str| !self.fixed.keys().any(|name| meant(key, name));
        let mut numbers = head.parameters.iter().filter(|(key, _)| free(key)).filter_map(|(_, value)| value.as_f64());
        Some(numbers.next().unwrap_or(0.0))
    }

    /// Returns the type of each element, if the path of the result determines it.
    pub fn element_type(&self) -> Type {
        match self.result.as_str() {
            _ if self.points.is_some() => Type::Number,
            "load_factor" | "first_limit_point" | "curve" | "mechanism.hinge_count" => Type::Number,
            output if output.starts_with("outputs.") => Type::Number,
            "status" | "variant" | "mechanism.kind" => Type::Word,
            _ => Type::Unknown,
        }
    }

    /// Returns the series; `results` returns the results.json of a study by its name.
    pub fn value<'a>(&self, results: &dyn Fn(&str) -> Option<&'a Json>) -> Value {
        if let Some(points) = &self.points {
            return Value::Series(points.iter().map(|[x, y]| (*x, Value::Number(*y))).collect());
        }
        let study = self.study.as_deref().unwrap_or_default();
        let Some(results) = results(study) else { return Value::unknown(format!("{study} has no results")) };
        let chosen = self.choose(results);
        if self.result == "curve" {
            return match chosen.as_slice() {
                [one] => curve(one.entry),
                several => Value::unknown(format!("a curve is that of one case, not of {}", several.len())),
            };
        }
        if chosen.is_empty() {
            return Value::unknown(format!("{study} has no such results"));
        }
        Value::Series(
            chosen.iter().map(|chosen| (chosen.x, result(&chosen.head, chosen.entry, &self.result))).collect(),
        )
    }
}

/// Returns displacement in millimetres and factor along the path of a case.
fn curve(case: &Json) -> Value {
    let points = PathRecord::deserialize(case).ok().and_then(|path| path.curve).unwrap_or_default();
    let points: Vec<(f64, Value)> = points.iter().map(|[x, y]| (x * 1e3, Value::Number(*y))).collect();
    if points.is_empty() {
        Value::unknown("there is no curve: [output] curve = true asks for it")
    } else {
        Value::Series(points)
    }
}

/// Returns the value at a path of an entry; a load factor also if it is infinite.
fn result(head: &StoredEntry, entry: &Json, path: &str) -> Value {
    let status = head.status();
    if ["load_factor", "first_limit_point", "result", "value"].contains(&path) {
        match (status, entry[path].as_f64()) {
            ("unbounded", _) if path != "value" => return Value::Number(f64::INFINITY),
            ("unbounded", _) => return Value::none("unbounded"),
            // A proved limit point is an answer, for any continuation of the path.
            ("open", Some(number)) if path == "first_limit_point" => return Value::Number(number),
            ("open", _) => return Value::unknown("a case is open"),
            (_, Some(number)) => return Value::Number(number),
            ("stalled", _) => return Value::unknown("a case stalled"),
            _ if path == "first_limit_point" => return result(head, entry, "load_factor"),
            (word, _) => return Value::none(word.replace('_', " ")),
        }
    }
    if let Some(name) = path.strip_prefix("outputs.") {
        return output(entry, name);
    }
    if let Some(column) = path.strip_prefix("last.") {
        return last(entry, column);
    }
    let names: Vec<&str> = path.split('.').collect();
    if names[0] == "mechanism"
        && !head.has_mechanism()
        && ["collapse", "limit_point", "open", "stalled"].contains(&status)
    {
        return Value::unknown("no mechanism was found");
    }
    follow(entry, &names)
}

/// Returns the value of an output of the case.
fn output(entry: &Json, name: &str) -> Value {
    let outputs = Vec::<OutputEntry>::deserialize(&entry["outputs"]).unwrap_or_default();
    let mut of_case = outputs.iter().filter(|own| own.of == OutputOf::Case && own.name == name);
    match (of_case.next(), of_case.next()) {
        (Some(one), None) => match one.values.first().copied().flatten() {
            Some(number) => Value::Number(number),
            None => Value::unknown(format!("the output {name} is not finite")),
        },
        (None, _) => Value::unknown(format!("there is no output {name} of the case")),
        _ => Value::unknown(format!("two plug-ins have an output {name}")),
    }
}

/// Returns the last value of a column of a driven point.
fn last(entry: &Json, column: &str) -> Value {
    match PointRows::deserialize(entry).ok().and_then(|rows| rows.last(column)) {
        Some(number) => Value::Number(number),
        None => Value::unknown(format!("there is no column {column}")),
    }
}

/// Returns the sides of hinges in engineering notation, in order.
fn sides(hinges: &[Json]) -> Value {
    let hinges: Vec<Hinge> = hinges.iter().filter_map(|hinge| Hinge::deserialize(hinge).ok()).collect();
    let side = |hinge: &DrawnHinge| match hinge.main().side {
        Some(Side::Intrados) => "intrados",
        Some(Side::Extrados) => "extrados",
        None => "none",
    };
    Value::List(named_hinges(&hinges).iter().map(|hinge| Value::Word(side(hinge).into())).collect())
}

/// Returns the number of places of hinges along the ring: consecutive hinges at neighbouring joints on one side are one place.
fn places(hinges: &[Json]) -> Value {
    let mut sides: Vec<Option<&Json>> = hinges.iter().map(|hinge| hinge.get("side")).collect();
    sides.dedup();
    Value::Number(sides.len() as f64)
}

fn follow(value: &Json, path: &[&str]) -> Value {
    let Some((name, rest)) = path.split_first() else { return plain(value) };
    match (*name, value) {
        ("sides", Json::Array(hinges)) => sides(hinges),
        ("places", Json::Array(hinges)) => places(hinges),
        ("*", Json::Array(items)) => Value::List(items.iter().map(|item| follow(item, rest)).collect()),
        (index, Json::Array(items)) => match index.parse::<usize>().ok().and_then(|index| items.get(index)) {
            Some(item) => follow(item, rest),
            None => Value::none(format!("no entry {index}")),
        },
        (key, Json::Object(map)) => {
            map.get(key).map_or_else(|| Value::none(format!("no {key}")), |value| follow(value, rest))
        }
        (key, _) => Value::none(format!("no {key}")),
    }
}

fn plain(value: &Json) -> Value {
    match value {
        Json::Number(number) => Value::Number(number.as_f64().unwrap_or(f64::NAN)),
        Json::String(word) => Value::Word(word.clone()),
        Json::Bool(truth) => Value::Truth(*truth),
        Json::Array(items) => Value::List(items.iter().map(plain).collect()),
        _ => Value::none("none"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    fn selection(more: Json) -> Selection {
        let mut table = json!({ "study": "s", "result": "load_factor", "entries": "cases", "x": "x", "y": "y" });
        table.as_object_mut().expect("a table").extend(more.as_object().expect("a table").clone());
        serde_json::from_value(table).expect("a selection")
    }

    #[test]
    fn results_are_found_by_variant_and_swept_key() {
        let case = |variant: &str, rise: f64, place: f64, status: &str, factor: Json| {
            json!({ "variant": variant, "parameters": { "scene.profile.rise": rise, "a.b": place }, "status": status, "load_factor": factor,
                    "mechanism": { "hinges": [{ "joint": 1, "side": "extrados" }, { "joint": 4, "side": "intrados" }, { "joint": 5, "side": "intrados" }] } })
        };
        let results = json!({ "cases": [
            case("one", 2.0, 0.5, "collapse", json!(7.0)), case("one", 1.0, 0.5, "unbounded", json!(null)),
            case("one", 1.0, 0.25, "collapse", json!(3.0)), case("two", 1.0, 0.5, "collapse", json!(5.0)),
        ] });
        let value = |more: Json| selection(more).value(&|_| Some(&results));
        let found = value(json!({ "variant": "one", "where": { "b": 0.5 } }));
        assert_eq!(found, Value::Series(vec![(1.0, Value::Number(f64::INFINITY)), (2.0, Value::Number(7.0))]));
        let joints = value(json!({ "variant": "two", "over": "rise", "result": "mechanism.hinges.*.joint" }));
        let list = Value::List([1.0, 4.0, 5.0].map(Value::Number).into());
        assert_eq!(joints, Value::Series(vec![(1.0, list)]));
        let places = value(json!({ "variant": "two", "over": "rise", "result": "mechanism.hinges.places" }));
        assert_eq!(places, Value::Series(vec![(1.0, Value::Number(2.0))]));
        assert!(matches!(value(json!({ "variant": "three" })), Value::Missing { proven: false, .. }));
    }

    /// A series may show an output of the case. An unknown name, a value that is not finite and an ambiguous name are unknown.
    #[test]
    fn an_output_of_the_case_is_a_result() {
        let output = |plugin: &str, name: &str, of: &str, value: Json| json!({ "plugin": plugin, "kind": "interface_law", "name": name, "unit": "m", "of": of, "values": [value] });
        let outputs = json!([
            output("a", "crack", "joint", json!(1.0)),
            output("a", "crack", "case", json!(2.5)),
            output("a", "endless", "case", json!(null)),
            output("a", "twice", "case", json!(1.0)),
            output("b", "twice", "case", json!(2.0)),
        ]);
        let results = json!({ "cases": [{ "parameters": { "a.b": 3.0 }, "status": "stands", "outputs": outputs }] });
        let value = |name: &str| selection(json!({ "result": format!("outputs.{name}") })).value(&|_| Some(&results));
        assert_eq!(value("crack"), Value::Series(vec![(3.0, Value::Number(2.5))]));
        for (name, why) in [
            ("endless", "the output endless is not finite"),
            ("twice", "two plug-ins have an output twice"),
            ("crak", "there is no output crak of the case"),
        ] {
            assert_eq!(value(name), Value::Series(vec![(3.0, Value::unknown(why))]), "{name}");
        }
        assert_eq!(selection(json!({ "result": "outputs.crack" })).element_type(), Type::Number);
    }
}
