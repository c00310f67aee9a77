//! A family of forgeries of eight kinds of results: each number times 1 + 1e-6, 1.1 and −1, each word replaced by
//! another of its kind, each entry of a list left out or doubled. In results of this program on this processor all
//! forgeries are found. In results that name another processor all forgeries above the tolerances are found. Entries
//! that the comparison leaves out are listed here.

use super::forgery::{BRIDGE, WORDS, optimum, path};
use super::tolerances::of_another_processor;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use voussoir::study::Study;
use voussoir_tests::written::{findings, results};
use voussoir_tests::{Arch, friction};

/// Entries that are not claims about the structure: cost, version, and entries of the head that only choose the
/// comparison.
pub const FREE: [&str; 7] =
    ["/counters", "/seconds", "/version", "/platform", "/processor_features", "/mathematics", "/plugins"];
/// Entries that are not compared with a second run on another processor: free words, residuals within their gates, work
/// of a search.
const FREE_ELSEWHERE: [&str; 5] = ["/notes", "/failures", "/residuals", "/bracket", "/why"];
/// Entries that are compared as functions on another processor. A vertex on the curve may be left out or doubled, and a
/// change below the tolerance of the curve makes the same claim.
const FUNCTIONS: [&str; 1] = ["/curve"];

/// Entries that are compared with tolerances of up to a twentieth of the greatest number.
const LOOSE: [&str; 3] = ["/events", "/curve", "/fall"];

struct Forgery {
    at: String,
    value: Value,
    /// True if it is larger than every tolerance.
    large: bool,
}

/// Collects all forgeries below a value; `greatest` is the greatest number of each key.
fn forge(value: &Value, at: &str, greatest: &BTreeMap<String, f64>, out: &mut Vec<Forgery>) {
    if FREE.iter().any(|free| at.ends_with(free)) {
        return;
    }
    let mut add = |value: Value, large: bool| out.push(Forgery { at: at.into(), value, large });
    match value {
        Value::Number(number) if number.is_f64() => {
            let x = number.as_f64().expect("a float");
            // Numbers are compared relative to the greatest number of their key.
            let share = if LOOSE.iter().any(|key| at.contains(key)) { 0.6 } else { 0.01 };
            let big = x.abs() > share * greatest[&key(at)];
            if x == 0.0 {
                add(json!(1e-6), false);
            } else {
                add(json!(x * (1.0 + 1e-6)), false);
                add(json!(x * 1.1), big);
                add(json!(-x), big);
            }
        }
        Value::Number(number) => add(json!(number.as_i64().map_or(1, |n| n + 1)), true),
        Value::String(word) => match WORDS.iter().find(|row| row.contains(&word.as_str())) {
            Some(row) => row.iter().filter(|other| *other != word).for_each(|other| add(json!(other), true)),
            None => add(json!(format!("{word}x")), true),
        },
        Value::Bool(yes) => add(json!(!yes), true),
        Value::Null => add(json!(1.0), true),
        Value::Array(items) => {
            let without = |index: usize| {
                items.iter().enumerate().filter(|(i, _)| *i != index).map(|(_, item)| item.clone()).collect::<Vec<_>>()
            };
            for index in 0..items.len() {
                add(json!(without(index)), true);
                add(json!([&items[..=index], &items[index..]].concat()), true);
            }
            items.iter().enumerate().for_each(|(i, item)| forge(item, &format!("{at}/{i}"), greatest, out));
        }
        Value::Object(map) => {
            let slashes = |key: &str| key.replace('~', "~0").replace('/', "~1");
            map.iter().for_each(|(key, item)| forge(item, &format!("{at}/{}", slashes(key)), greatest, out));
        }
    }
}

/// Returns a place without its indices.
fn key(at: &str) -> String {
    at.split('/').filter(|part| part.parse::<usize>().is_err()).collect::<Vec<_>>().join("/")
}

/// Finds the greatest number of each key.
fn measure(value: &Value, at: &str, out: &mut BTreeMap<String, f64>) {
    match value {
        Value::Number(number) => {
            let own = out.entry(at.into()).or_insert(0.0);
            *own = own.max(number.as_f64().map_or(0.0, f64::abs));
        }
        Value::Array(items) => items.iter().for_each(|item| measure(item, at, out)),
        Value::Object(map) => {
            let slashes = |key: &str| key.replace('~', "~0").replace('/', "~1");
            map.iter().for_each(|(name, item)| measure(item, &format!("{at}/{}", slashes(name)), out));
        }
        _ => {}
    }
}

/// Tries about `count` forgeries, evenly distributed. Returns the number of forgeries tried here and as of another
/// processor, and the forgeries that were confirmed.
fn tried(name: &str, (study, original): &(Study, Value), count: usize) -> ([usize; 2], Vec<String>) {
    let foreign = of_another_processor(original);
    for untouched in [original, &foreign] {
        assert_eq!(findings(study, untouched), Vec::<String>::new(), "{name}: untouched");
    }
    let mut all = Vec::new();
    let mut greatest = BTreeMap::new();
    measure(original, "", &mut greatest);
    forge(original, "", &greatest, &mut all);
    let step = (all.len() as f64 / count as f64).max(1.0);
    let chosen = (0..count.min(all.len())).map(|i| &all[(i as f64 * step) as usize]);
    let (mut number, mut confirmed) = ([0, 0], Vec::new());
    for Forgery { at, value, large } in chosen {
        let free = |list: &[&str]| list.iter().any(|key| at.contains(key));
        let elsewhere = *large && !free(&FREE_ELSEWHERE) && !(free(&FUNCTIONS) && value.as_f64().is_none());
        let forms = [(original, true, "here"), (&foreign, elsewhere, "elsewhere")];
        for (index, (results, is_tried, place)) in forms.into_iter().enumerate() {
            if !is_tried {
                continue;
            }
            let mut forged = results.clone();
            *forged.pointer_mut(at).expect("the place exists") = value.clone();
            number[index] += 1;
            if findings(study, &forged).is_empty() {
                let text = value.to_string().chars().take(60).collect::<String>();
                confirmed.push(format!("{name}, {place}: {at} changed to {text}"));
            }
        }
    }
    println!("{name}: {} of {} forgeries tried here, {} as of another processor", number[0], all.len(), number[1]);
    (number, confirmed)
}

fn family(count: usize) {
    let arch = |friction: String| Arch { joint: friction, ..Arch::default() };
    let dry = arch(friction(0.6)).study();
    let widths = "[sweep]\n\"scene.width\" = { list = [1.0, 2.0] }\n";
    let variants =
        "[[variants]]\nname = \"dry\"\n[[variants]]\nname = \"slippery\"\nset = { \"joints.dry.friction\" = 0.35 }\n";
    let map = "kind = \"map\"\n[sweep]\n\"scene.thickness\" = { list = [0.5, 0.6] }\n\"scene.width\" = { list = [1.0, 2.0] }\n";
    let envelope = "kind = \"envelope\"\nenvelope = { parameter = \"stages.1.loads.0.at\", from = 0.3, to = 1.5, scan = 3, \
                    tolerance = 0.3, directions = \"forward\" }\n";
    let (kind, sweep) = map.split_once('\n').expect("two parts");
    let studies = [
        ("limit", format!("{dry}{widths}")),
        ("finite path", path("newton_path", "finite", false)),
        ("small path", path("event_path", "small", false)),
        ("compare", format!("kind = \"compare\"\n{dry}{variants}")),
        ("map", format!("{kind}\n{dry}{sweep}{variants}")),
        ("optimise", optimum()),
        ("envelope", format!("{envelope}{BRIDGE}")),
        ("sliding", format!("{}{widths}", arch(friction(0.3)).study())),
    ];
    let (mut number, mut confirmed) = ([0, 0], Vec::new());
    for (name, text) in studies {
        let (own, found) = tried(name, &results(&text), count);
        number = [number[0] + own[0], number[1] + own[1]];
        confirmed.extend(found);
    }
    println!("{} forgeries here, {} as of another processor, {} confirmed", number[0], number[1], confirmed.len());
    assert_eq!(confirmed, Vec::<String>::new());
}

#[test]
fn a_sample_of_the_family() {
    family(25);
}

#[test]
#[ignore = "long: more than 4000 forgeries"]
fn the_family() {
    family(550);
}
