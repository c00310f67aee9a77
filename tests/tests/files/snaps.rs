//! A structure whose greatest limit point is not its first one: every output shows both numbers with equal weight, and
//! `verify` finds every change of the data after a limit point.

use super::forgery::WORDS;
use serde_json::{Value, json};
use voussoir::kinds::{RunOutput, RunRequest, read_study};
use voussoir::solve::Unobserved;
use voussoir_tests::written::{findings, results};
use voussoir_tests::{Arch, changed};

/// A ring of eight rigid voussoirs on compliant joints, pushed down and sideways, with finite displacements. At the
/// first limit point a joint slips; the load falls by a fifteenth and then rises to the second limit point.
const RING: &str = r#"
name = "ring"
[scene]
scene = "arch"
profile = { shape = "segmental", span = 9.5334, rise = 2.0531 }
thickness = 1.6463
width = 1.0
voussoirs = 8
ends = "jointed"
material = "stone"
joint = "dry"
mesh = { elements = [2, 2], order = 1 }
[materials.stone]
law = "rigid"
density = 2157.15
[joints.dry]
law = "coulomb"
friction = 0.67678
normal_stiffness = 2.15436e8
shear_stiffness = 1.82783e8
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", span_fraction = 0.1781, force = [-5998.86, -41079.6] }]
[solver]
solver = "newton_path"
kinematics = "finite"
[output]
curve = true
"#;

fn ring(change: &str) -> String {
    format!("{RING}{change}")
}

fn run(text: &str) -> RunOutput {
    let study = read_study(text, "ring.toml", &[]).unwrap_or_else(|wrong| panic!("{wrong}"));
    let request = RunRequest { wanted: (0..study.count()).collect(), jobs: 1, ..RunRequest::default() };
    study.run(&request, &Unobserved)
}

fn file(output: &RunOutput, name: &str) -> String {
    let (_, bytes) = output.files.iter().find(|(own, _)| own == name).expect("the file");
    String::from_utf8(bytes.clone()).expect("text")
}

fn first_case(text: &str) -> Value {
    results(text).1["cases"][0].clone()
}

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap_or_else(|| panic!("{value} is no number"))
}

#[test]
fn both_limit_points_have_equal_weight_in_every_file() {
    let output = run(RING);
    let results: Value = serde_json::from_str(&file(&output, "results.json")).expect("JSON");
    let case = &results["cases"][0];
    let (greatest, first) = (number(&case["load_factor"]), number(&case["first_limit_point"]));
    assert!(first < 0.99 * greatest, "{first} {greatest}");
    let digits = |x: f64| format!("{x:.5}");
    let words = format!("carries {}; snaps from {}", digits(greatest), digits(first));
    assert!(output.table.contains(&words), "{words}: {}", output.table);
    let page = file(&output, "report.html");
    let summary = page.split("<p class=\"summary\">").nth(1).expect("a summary");
    let sentence = summary.split("</strong>").next().unwrap_or_default();
    assert!(sentence.contains("carries λ = ") && sentence.contains("; snaps from λ = "), "{sentence}");
    let csv = file(&output, "results.csv");
    let rows: Vec<Vec<&str>> = csv.lines().take(2).map(|row| row.split(',').collect()).collect();
    for (column, value) in [("load_factor [-]", greatest), ("first_limit_point [-]", first)] {
        let at = rows[0].iter().position(|name| *name == column).expect("a column");
        assert_eq!(rows[1][at], value.to_string(), "{column}");
    }
}

#[test]
fn a_limit_point_has_its_fall_its_energy_and_the_next_state_at_its_load() {
    let case = first_case(RING);
    let points = case["limit_points"].as_array().expect("limit points");
    assert_eq!(points.len(), 2, "{points:?}");
    let [first, greatest] = [&points[0], &points[1]];
    assert_eq!(first["factor"], case["first_limit_point"]);
    assert_eq!(greatest["factor"], case["load_factor"]);
    let (next, own) = (number(&first["next_state"]["displacement"]), number(&first["displacement"]));
    assert!(own < next && next < number(&greatest["displacement"]), "{own} {next}");
    // The area between the load and the path, from the stored curve.
    let curve: Vec<[f64; 2]> = serde_json::from_value(case["curve"].clone()).expect("a curve");
    let below = |factor: f64| number(&first["factor"]) - factor;
    let top = curve.windows(2).position(|pair| pair[1][1] < pair[0][1]).expect("a fall");
    let back = curve[top..].windows(2).position(|pair| below(pair[0][1]) > 0.0 && below(pair[1][1]) <= 0.0);
    let fallen = &curve[top..=top + back.expect("the load comes back")];
    let trapezium = |p: &[[f64; 2]]| 0.5 * (below(p[0][1]) + below(p[1][1])) * (p[1][0] - p[0][0]);
    let area: f64 = 5998.86f64.hypot(41079.6) * fallen.windows(2).map(trapezium).sum::<f64>();
    let released = number(&first["released_energy"]);
    assert!((area - released).abs() < 0.05 * released.abs(), "{area} {released}");
    // After the greatest limit point the load does not reach its value again.
    assert_eq!(greatest["next_state"], Value::Null);
    let fall = number(&greatest["fall"]);
    assert!(2.0 * fall >= number(&greatest["factor"]), "{fall} {}", greatest["released_energy"]);
}

#[test]
fn a_path_says_where_it_was_followed_to() {
    let case = first_case(RING);
    let curve: Vec<[f64; 2]> = serde_json::from_value(case["curve"].clone()).expect("a curve");
    let [displacement, factor] = *curve.last().expect("a point");
    assert_eq!(case["followed_to"], json!({ "stage": "live", "factor": factor, "displacement": displacement }));
    assert!(factor <= 0.5 * number(&case["load_factor"]), "{factor}");
}

#[test]
fn until_first_limit_point_ends_where_load_control_ends() {
    let whole = first_case(RING);
    let first = number(&whole["first_limit_point"]);
    let requested = changed(RING, "until = \"collapse\"", "until = \"first_limit_point\"");
    let control = changed(RING, "[output]", "continuation = { strategy = \"load_control\" }\n[output]");
    for (text, word) in [(requested, "requested"), (control, "load_control")] {
        let case = first_case(&text);
        assert_eq!((case["status"].as_str(), case["continuation"].as_str()), (Some("limit_point"), Some(word)));
        for key in ["load_factor", "first_limit_point"] {
            let factor = number(&case[key]);
            assert!((factor - first).abs() < 1e-6 * first, "{word}, {key}: {factor} {first}");
        }
        let listed = case["limit_points"].as_array().expect("limit points");
        assert_eq!(listed.len(), 1, "{word}");
        // Data after the end of the range are left out.
        assert!(listed[0]["released_energy"].is_null() && listed[0]["next_state"].is_null(), "{word}: {}", listed[0]);
    }
    assert_eq!(whole["continuation"], Value::Null, "a collapse has no reason to end at a limit point");
}

#[test]
fn a_plateau_that_is_reached_first_sets_both_numbers() {
    let elastic = changed(
        &Arch::default().study(),
        "law = \"rigid\"",
        "law = \"elastic\"\nyoung_modulus = 5e9\npoisson_ratio = 0.3",
    );
    let case = first_case(&elastic);
    assert_eq!(case["status"], "collapse");
    assert_eq!(case["first_limit_point"], case["load_factor"]);
    assert_eq!(case["followed_to"]["factor"], case["load_factor"]);
}

#[test]
fn a_chart_of_a_sweep_has_both_curves_if_they_differ() {
    let swept = |text: &str| format!("{text}[sweep]\n\"scene.width\" = {{ list = [1.0, 1.1] }}\n");
    let both = file(&run(&swept(RING)), "figures/sweep.svg");
    assert!(both.contains("first limit point"), "no second curve");
    let alone = changed(RING, "until = \"collapse\"", "until = \"first_limit_point\"");
    assert!(!file(&run(&swept(&alone)), "figures/sweep.svg").contains("first limit point"));
}

#[test]
fn an_envelope_has_both_numbers_and_both_curves() {
    let search = "kind = \"envelope\"\nenvelope = { parameter = \"stages.1.loads.0.span_fraction\", from = 0.178, to = 0.1785, scan = 3, \
                  tolerance = 0.5 }\n";
    let output = run(&changed(RING, "name = \"ring\"\n", &format!("name = \"ring\"\n{search}")));
    let results: Value = serde_json::from_str(&file(&output, "results.json")).expect("JSON");
    let worst = &results["worsts"][0];
    assert!(number(&worst["first_limit_point"]) < number(&worst["result"]), "{worst}");
    assert!(output.table.contains("worst: carries"), "{}", output.table);
    assert!(file(&output, "report.html").contains("first limit point"));
}

#[test]
fn a_comparison_shows_both_numbers() {
    let text = ring(
        "[[variants]]\nname = \"whole\"\n[[variants]]\nname = \"first\"\nset = { \"stages.1.until\" = \"first_limit_point\" }\n",
    );
    let output = run(&changed(&text, "name = \"ring\"", "name = \"ring\"\nkind = \"compare\""));
    let table = output.table.rsplit("load factors (").next().expect("a table");
    assert!(table.contains("carries") && table.contains("snaps from"), "{table}");
    assert!(file(&output, "comparison.csv").contains("whole: first_limit_point [-]"));
}

#[test]
fn every_change_of_a_limit_point_is_found() {
    let (study, original) = results(&changed(RING, "until = \"collapse\"", "until = \"first_limit_point\""));
    assert_eq!(findings(&study, &original), Vec::<String>::new());
    let (whole, both) = results(RING);
    assert_eq!(findings(&whole, &both), Vec::<String>::new());
    let found = |(study, original): (&_, &Value), at: &str, value: Value| {
        let mut forged = original.clone();
        *forged["cases"][0].pointer_mut(at).unwrap_or_else(|| panic!("{at} exists")) = value.clone();
        assert!(!findings(study, &forged).is_empty(), "{at} changed to {value} was not found");
    };
    let words = WORDS.iter().find(|row| row.contains(&"load_control")).expect("a row");
    for word in words.iter().filter(|word| **word != "requested") {
        found((&study, &original), "/continuation", json!(word));
    }
    found((&study, &original), "/continuation", Value::Null);
    for at in [
        "/followed_to/factor",
        "/followed_to/displacement",
        "/limit_points/0/released_energy",
        "/limit_points/0/next_state/displacement",
    ] {
        let value = number(both["cases"][0].pointer(at).expect("a number"));
        found((&whole, &both), at, json!(value * (1.0 + 1e-6)));
    }
    found((&whole, &both), "/followed_to/stage", json!("dead"));
    found((&whole, &both), "/followed_to", Value::Null);
    found((&whole, &both), "/limit_points/0/next_state/stable_under_load", json!(true));
    found((&whole, &both), "/limit_points/0/next_state", Value::Null);
    found((&whole, &both), "/first_limit_point", both["cases"][0]["load_factor"].clone());
}

/// On joints that are 200 times softer the ring does not carry its weight: the limit point is a share of gravity, and no
/// load factor. Nothing else is believed.
#[test]
fn every_change_of_a_limit_point_of_gravity_is_found() {
    let soft = changed(&changed(RING, "2.15436e8", "1e6"), "1.82783e8", "1e6");
    let (study, original) = results(&soft);
    assert_eq!(findings(&study, &original), Vec::<String>::new());
    let case = &original["cases"][0];
    assert_eq!((case["status"].as_str(), &case["limit_points"][0]["gravity"]), (Some("limit_point"), &json!(true)));
    let share = number(&case["limit_points"][0]["factor"]);
    let found = |change: &dyn Fn(&mut Value), what: &str| {
        let mut forged = original.clone();
        change(&mut forged["cases"][0]);
        assert!(!findings(&study, &forged).is_empty(), "{what} was not found");
    };
    for key in ["load_factor", "first_limit_point"] {
        found(&|case| case[key] = json!(share), key);
    }
    for status in ["collapse", "no_equilibrium", "stands", "unbounded"] {
        found(&|case| case["status"] = json!(status), status);
    }
    found(&|case| case["continuation"] = Value::Null, "no continuation");
    found(&|case| case["limit_points"][0]["factor"] = json!(share * (1.0 + 1e-6)), "another share of gravity");
    found(&|case| case["limit_points"][0]["gravity"] = json!(false), "a factor of loads");
    found(&|case| case["limit_points"][0]["stage"] = json!("live"), "another stage");
    found(&|case| case["limit_points"] = json!([]), "no limit point");
}

#[test]
fn an_optimum_is_one_of_first_limit_points_if_displacements_are_finite() {
    let search = "kind = \"optimise\"\n[optimise]\nparameter = \"scene.width\"\nfrom = 1.0\nto = 1.1\nscan = 3\ntolerance = 0.9\n";
    let study = |more: &str| changed(RING, "name = \"ring\"\n", &format!("name = \"ring\"\n{search}{more}"));
    for (more, key) in [("", "first_limit_point"), ("result = \"load_factor\"\n", "load_factor")] {
        let found: Value = serde_json::from_str(&file(&run(&study(more)), "results.json")).expect("JSON");
        let optimum = &found["optima"][0];
        let cases = found["cases"].as_array().expect("cases");
        let own = cases.iter().find(|case| case["id"] == optimum["case"]).expect("its case");
        assert_eq!(optimum["result"], own[key], "{more}");
        assert_ne!(own["first_limit_point"], own["load_factor"]);
    }
}

/// A wide rigid block on a soft pad, pressed down: the load grows with the displacement and has no limit point.
const PAD: &str = r#"
name = "pad"
[scene]
scene = "blocks"
width = 1.0
material = "stone"
joint = "pad"
blocks = [
  { name = "ground", vertices = [[-2.0, -0.2], [2.0, -0.2], [2.0, 0.0], [-2.0, 0.0]], fixed = true },
  { name = "a", vertices = [[-2.0, 0.0], [2.0, 0.0], [2.0, 0.1], [-2.0, 0.1]] },
]
[materials.stone]
law = "rigid"
density = 2000.0
[joints.pad]
law = "coulomb"
friction = 0.6
normal_stiffness = 1e6
shear_stiffness = 1e6
[[stages]]
name = "dead"
gravity = 10.0
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", block = "a", point = [0.0, 0.1], force = [0.0, -1000.0] }]
[solver]
solver = "newton_path"
kinematics = "finite"
"#;

#[test]
fn a_load_without_a_limit_point_in_its_range_is_open_or_stands_at_factor_max() {
    let case = first_case(PAD);
    assert_eq!(case["status"], "open");
    let failures = case["certificate"]["failures"].to_string();
    assert!(failures.contains("no_limit_point_in_range") && failures.contains("the range is 0.300 m"), "{failures}");
    assert_eq!((&case["first_limit_point"], &case["limit_points"]), (&Value::Null, &Value::Null));
    // The load is proportional to the displacement: 4 MN/m.
    let [end, lower] = [number(&case["followed_to"]["displacement"]), number(&case["bounds"][0])];
    assert!((lower - 4000.0 * end).abs() < 0.01 * lower, "{lower} {end}");
    let bounded = changed(PAD, "until = \"collapse\"", "until = \"collapse\"\nfactor_max = 500.0");
    assert_eq!(first_case(&bounded)["status"], "stands");
}
