//! Truth tables of expressions: every operator and function for every kind of value, with the whole answer.

use super::claims::Claim;
use super::evaluate::{FUNCTIONS, evaluate};
use super::expression::Expression;
use super::series::Selection;
use super::types::Type;
use super::value::Value;
use serde_json::{Value as Json, json};

/// A value with its kind: `none` if it is proved not to exist, `unknown` if it is only missing.
fn shown(value: &Value) -> String {
    let join = |parts: Vec<String>| parts.join(", ");
    match value {
        Value::Missing { why, proven: true } => format!("none ({why})"),
        Value::Missing { why, proven: false } => format!("unknown ({why})"),
        Value::Number(x) => x.to_string(),
        Value::Word(word) => format!("'{word}'"),
        Value::Truth(truth) => truth.to_string(),
        Value::List(values) => format!("[{}]", join(values.iter().map(shown).collect())),
        Value::Series(points) => {
            format!("{{{}}}", join(points.iter().map(|(x, value)| format!("{x}: {}", shown(value))).collect()))
        }
    }
}

fn series(values: Vec<Value>) -> Value {
    Value::Series(values.into_iter().enumerate().map(|(i, value)| (i as f64, value)).collect())
}

fn named(name: &str) -> Option<Value> {
    let numbers = |values: &[f64]| Some(series(values.iter().copied().map(Value::Number).collect()));
    let truths = |values: &[bool]| Some(series(values.iter().copied().map(Value::Truth).collect()));
    let words = |values: &[&str]| values.iter().map(|word| Value::Word(word.to_string())).collect();
    match name {
        "yes" => Some(Value::Truth(true)),
        "no" => Some(Value::Truth(false)),
        "none" => Some(Value::none("no equilibrium")),
        "stalled" => Some(Value::unknown("a case stalled")),
        "inf" => Some(Value::Number(f64::INFINITY)),
        "up" => numbers(&[1.0, 2.0, 4.0]),
        "down" => numbers(&[4.0, 2.0, 1.0]),
        "flat" => numbers(&[2.0, 2.0]),
        "hill" => numbers(&[1.0, 3.0, 3.0, 2.0]),
        "valley" => numbers(&[3.0, 1.0, 2.0]),
        "zigzag" => numbers(&[1.0, 3.0, 2.0, 4.0, 1.0]),
        "unbounded" => numbers(&[1.0, f64::INFINITY, f64::INFINITY]),
        "sunk" => numbers(&[1.0, f64::NEG_INFINITY]),
        "one" => numbers(&[5.0]),
        "empty" => Some(series(Vec::new())),
        "gap" => Some(series(vec![Value::Number(1.0), Value::none("no equilibrium"), Value::Number(3.0)])),
        "lost" => Some(series(vec![Value::none("no equilibrium"), Value::none("no equilibrium")])),
        "hole" => Some(series(vec![Value::Number(1.0), Value::unknown("a case stalled"), Value::Number(3.0)])),
        "mixed" => Some(series(vec![Value::Number(1.0), Value::Word("sliding".into())])),
        "both" => truths(&[true, true]),
        "either" => truths(&[false, true, true, false]),
        "neither" => truths(&[false, false]),
        "torn" => Some(series(vec![Value::Truth(true), Value::unknown("a case stalled")])),
        "torn_false" => Some(series(vec![Value::unknown("a case stalled"), Value::Truth(false)])),
        "kinds" => Some(series(words(&["hinges", "sliding"]))),
        "list" => Some(Value::List(vec![Value::Number(1.0), Value::Number(2.0), Value::Number(6.0)])),
        "sides" => Some(Value::List(words(&["intrados", "extrados"]))),
        "bare" => Some(Value::List(Vec::new())),
        "far" => Some(Value::Series(vec![(1.0, Value::Number(10.0)), (7.0, Value::Number(20.0))])),
        "near" => Some(Value::Series(vec![(1.0 + 5e-10, Value::Number(30.0)), (7.0, Value::Number(40.0))])),
        "large" => Some(Value::Series(vec![(1000.0, Value::Number(1.0))])),
        "large_near" => Some(Value::Series(vec![(1000.0 + 5e-7, Value::Number(2.0))])),
        "off" => Some(Value::Series(vec![(1.0 + 1e-6, Value::Number(30.0))])),
        _ => None,
    }
}

fn value(text: &str) -> String {
    shown(&evaluate(&Expression::parse(text).expect("an expression"), &named))
}

/// Asserts a table of lines "expression → answer"; all lines that differ are reported at once.
fn table(lines: &[(&str, &str)]) {
    let differs = |(text, answer): &&(&str, &str)| value(text) != *answer;
    let wrong: Vec<String> =
        lines.iter().filter(differs).map(|(text, answer)| format!("{text} → {}, not {answer}", value(text))).collect();
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

/// Arithmetic and comparisons of numbers, at, below and above each limit.
#[test]
fn numbers_are_added_and_compared() {
    table(&[
        ("3 + 4", "7"),
        ("3 - 4", "-1"),
        ("3 * 4", "12"),
        ("3 / 4", "0.75"),
        ("-3 - -4", "1"),
        ("1 / 0", "inf"),
        ("0 / 0", "none (no number)"),
        ("inf - inf", "none (no number)"),
        ("3 < 4", "true"),
        ("4 < 4", "false"),
        ("5 < 4", "false"),
        ("3 <= 4", "true"),
        ("4 <= 4", "true"),
        ("5 <= 4", "false"),
        ("3 > 4", "false"),
        ("4 > 4", "false"),
        ("5 > 4", "true"),
        ("3 >= 4", "false"),
        ("4 >= 4", "true"),
        ("5 >= 4", "true"),
        ("3 == 4", "false"),
        ("4 == 4", "true"),
        ("3 != 4", "true"),
        ("4 != 4", "false"),
        ("3 and 4", "unknown (numbers are no truths)"),
        ("3 or 4", "unknown (numbers are no truths)"),
    ]);
}

/// Truths and words: every operator; operators of numbers have no answer for them.
#[test]
fn truths_and_words_are_joined_and_compared() {
    for (a, b) in [(true, true), (true, false), (false, true), (false, false)] {
        let word = |truth| if truth { "yes" } else { "no" };
        for (operator, answer) in [("and", a && b), ("or", a || b), ("==", a == b), ("!=", a != b)] {
            assert_eq!(value(&format!("{} {operator} {}", word(a), word(b))), answer.to_string(), "{a} {operator} {b}");
        }
    }
    table(&[
        ("not yes", "false"),
        ("not no", "true"),
        ("not 3", "unknown (\"not\" of 3)"),
        ("yes + no", "unknown (truths are neither added nor ordered)"),
        ("yes < no", "unknown (truths are neither added nor ordered)"),
        ("'a' == 'a'", "true"),
        ("'a' == 'b'", "false"),
        ("'a' != 'a'", "false"),
        ("'a' != 'b'", "true"),
        ("'a' == 1", "false"),
        ("'a' != 1", "true"),
        ("'a' < 'b'", "unknown (a and b are no numbers)"),
        ("'a' + 1", "unknown (a and 1 are no numbers)"),
        ("-'a'", "unknown (a is no number)"),
        ("sides == sides", "true"),
        ("sides != sides", "false"),
    ]);
}

/// A value that cannot exist compares false and is unequal to everything; a value that is only missing leaves the answer
/// open, if the other side does not decide.
#[test]
fn missing_values_decide_only_what_is_proved() {
    for operator in ["<", "<=", ">", ">=", "=="] {
        table(&[
            (&format!("none {operator} 1"), "false"),
            (&format!("1 {operator} none"), "false"),
            (&format!("stalled {operator} 1"), "unknown (a case stalled)"),
            (&format!("1 {operator} stalled"), "unknown (a case stalled)"),
            (&format!("none {operator} stalled"), "unknown (a case stalled)"),
        ]);
    }
    for operator in ["+", "-", "*", "/"] {
        table(&[
            (&format!("none {operator} 1"), "none (no equilibrium)"),
            (&format!("1 {operator} none"), "none (no equilibrium)"),
            (&format!("1 {operator} stalled"), "unknown (a case stalled)"),
        ]);
    }
    table(&[
        ("none != 1", "true"),
        ("stalled != 1", "unknown (a case stalled)"),
        ("no and stalled", "false"),
        ("stalled and no", "false"),
        ("yes and stalled", "unknown (a case stalled)"),
        ("yes or stalled", "true"),
        ("stalled or yes", "true"),
        ("no or stalled", "unknown (a case stalled)"),
        ("yes and none", "false"),
        ("none or no", "false"),
        ("not none", "none (no equilibrium)"),
        ("not stalled", "unknown (a case stalled)"),
        ("-none", "none (no equilibrium)"),
        ("abs(stalled)", "unknown (a case stalled)"),
        ("nowhere", "unknown (there is no nowhere)"),
        ("nothing(1)", "unknown (there is no function nothing)"),
        ("abs()", "unknown (an argument is missing)"),
    ]);
}

/// Operators act element by element; two series are paired by abscissa, to nine digits.
#[test]
fn series_are_joined_by_abscissa() {
    table(&[
        ("up + 1", "{0: 2, 1: 3, 2: 5}"),
        ("10 - up", "{0: 9, 1: 8, 2: 6}"),
        ("-up", "{0: -1, 1: -2, 2: -4}"),
        ("up > 1", "{0: false, 1: true, 2: true}"),
        ("not (up > 1)", "{0: true, 1: false, 2: false}"),
        ("up - flat", "{0: -1, 1: 0}"),
        ("far + near", "{1: 40, 7: 60}"),
        ("far + off", "{}"),
        ("large + large_near", "{1000: 3}"),
        ("gap > 2", "{0: false, 1: false, 2: true}"),
        ("gap + none", "{0: none (no equilibrium), 1: none (no equilibrium), 2: none (no equilibrium)}"),
        ("hole > 0", "{0: true, 1: unknown (a case stalled), 2: true}"),
        ("abs(1 - up)", "{0: 0, 1: 1, 2: 3}"),
        ("kinds == 'sliding'", "{0: false, 1: true}"),
    ]);
}

/// Greatest and least values and their places; a proved gap is left out, a missing value leaves them open.
#[test]
fn extremes_of_series() {
    table(&[
        ("max(hill)", "3"),
        ("argmax(hill)", "1"),
        ("min(hill)", "1"),
        ("argmin(hill)", "0"),
        ("argmin(valley)", "1"),
        ("min(valley)", "1"),
        ("max(unbounded)", "inf"),
        ("argmax(unbounded)", "none (no greatest: unbounded at 2 of 3)"),
        ("min(unbounded)", "1"),
        ("argmin(unbounded)", "0"),
        ("argmin(sunk)", "none (no greatest: unbounded at 1 of 2)"),
        ("argmax(sunk)", "0"),
        ("max(gap)", "3"),
        ("argmax(gap)", "2"),
        ("max(lost)", "none (no value)"),
        ("max(hole)", "unknown (a case stalled)"),
        ("argmin(hole)", "unknown (a case stalled)"),
        ("max(mixed)", "unknown (sliding is no number)"),
        ("max(empty)", "unknown (the series is empty)"),
        ("max(none)", "none (no equilibrium)"),
        ("max(list)", "6"),
        ("argmax(list)", "2"),
        ("max(3)", "3"),
        ("argmax(3)", "0"),
    ]);
}

/// `all` and `any` have three answers; one element may decide.
#[test]
fn all_and_any() {
    table(&[
        ("all(both)", "true"),
        ("all(either)", "false"),
        ("all(neither)", "false"),
        ("any(both)", "true"),
        ("any(either)", "true"),
        ("any(neither)", "false"),
        ("all(torn)", "unknown (a case stalled)"),
        ("any(torn)", "true"),
        ("all(torn_false)", "false"),
        ("any(torn_false)", "unknown (a case stalled)"),
        ("all(yes)", "true"),
        ("any(no)", "false"),
        ("all(empty)", "unknown (the series is empty)"),
        ("any(none)", "none (no equilibrium)"),
        ("all(stalled)", "unknown (a case stalled)"),
        ("count(either)", "2"),
        ("count(neither)", "0"),
        ("count(torn)", "1"),
        ("count(no)", "0"),
        ("count(stalled)", "unknown (a case stalled)"),
    ]);
}

/// The abscissas at which a condition is true.
#[test]
fn places_where_a_series_is_true() {
    table(&[
        ("highest_where(either)", "2"),
        ("lowest_where(either)", "1"),
        ("highest_where(neither)", "none (nowhere)"),
        ("lowest_where(neither)", "none (nowhere)"),
        ("highest_where(torn)", "unknown (a case stalled)"),
        ("lowest_where(torn)", "unknown (a case stalled)"),
        ("highest_where(up)", "unknown (1)"),
        ("highest_where(empty)", "unknown (the series is empty)"),
        ("lowest_where(none)", "none (no equilibrium)"),
    ]);
}

/// Order of values along the abscissa. Equal neighbours count as rising and as falling.
#[test]
fn order_of_series() {
    table(&[
        ("rising(up)", "true"),
        ("falling(up)", "false"),
        ("rising(down)", "false"),
        ("falling(down)", "true"),
        ("rising(flat)", "true"),
        ("falling(flat)", "true"),
        ("rising(zigzag)", "false"),
        ("falling(zigzag)", "false"),
        ("rising(gap)", "true"),
        ("falling(gap)", "false"),
        ("rising(hole)", "unknown (a case stalled)"),
        ("rising(one)", "true"),
        ("rises_then_falls(hill)", "true"),
        ("rises_then_falls(up)", "false"),
        ("rises_then_falls(down)", "false"),
        ("rises_then_falls(flat)", "false"),
        ("rises_then_falls(valley)", "false"),
        ("rises_then_falls(zigzag)", "false"),
        ("rises_then_falls(one)", "false"),
        ("rises_then_falls(within(zigzag, 0, 2))", "true"),
        ("rises_then_falls(within(zigzag, 2, 4))", "true"),
        ("rises_then_falls(-zigzag)", "false"),
        ("rises_then_falls(lost)", "none (no value)"),
        ("rises_then_falls(hole)", "unknown (a case stalled)"),
        ("rises_then_falls(empty)", "unknown (the series is empty)"),
    ]);
}

/// Functions of lists; a value that is not a list is a list of one.
#[test]
fn functions_of_lists() {
    table(&[
        ("mean(list)", "3"),
        ("mean(4)", "4"),
        ("mean(bare)", "none (no value)"),
        ("mean(sides)", "unknown (intrados is no number)"),
        ("mean(up)", "{0: 1, 1: 2, 2: 4}"),
        ("length(list)", "3"),
        ("length(bare)", "0"),
        ("length(4)", "1"),
        ("length('a')", "1"),
        ("length(none)", "none (no equilibrium)"),
        ("length(gap)", "{0: 1, 1: none (no equilibrium), 2: 1}"),
        ("first(list)", "1"),
        ("last(list)", "6"),
        ("first(bare)", "none (an empty list)"),
        ("last(bare)", "none (an empty list)"),
        ("first(4)", "4"),
        ("last(4)", "4"),
        ("words(sides)", "'intrados extrados'"),
        ("words(4)", "'4'"),
        ("has(sides, 'intrados')", "true"),
        ("has(sides, 'none')", "false"),
        ("has('a', 'a')", "true"),
        ("has('a', 'b')", "false"),
        ("has(none, 'a')", "false"),
        ("has(stalled, 'a')", "unknown (a case stalled)"),
        ("has(kinds, 'sliding')", "{0: false, 1: true}"),
        ("has(gap, 3)", "{0: false, 1: false, 2: true}"),
        ("has(hole, 3)", "{0: false, 1: unknown (a case stalled), 2: true}"),
    ]);
}

/// Values at an abscissa, to six digits, and parts of a series, to nine digits of its width.
#[test]
fn values_at_an_abscissa() {
    table(&[
        ("at(far, 7)", "20"),
        ("at(far, 7.000006)", "20"),
        ("at(far, 6.999994)", "20"),
        ("at(far, 7.00001)", "unknown (nothing stands at 7.00001)"),
        ("at(far, 6.99999)", "unknown (nothing stands at 6.99999)"),
        ("at(up, 0)", "1"),
        ("at(up, 0.0000000000005)", "1"),
        ("at(up, 0.000001)", "unknown (nothing stands at 0.000001)"),
        ("at(far, 'a')", "unknown (\"at\" needs a number)"),
        ("at(none, 1)", "none (no equilibrium)"),
        ("at(empty, 1)", "unknown (the series is empty)"),
        ("within(zigzag, 1, 3)", "{1: 3, 2: 2, 3: 4}"),
        ("within(zigzag, 1.000000001, 2.9999999985)", "{1: 3, 2: 2, 3: 4}"),
        ("within(zigzag, 1.00000001, 2.99999999)", "{2: 2}"),
        ("within(zigzag, 2, 2)", "{2: 2}"),
        ("within(far, 2, 3)", "{}"),
        ("within(large, 1000.000001, 1000.5)", "{}"),
        ("within(up, 'a', 2)", "unknown (\"within\" needs two numbers)"),
        ("within(up, 0, none)", "unknown (\"within\" needs two numbers)"),
        ("within(none, 0, 1)", "none (no equilibrium)"),
    ]);
}

/// Recoveries of a curve: its slope falls below half of a slope that it reaches later, before the peak. A slope of exactly
/// half is no recovery; two soft pieces in a row are one; points after the peak do not count.
#[test]
fn recoveries_of_a_curve() {
    let curve = |points: &[(f64, f64)]| {
        let points: Vec<(f64, Value)> = points.iter().map(|(x, y)| (*x, Value::Number(*y))).collect();
        let names = |name: &str| (name == "curve").then(|| Value::Series(points.clone()));
        shown(&evaluate(&Expression::parse("recoveries(curve)").expect("an expression"), &names))
    };
    let stiff_soft_stiff = [(0.0, 0.0), (1.0, 1.0), (2.0, 1.25), (3.0, 2.25)];
    assert_eq!(curve(&stiff_soft_stiff), "1");
    assert_eq!(curve(&[(0.0, 0.0), (1.0, 1.0), (2.0, 1.5), (3.0, 2.5)]), "0");
    assert_eq!(curve(&[(0.0, 0.0), (1.0, 0.25), (2.0, 0.5), (3.0, 1.5)]), "1");
    assert_eq!(curve(&[(0.0, 0.0), (1.0, 0.25), (2.0, 1.25), (3.0, 1.5), (4.0, 2.5)]), "2");
    assert_eq!(curve(&[(0.0, 0.0), (1.0, 1.0), (2.0, 0.0), (3.0, 0.9)]), "0");
    assert_eq!(curve(&[(0.0, 0.0), (2.0, 2.0), (4.0, 3.0), (5.0, 3.0)]), "0");
    // The slope is used, not the rise of a step; a curve in metres has the same number as one in millimetres.
    let uneven = [(0.0, 0.0), (2.0, 2.0), (4.0, 2.5), (4.5, 3.5)];
    assert_eq!(curve(&uneven), "1");
    assert_eq!(curve(&uneven.map(|(x, y)| (1e-3 * x, y))), "1");
    // Steps of equal abscissa have no slope.
    assert_eq!(curve(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.5), (2.0, 1.5)]), "0");
    assert_eq!(curve(&[(0.0, 0.0)]), "0");
    table(&[
        ("recoveries(lost)", "none (no value)"),
        ("recoveries(hole)", "unknown (a case stalled)"),
        ("recoveries(empty)", "unknown (the series is empty)"),
    ]);
}

/// Every function is in a line above, with its number of arguments and the type of its answer.
#[test]
fn signatures() {
    let found: Vec<String> = FUNCTIONS
        .iter()
        .map(|function| {
            let gives = function.gives.map_or("as its first argument", Type::describe);
            format!("{}/{}: {gives}", function.name, function.takes.len())
        })
        .collect();
    let expected = [
        "abs/1: a number",
        "argmax/1: a number",
        "argmin/1: a number",
        "max/1: a number",
        "min/1: a number",
        "all/1: true or false",
        "any/1: true or false",
        "highest_where/1: a number",
        "lowest_where/1: a number",
        "count/1: a number",
        "rising/1: true or false",
        "falling/1: true or false",
        "rises_then_falls/1: true or false",
        "mean/1: a number",
        "length/1: a number",
        "first/1: as its first argument",
        "last/1: as its first argument",
        "recoveries/1: a number",
        "at/2: as its first argument",
        "words/1: a word",
        "has/2: true or false",
        "within/3: as its first argument",
    ];
    assert_eq!(found, expected);
}

/// Values in words, as a reader of a report sees them.
#[test]
fn values_in_words() {
    for (text, words) in [
        ("none", "no equilibrium"),
        ("inf", "unbounded"),
        ("-inf", "-inf"),
        ("1 / 3", "0.333333"),
        ("'limit_point'", "limit point"),
        ("yes", "yes"),
        ("no", "no"),
        ("list", "1, 2, 6"),
        ("far", "10 at 1; 20 at 7"),
    ] {
        let value = evaluate(&Expression::parse(text).expect("an expression"), &named);
        assert_eq!(value.describe(), words, "{text}");
    }
    assert_eq!(named("inf").and_then(|value| value.number()), Some(f64::INFINITY));
    assert_eq!(named("yes").and_then(|value| value.number()), None);
}

fn selection(more: Json) -> Selection {
    let mut table = json!({ "study": "s", "result": "load_factor", "entries": "cases", "x": "x", "y": "y" });
    table.as_object_mut().expect("a table").extend(more.as_object().expect("a table").clone());
    serde_json::from_value(table).expect("a selection")
}

/// The series of a selection from cases.
fn selected(more: Json, cases: Json) -> String {
    let results = json!({ "cases": cases });
    shown(&selection(more).value(&|study| (study == "s").then_some(&results)))
}

/// A load factor is a number only with a status that proves it; each status without one says if a load cannot exist.
#[test]
fn load_factors_by_status() {
    for (result, status, number, answer) in [
        ("load_factor", "collapse", json!(7.5), "7.5"),
        ("load_factor", "limit_point", json!(7.5), "7.5"),
        ("load_factor", "unbounded", json!(null), "inf"),
        ("load_factor", "unbounded", json!(7.5), "inf"),
        ("load_factor", "open", json!(7.5), "unknown (a case is open)"),
        ("load_factor", "open", json!(null), "unknown (a case is open)"),
        ("load_factor", "stalled", json!(null), "unknown (a case stalled)"),
        ("load_factor", "stalled", json!(7.5), "7.5"),
        ("load_factor", "no_equilibrium", json!(null), "none (no equilibrium)"),
        ("load_factor", "equilibrium_only", json!(null), "none (equilibrium only)"),
        ("first_limit_point", "collapse", json!(7.5), "7.5"),
        ("first_limit_point", "open", json!(7.5), "7.5"),
        ("first_limit_point", "open", json!(null), "unknown (a case is open)"),
        ("first_limit_point", "unbounded", json!(null), "inf"),
        ("value", "unbounded", json!(null), "none (unbounded)"),
        ("value", "open", json!(7.5), "unknown (a case is open)"),
        ("result", "unbounded", json!(null), "inf"),
    ] {
        let found = selected(json!({ "result": result }), json!([{ "status": status, result: number }]));
        assert_eq!(found, format!("{{0: {answer}}}"), "{result}, {status}, {number}");
    }
    let peak = json!([{ "status": "collapse", "first_limit_point": null, "load_factor": 7.5 }]);
    assert_eq!(selected(json!({ "result": "first_limit_point" }), peak), "{0: 7.5}");
}

/// Paths of results: tables, lists, their entries, all entries, sides and places of hinges.
#[test]
fn results_by_their_path() {
    let hinge = |joint: usize, side: &str| json!({ "joint": joint, "between": ["a", "b"], "side": side, "point": [joint, 0.0], "rotation": 1.0 });
    let case = json!({
        "status": "collapse", "flag": true, "word": "a", "list": [1, "b"], "nothing": null,
        "mechanism": { "kind": "hinges", "hinges": [hinge(1, "extrados"), hinge(3, "intrados"), hinge(4, "intrados")] },
        "columns": ["gap [m]", "stress [Pa]"], "rows": [[1.0, 2.0], [3.0, 4.0]],
    });
    for (path, answer) in [
        ("status", "'collapse'"),
        ("flag", "true"),
        ("list", "[1, 'b']"),
        ("list.0", "1"),
        ("list.1", "'b'"),
        ("list.2", "none (no entry 2)"),
        ("list.a", "none (no entry a)"),
        ("nothing", "none (none)"),
        ("missing", "none (no missing)"),
        ("word.more", "none (no more)"),
        ("mechanism.kind", "'hinges'"),
        ("mechanism.hinges.*.joint", "[1, 3, 4]"),
        ("mechanism.hinges.places", "2"),
        ("mechanism.hinges.sides", "['extrados', 'intrados']"),
        ("last.gap", "3"),
        ("last.stress", "4"),
        ("last.slip", "unknown (there is no column slip)"),
    ] {
        assert_eq!(selected(json!({ "result": path }), json!([case])), format!("{{0: {answer}}}"), "{path}");
    }
    for (status, answer) in [
        ("collapse", "unknown (no mechanism was found)"),
        ("limit_point", "unknown (no mechanism was found)"),
        ("open", "unknown (no mechanism was found)"),
        ("stalled", "unknown (no mechanism was found)"),
        ("unbounded", "none (no kind)"),
    ] {
        let cases = json!([{ "status": status, "mechanism": null }]);
        assert_eq!(selected(json!({ "result": "mechanism.kind" }), cases), format!("{{0: {answer}}}"), "{status}");
    }
}

/// Entries are chosen by variant, by swept keys with their whole or last name, and by the range of the abscissa, ends included.
#[test]
fn entries_of_a_selection() {
    let case = |variant: &str, rise: f64, friction: f64, factor: f64| {
        json!({ "variant": variant, "status": "collapse", "load_factor": factor,
                "parameters": { "scene.profile.rise": rise, "joints.dry.friction": friction } })
    };
    let cases = json!([
        case("a", 3.0, 0.5, 30.0),
        case("a", 1.0, 0.5, 10.0),
        case("a", 2.0, 0.5, 20.0),
        case("a", 2.0, 0.6, 26.0),
        case("b", 2.0, 0.5, 21.0),
    ]);
    for (more, answer) in [
        (json!({ "variant": "a", "where": { "friction": 0.5 } }), "{1: 10, 2: 20, 3: 30}"),
        (json!({ "variant": "a", "where": { "joints.dry.friction": 0.6 } }), "{2: 26}"),
        (json!({ "variant": "a", "where": { "friction": 0.6000000001 } }), "{2: 26}"),
        (json!({ "variant": "a", "where": { "friction": 0.60000001 } }), "unknown (s has no such results)"),
        (json!({ "variant": "a", "where": { "riction": 0.6 } }), "unknown (s has no such results)"),
        (json!({ "variant": "a", "where": { "friction": 0.5 }, "from": 2.0 }), "{2: 20, 3: 30}"),
        (json!({ "variant": "a", "where": { "friction": 0.5 }, "to": 2.0 }), "{1: 10, 2: 20}"),
        (json!({ "variant": "b" }), "{2: 21}"),
        (json!({ "where": { "rise": 2.0, "friction": 0.5 } }), "{0: 20, 0: 21}"),
        (json!({ "variant": "a", "where": { "rise": 2.0 }, "over": "friction" }), "{0.5: 20, 0.6: 26}"),
        (json!({ "variant": "c" }), "unknown (s has no such results)"),
        (json!({ "where": { "status": "collapse", "variant": "b" } }), "{2: 21}"),
        (json!({ "where": { "status": "open" } }), "unknown (s has no such results)"),
        (json!({ "study": "t" }), "unknown (t has no results)"),
        (json!({ "points": [[1.0, 2.0], [3.0, 4.0]] }), "{1: 2, 3: 4}"),
    ] {
        assert_eq!(selected(more.clone(), cases.clone()), answer, "{more}");
    }
}

/// A curve belongs to one case; its displacements are in millimetres.
#[test]
fn curves_of_a_case() {
    let one = json!({ "status": "collapse", "curve": [[0.0, 0.0], [0.002, 5.0]] });
    let none = json!({ "status": "collapse" });
    let curve = |cases: Json| selected(json!({ "result": "curve" }), cases);
    assert_eq!(curve(json!([one])), "{0: 0, 2: 5}");
    assert_eq!(curve(json!([one, one])), "unknown (a curve is that of one case, not of 2)");
    assert_eq!(curve(json!([none])), "unknown (there is no curve: [output] curve = true asks for it)");
    let types = ["load_factor", "first_limit_point", "curve", "mechanism.hinge_count", "status", "variant", "list"]
        .map(|result| selection(json!({ "result": result })).element_type().describe());
    assert_eq!(types, ["a number", "a number", "a number", "a number", "a word", "a word", "any value"]);
    assert_eq!(selection(json!({ "result": "status", "points": [[0.0, 0.0]] })).element_type(), Type::Number);
}

/// Names of an expression are seen once each, functions with their number of arguments.
#[test]
fn names_of_an_expression() {
    let expression = Expression::parse("not a or -b < at(c, 'd') + within(e, 1, 2) * 3").expect("an expression");
    let mut seen = Vec::new();
    expression.names(&mut |name, arguments| seen.push((name.to_string(), arguments)));
    let expected = [("a", None), ("b", None), ("at", Some(2)), ("c", None), ("within", Some(3)), ("e", None)];
    assert_eq!(seen, expected.map(|(name, arguments)| (name.to_string(), arguments)));
}

/// Operators bind as in algebra; spaces, quotes and words inside names do not matter; each mistake is reported.
#[test]
fn expressions_are_read() {
    table(&[
        ("1 - 2 - 3", "-4"),
        ("8 / 4 / 2", "1"),
        ("2 + 3 * 4 - 1", "13"),
        ("(2 + 3) * 4", "20"),
        ("no or yes and no", "false"),
        ("(no or yes) and yes", "true"),
        ("1<2", "true"),
        ("1e3 + 1.5E-1 + .5 + 2e+1", "1020.65"),
        ("\"a b\" == 'a b'", "true"),
        ("notable", "unknown (there is no notable)"),
        ("android or yes", "true"),
        ("--3", "3"),
        ("not not yes", "true"),
        ("abs( -3 )", "3"),
    ]);
    let wrong = |text: &str| Expression::parse(text).expect_err("a mistake");
    assert_eq!(wrong("(1"), "\")\" is missing at its end");
    assert_eq!(wrong("(1 2"), "\")\" is missing before \"2\"");
    assert_eq!(wrong("1e"), "\"1e\" is no number");
    assert_eq!(wrong("1.2.3"), "\"1.2.3\" is no number");
    assert_eq!(wrong("'a"), "a number, a name or \"(\" is missing before \"'a\"");
    assert_eq!(wrong(""), "a number, a name or \"(\" is missing at its end");
    assert!(Expression::parse(&format!("{}1", "-".repeat(59))).is_ok());
    assert!(Expression::parse(&format!("{}1", "-".repeat(60))).is_err());
}

/// The verdict of a claim from its tests: all hold, none holds, some hold, or a number is missing; its words and its entry.
#[test]
fn verdicts_of_claims() {
    for (conditions, words, verdict) in [
        (["value > 0", "yes"], "reproduced", "reproduced"),
        (["value < 0", "no"], "refuted", "refuted"),
        (["value > 0", "no"], "depends on the strength", "depends_on"),
        (["value < 0", "yes"], "depends on the strength", "depends_on"),
        (["value > 0", "stalled > 1"], "undecided", "undecided"),
        (["no", "stalled > 1"], "undecided", "undecided"),
        (["value > 0", "value"], "undecided", "undecided"),
        (["value > 0", "1 +"], "undecided", "undecided"),
    ] {
        let test = |holds: &str| json!({ "of": "arch", "value": "max(up)", "unit": "kN", "holds": holds });
        let claim: Claim = serde_json::from_value(json!({
            "id": "3", "claim": "it carries", "source": "p. 4", "depends_on": "the strength", "remark": "",
            "tests": [test(conditions[0]), test(conditions[1])],
        }))
        .expect("a claim");
        let answer = claim.answer(&[&named]);
        assert_eq!(answer.words(), words, "{conditions:?}");
        let entry = answer.entry();
        let depends_on = if verdict == "depends_on" { json!("the strength") } else { json!(null) };
        assert_eq!([&entry["verdict"], &entry["depends_on"]], [&json!(verdict), &depends_on], "{conditions:?}");
        let first = &entry["tests"][0];
        assert_eq!(
            [&first["value"], &first["unit"], &first["condition"]],
            [&json!(4.0), &json!("kN"), &json!(conditions[0])]
        );
        assert_eq!(
            [&entry["id"], &entry["claim"], &entry["source"]],
            [&json!("3"), &json!("it carries"), &json!("p. 4")]
        );
    }
    for (value, entry) in [
        ("max(up)", json!(4.0)),
        ("yes", json!(true)),
        ("inf", json!("unbounded")),
        ("stalled", json!("a case stalled")),
        ("1 +", json!("a number, a name or \"(\" is missing at its end")),
    ] {
        let claim: Claim = serde_json::from_value(json!({
            "id": "1", "claim": "", "source": "", "remark": "",
            "tests": [{ "of": "", "value": value, "unit": "", "holds": "no" }],
        }))
        .expect("a claim");
        let answer = claim.answer(&[&named]);
        assert_eq!(answer.entry()["tests"][0]["value"], entry, "{value}");
        assert_eq!(
            (answer.entry()["tests"][0]["holds"].clone(), answer.words()),
            (json!(false), "refuted".to_string())
        );
    }
}
