//! Optima and most onerous positions against fine scans, values of an independent program and closed forms, with the number of
//! evaluations.

use serde_json::{Value, json};
use voussoir_tests::{Arch, assert_close, changed, collapse_factor, crushing, friction};

/// Returns a study that optimises the inclination of the supports of the reference arch.
fn springing(arch: &Arch, table: &str) -> String {
    let head = "name = \"arch\"\nkind = \"optimise\"\n[optimise]\nparameter = \"scene.springing\"\n";
    changed(&arch.study(), "name = \"arch\"\n", &format!("{head}{table}"))
}

fn optima(text: &str) -> (Vec<Value>, usize) {
    let (study, results) = voussoir_tests::written::results(text);
    assert!(voussoir_tests::written::findings(&study, &results).is_empty());
    (results["optima"].as_array().expect("a list").clone(), results["cases"].as_array().expect("a list").len())
}

fn at(arch: &Arch, degrees: f64) -> f64 {
    collapse_factor(&changed(&arch.study(), "ends = ", &format!("springing = {degrees:?}\nends = ")))
}

/// With 10 MPa and a rise of 1.49 m the best of an independent linear program on whole half degrees is 1899.3 kN at
/// 82.5°; the optimum is not less, and its neighbours are lower.
#[test]
fn the_best_inclination_is_that_of_an_independent_program() {
    let arch = Arch { ends: "jointed", rise: 1.49, joint: crushing(0.6, 10e6), ..Arch::default() };
    let (optima, tried) = optima(&springing(&arch, "from = 40.0\nto = 90.0\nscan = 21\n"));
    let [optimum] = optima.as_slice() else { panic!("{optima:?}") };
    let (value, result) = (optimum["value"].as_f64().expect("a value"), optimum["result"].as_f64().expect("a result"));
    assert_close(at(&arch, 82.5), 1899.3, 3e-5);
    assert!(result >= at(&arch, 82.5) && (value - 82.5).abs() < 0.5, "{value} {result}");
    assert_close(at(&arch, value), result, 1e-11);
    for off in [-0.05, 0.05] {
        assert!(at(&arch, value + off) < result);
    }
    assert_eq!(optimum["best_finite"], json!({ "value": value, "result": result, "case": optimum["case"] }));
    assert!(tried < 80, "{tried}");
}

/// If some inclination carries any load, there is no optimum, and the best finite value is given too; the least load
/// over the same range is finite.
#[test]
fn an_unbounded_result_is_no_optimum() {
    let arch = Arch { ends: "jointed", rise: 0.89, ..Arch::default() };
    let most = springing(&arch, "from = 40.0\nto = 90.0\nscan = 11\ntolerance = 0.01\n");
    let (optima_of_most, _) = optima(&most);
    let optimum = &optima_of_most[0];
    assert_eq!(
        (&optimum["value"], &optimum["result"], &optimum["status"]),
        (&Value::Null, &Value::Null, &json!("unbounded"))
    );
    assert!(optimum["best_finite"]["result"].is_number());
    let statuses = optimum["intervals"].as_array().expect("a list").iter().map(|interval| interval["status"].clone());
    let statuses: Vec<Value> = statuses.collect();
    assert!(statuses.contains(&json!("unbounded")) && statuses.contains(&json!("collapse")), "{statuses:?}");
    let (least, _) = optima(&changed(&most, "tolerance", "goal = \"minimise\"\ntolerance"));
    assert!(least[0]["result"].as_f64() < optimum["best_finite"]["result"].as_f64());
}

/// Returns the study with a table for its kind before the scene.
fn searching(arch: &Arch, kind: &str, table: &str) -> String {
    changed(&arch.study(), "name = \"arch\"\n", &format!("name = \"arch\"\nkind = \"{kind}\"\n[{kind}]\n{table}"))
}

/// Returns the factors of all values of an even scan.
fn scan(text: &str, key: &str, [from, to]: [f64; 2], count: usize) -> Vec<f64> {
    let sweep = format!("{text}[sweep]\n\"{key}\" = {{ from = {from:?}, to = {to:?}, count = {count} }}\n");
    let study = voussoir_tests::study(&sweep);
    let kind = voussoir::kinds::kind("run").expect("a kind");
    let all: Vec<usize> = (0..study.count()).collect();
    let solved = kind.solve(&study, &all, 1, &voussoir::solve::Unobserved);
    solved.iter().filter_map(|case| case.load_factor).collect()
}

/// Five searches: the result is right to 1e-6 against a fine scan around it, with at most `most` evaluations.
#[test]
fn five_searches_are_right_to_a_millionth() {
    let ring = |rise: f64| Arch { ends: "bonded", rise, joint: friction(0.6), ..Arch::default() };
    let crushed = Arch { ends: "jointed", rise: 1.49, joint: crushing(0.6, 10e6), ..Arch::default() };
    let place = "stages.1.loads.0.span_fraction";
    type Problem = (&'static str, Arch, &'static str, &'static str, [f64; 2], bool, usize);
    let problems: [Problem; 5] = [
        ("position, rise 2.39 m", ring(2.39), "envelope", place, [0.03, 0.97], false, 80),
        ("position, rise 3.7 m", ring(3.7), "envelope", place, [0.05, 0.6], false, 80),
        ("inclination with crushing", crushed.clone(), "optimise", "scene.springing", [40.0, 90.0], true, 80),
        ("rise with crushing", crushed, "optimise", "scene.profile.rise", [0.5, 4.0], true, 80),
        ("least load over the rise", ring(2.0), "optimise", "scene.profile.rise", [1.6, 4.5], false, 80),
    ];
    for (name, arch, kind, key, [from, to], greatest, most) in problems {
        let goal = if kind == "optimise" && !greatest { "goal = \"minimise\"\n" } else { "" };
        let table = format!("parameter = \"{key}\"\nfrom = {from:?}\nto = {to:?}\n{goal}");
        let (_, results) = voussoir_tests::written::results(&searching(&arch, kind, &table));
        let found = &results[if kind == "optimise" { "optima" } else { "worsts" }][0];
        let (value, result) = (found["value"].as_f64().expect("a value"), found["result"].as_f64().expect("a result"));
        let near = (to - from) / 40.0;
        let around = [(value - near).max(from), (value + near).min(to)];
        let fine = scan(&arch.study(), key, around, 1001);
        let wide = scan(&arch.study(), key, [from, to], 1001);
        let all = fine.into_iter().chain(wide);
        let best = if greatest { all.fold(0.0, f64::max) } else { all.fold(f64::INFINITY, f64::min) };
        let tried = results["cases"].as_array().expect("cases").len();
        let better = if greatest { best / result - 1.0 } else { 1.0 - best / result };
        println!("{name}: {result} at {value} after {tried}; fine scans {best}, better by {better:e}");
        assert!(better <= 1e-6 && tried <= most, "{name}: {result} at {value}, {best}, {tried}");
    }
}

/// A sweep of the reference arch from 0.2095 to 0.2105 in 101 steps finds 836.6342 kN at a kink.
#[test]
fn the_most_onerous_position_is_a_kink() {
    let arch = Arch { ends: "bonded", rise: 2.39, joint: friction(0.6), ..Arch::default() };
    let table = "parameter = \"stages.1.loads.0.span_fraction\"\nfrom = 0.03\nto = 0.97\n";
    let (_, results) = voussoir_tests::written::results(&searching(&arch, "envelope", table));
    let worst = &results["worsts"][0];
    let (value, result) = (worst["value"].as_f64().expect("a value"), worst["result"].as_f64().expect("a result"));
    let fine = scan(&arch.study(), "stages.1.loads.0.span_fraction", [0.2095, 0.2105], 101);
    let least = fine.into_iter().fold(f64::INFINITY, f64::min);
    assert_close(least, 836.6342, 1e-6);
    assert!(result <= least && result > least * (1.0 - 1e-4) && (value - 0.21006).abs() < 1e-5, "{result} {value}");
}

/// A thin ring of one thickness that carries its own weight with a crushing strength: the catenary with cosh u = u sinh u, where u
/// is half the span over the radius of its crown, carries the greatest weight, 1.3255 σ/(ρ g L), for any thickness. Its rise is
/// 0.33766 L. The volume fixes the thickness. L is the span of the centreline, here of the intrados, so that 1 % remains.
#[test]
fn of_all_rings_with_a_volume_the_catenary_carries_most() {
    let text = CATENARY;
    let (study, results) = voussoir_tests::written::results(text);
    let optimum = &results["optima"][0];
    let values = optimum["values"].as_object().expect("values");
    let (rise, thickness) = (values["scene.profile.rise"].as_f64(), values["scene.thickness"].as_f64());
    let (rise, thickness) = (rise.expect("a rise"), thickness.expect("a thickness"));
    let result = optimum["result"].as_f64().expect("a result");
    assert_close(result, 1.325_487 * 10e6 / (2000.0 * 9.81 * 10.0), 0.01);
    assert!((rise / 10.0 - 0.33766).abs() < 2e-3, "{rise}");
    // V = t L sinh u / u.
    assert_close(thickness, 1.3 * 1.199_679 / (10.0 * 1.508_879), 0.01);
    let tried = results["cases"].as_array().expect("cases").len();
    assert!(tried <= 100, "{tried}");
    // The optimum over the rise alone, at this thickness, is the same: the load does not depend on the thickness.
    let alone = changed(text, "thickness = 0.1\n", &format!("thickness = {thickness:?}\n"));
    let alone = changed(&alone, PARAMETERS, "parameter = \"scene.profile.rise\"\nfrom = 3.0\nto = 3.8\n");
    let (_, alone) = voussoir_tests::written::results(&alone);
    let along = alone["optima"][0]["result"].as_f64().expect("a result");
    println!("{result} at {rise}, {thickness} after {tried}; {along} at {}", alone["optima"][0]["value"]);
    assert_close(result, along, 1e-4);
    for at in
        ["/optima/0/result", "/optima/0/value", "/optima/0/values/scene.profile.rise", "/optima/0/best_finite/result"]
    {
        forged_is_found(&study, &results, at);
    }
}

const PARAMETERS: &str = "parameters = [{ key = \"scene.profile.rise\", from = 1.5, to = 5.0 }, { key = \"scene.thickness\", from = 0.05, to = 0.2 }]\nvolume = 1.3\n";

const CATENARY: &str = r#"
name = "ring"
kind = "optimise"
[optimise]
parameters = [{ key = "scene.profile.rise", from = 1.5, to = 5.0 }, { key = "scene.thickness", from = 0.05, to = 0.2 }]
volume = 1.3
[scene]
scene = "arch"
profile = { shape = "catenary", span = 10.0, rise = 3.0 }
thickness = 0.1
width = 1.0
voussoirs = 40
ends = "jointed"
material = "stone"
joint = "dry"
[materials.stone]
law = "rigid"
density = 2000.0
[joints.dry]
law = "mohr_coulomb"
friction = 0.6
compressive_strength = "10 MPa"
[[stages]]
name = "own weight"
until = "collapse"
gravity = 0.0
loads = [{ kind = "body", acceleration = [0.0, -9.81] }]
"#;

/// Changes a number of results by 1e-6 of it and expects a finding of `verify`.
fn forged_is_found(study: &voussoir::study::Study, results: &Value, at: &str) {
    let mut forged = results.clone();
    let number = forged.pointer_mut(at).unwrap_or_else(|| panic!("{at} exists"));
    *number = json!(number.as_f64().expect("a number") * (1.0 + 1e-6));
    assert!(!voussoir_tests::written::findings(study, &forged).is_empty(), "{at}");
}

/// Each changed number of an optimum is found, and another trial cannot replace it.
#[test]
fn a_forged_optimum_is_found() {
    let arch = Arch { ends: "jointed", rise: 1.49, joint: crushing(0.6, 10e6), ..Arch::default() };
    let (study, results) = voussoir_tests::written::results(&springing(&arch, "from = 70.0\nto = 90.0\nscan = 5\n"));
    assert!(voussoir_tests::written::findings(&study, &results).is_empty());
    for at in
        ["value", "result", "bracket/0", "possible_gain", "best_finite/result", "best_finite/value", "scan_spacing"]
    {
        forged_is_found(&study, &results, &format!("/optima/0/{at}"));
    }
    let mut forged = results.clone();
    let other = results["curve"][0].clone();
    for key in ["value", "result", "case"] {
        forged["optima"][0][key] = other[key].clone();
        forged["optima"][0]["best_finite"][key] = other[key].clone();
    }
    assert!(!voussoir_tests::written::findings(&study, &forged).is_empty());
    for (key, word) in [("goal", "minimise"), ("optimised", "first_limit_point"), ("status", "unbounded")] {
        let mut forged = results.clone();
        forged["optima"][0][key] = json!(word);
        assert!(!voussoir_tests::written::findings(&study, &forged).is_empty(), "{key}");
    }
}

/// Milankovitch (1907): a semicircular ring of joints that neither slide nor crush carries its own weight from a thickness of
/// 0.10748 of its centreline radius. The border between no equilibrium and equilibrium is found; 200 joints change it by 1e-4.
#[test]
fn the_least_thickness_is_that_of_milankovitch() {
    let text = r#"
name = "ring"
kind = "optimise"
[optimise]
parameters = [{ key = "scene.thickness", from = 1.0, to = 1.2 }]
goal = "minimise"
scan = 5
tolerance = 1e-7
[scene]
scene = "arch"
profile = { shape = "segmental", span = 18.926, rise = 9.463 }
thickness = 1.074
width = 1.0
voussoirs = 200
ends = "jointed"
material = "stone"
joint = "dry"
[materials.stone]
law = "rigid"
density = 2400.0
[joints.dry]
law = "unilateral"
tangential = "stuck"
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "body", acceleration = [1.0, 0.0] }]
"#;
    let (optima, tried) = optima(text);
    let optimum = &optima[0];
    assert_eq!((&optimum["value"], &optimum["status"]), (&Value::Null, &json!("no_equilibrium")));
    let intervals = optimum["intervals"].as_array().expect("a list");
    let [below, above] = intervals.as_slice() else { panic!("{intervals:?}") };
    let (low, high) = (below["to"].as_f64().expect("a number"), above["from"].as_f64().expect("a number"));
    // t = k (R + t/2)
    let (k, radius) = (0.107_48, 9.463);
    println!("{low} {high} after {tried}, closed form {}", k * radius / (1.0 - k / 2.0));
    assert!(high - low <= 0.2e-7);
    assert_close(high, k * radius / (1.0 - k / 2.0), 2e-4);
    assert_close(optimum["best_finite"]["value"].as_f64().expect("a value"), high, 1e-12);
    assert!(tried <= 60, "{tried}");
}

/// The least load over the rise and the position of the load, at the end of the range of the rise and at a kink over the position,
/// is the most onerous position at this rise. Friction is not associated, so derivatives are differences.
#[test]
fn a_kink_at_the_end_of_a_range_is_found() {
    let arch = |rise: f64| Arch { ends: "bonded", rise, joint: friction(0.6), ..Arch::default() };
    let place = "stages.1.loads.0.span_fraction";
    let tables = format!(
        "parameters = [{{ key = \"scene.profile.rise\", from = 1.5, to = 4.5 }}, {{ key = \"{place}\", from = 0.05, to = 0.45 }}]\ngoal = \"minimise\"\n"
    );
    let (_, both) = voussoir_tests::written::results(&searching(&arch(2.39), "optimise", &tables));
    let table = format!("parameter = \"{place}\"\nfrom = 0.05\nto = 0.45\n");
    let (_, single) = voussoir_tests::written::results(&searching(&arch(4.5), "envelope", &table));
    let (found, least) = (&both["optima"][0], &single["worsts"][0]["result"]);
    let tried = both["cases"].as_array().expect("cases").len();
    println!("{} after {tried}, {least}", found["result"]);
    assert_eq!(found["values"]["scene.profile.rise"], json!(4.5));
    assert_close(found["result"].as_f64().expect("a result"), least.as_f64().expect("a result"), 1e-6);
    assert!(tried <= 160, "{tried}");
}
