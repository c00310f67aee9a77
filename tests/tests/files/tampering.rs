//! `verify` reads only results.json and resolved.toml and finds every number that was changed.

use serde_json::{Value, json};
use voussoir::verify::verify;
use voussoir_tests::written::{findings, results};
use voussoir_tests::{Arch, changed, crushing, friction};

/// Changes every number below `value` in turn, relatively by `by`, and calls `check` with its path.
fn each_number(value: &Value, by: f64, path: &str, check: &mut dyn FnMut(&str, f64)) {
    match value {
        Value::Number(number) if number.is_f64() => {
            let x = number.as_f64().expect("a float");
            let changed = if x == 0.0 { by } else { x * (1.0 + by) };
            check(path, changed);
        }
        Value::Array(items) => {
            items.iter().enumerate().for_each(|(i, item)| each_number(item, by, &format!("{path}/{i}"), check));
        }
        Value::Object(map) => map.iter().for_each(|(key, item)| each_number(item, by, &format!("{path}/{key}"), check)),
        _ => {}
    }
}

/// Returns the greatest force or velocity in a list of entries.
fn greatest(list: &Value) -> f64 {
    let entries = list.as_array().into_iter().flatten();
    let vectors = entries.filter_map(|entry| entry.get("force").or(entry.get("velocity"))?.as_array());
    vectors.flatten().filter_map(Value::as_f64).fold(0.0, |m, x| m.max(x.abs()))
}

/// Unchanged results are confirmed; every changed factor, bound, force, velocity, hinge and point is found.
#[test]
fn every_changed_number_is_found() {
    let unbounded = Arch { rise: 1.19, ..Arch::default() };
    let weak = Arch { joint: friction(0.01), ends: "jointed", ..Arch::default() };
    let thin = Arch { thickness: 0.12, ends: "jointed", ..Arch::default() };
    let cases = [
        Arch::default(),
        Arch { joint: friction(0.3), ..Arch::default() },
        Arch { joint: crushing(0.6, 10e6), ..Arch::default() },
        unbounded,
        weak,
        thin,
    ];
    for arch in cases {
        let (study, original) = results(&arch.study());
        let text = serde_json::to_string(&original).expect("JSON");
        let read = serde_json::from_str(&text).expect("results");
        assert_eq!(verify(&study, &read), vec![]);
        let mut tried = 0;
        each_number(&original["cases"][0], 1e-6, "/cases/0", &mut |path, value| {
            // The cost is not a claim about the structure.
            if path.contains("/seconds") || path.contains("/counters") {
                return;
            }
            let mut changed = original.clone();
            *changed.pointer_mut(path).expect("the path exists") = json!(value);
            // Forces and velocities are checked relative to the greatest of the scene: a change by a millionth of a
            // value that is a thousand times smaller is within the tolerance of 1e-10.
            let slot = original.pointer(path).and_then(Value::as_f64).expect("a float");
            let list =
                ["field", "ray", "motion"].into_iter().find(|list| path.starts_with(&format!("/cases/0/{list}/")));
            let tiny = list.is_some_and(|list| slot.abs() < 1e-3 * greatest(&original["cases"][0][list]));
            let small = path.contains("/residuals/") || tiny;
            if !small {
                tried += 1;
                assert!(!findings(&study, &changed).is_empty(), "{path} was changed from {slot} and not found");
            }
        });
        assert!(tried > 20, "only {tried} numbers were tried");
    }
}

/// A changed status, kind, count or verdict is found.
#[test]
fn every_changed_word_is_found() {
    let (study, original) = results(&Arch::default().study());
    for (path, value) in [
        ("/study", json!("another")),
        ("/cases/0/status", json!("unbounded")),
        ("/cases/0/status", json!("stands")),
        ("/cases/0/status", json!("no_equilibrium")),
        ("/cases/0/mechanism/kind", json!("five_hinge")),
        ("/cases/0/mechanism/hinge_count", json!(5)),
        ("/cases/0/mechanism/hinges/0/side", json!("extrados")),
        ("/cases/0/mechanism/hinges/0/joint", json!(2)),
        ("/cases/0/mechanism/hinges", json!([])),
        ("/cases/0/mechanism", json!(null)),
        ("/cases/0/motion", json!(null)),
        ("/cases/0/field", json!(null)),
        ("/cases/0/field/0/joint", json!(9999)),
        ("/cases/0/load_factor", json!(null)),
        ("/cases/0/load_factor", json!(700.0)),
        ("/cases/0/flow_read_as", json!("associated")),
        ("/cases/0/stages/1/status", json!("stands")),
        ("/cases/0/stages/0/status", json!("collapse")),
        ("/cases/0/certificate/passed", json!(false)),
        ("/cases/0/id", json!(7)),
        ("/cases/0/variant", json!("none")),
    ] {
        let mut changed = original.clone();
        *changed.pointer_mut(path).unwrap_or_else(|| panic!("{path}")) = value;
        assert!(!findings(&study, &changed).is_empty(), "{path} was changed and not found");
    }
}

/// Returns a study with finite displacements: an arch whose right support has moved out, with rigid blocks on compliant
/// joints or with elastic blocks.
fn spread(material: &str, joint: &str) -> String {
    format!(
        r#"name = "spread"
[scene]
scene = "arch"
profile = {{ shape = "segmental", span = 4.0, rise = 1.0 }}
thickness = 0.5
width = 1.0
voussoirs = 7
ends = "jointed"
material = "stone"
joint = "dry"
[scene.mesh]
elements = [1, 2]
[materials.stone]
{material}
density = 2000.0
[joints.dry]
law = "coulomb"
friction = 0.7
{joint}
[solver]
solver = "newton_path"
kinematics = "finite"
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "spread"
settlement = [{{ support = "right", displacement = [0.05, -0.01], rotation = 0.002 }}]
[[stages]]
name = "live"
loads = [{{ kind = "point", span_fraction = 0.4, force = [0.0, -100.0] }}]
"#
    )
}

/// Equilibrium and gaps of a state with finite displacements are those of its displaced position: every changed force,
/// displacement and factor is found, and the state is refused as one of small displacements.
#[test]
fn every_changed_number_of_finite_displacements_is_found() {
    for (material, joint) in [
        ("law = \"rigid\"", "normal_stiffness = 1e9\nshear_stiffness = 1e9"),
        ("law = \"elastic\"\nyoung_modulus = 2e9\npoisson_ratio = 0.2", ""),
    ] {
        let text = spread(material, joint);
        let (study, original) = results(&text);
        let case = &original["cases"][0];
        assert_eq!(case["status"], json!("stands"), "{:?}", case["notes"]);
        let residual = case["certificate"]["residuals"]["path_equilibrium"].as_f64().expect("a residual");
        assert!(residual < 1e-10, "{residual}");
        let text = serde_json::to_string(&original).expect("JSON");
        assert_eq!(verify(&study, &serde_json::from_str(&text).expect("results")), vec![]);
        let (small, _) =
            results(&changed(&spread(material, joint), "kinematics = \"finite\"", "kinematics = \"small\""));
        assert!(!findings(&small, &original).is_empty(), "small displacements were confirmed");
        let mut tried = 0;
        for part in ["field", "displacements", "field_factor"] {
            each_number(&case[part], 1e-5, &format!("/cases/0/{part}"), &mut |path, value| {
                if path.contains("/point/") || path.contains("/between/") {
                    return;
                }
                let slot = original.pointer(path).and_then(Value::as_f64).expect("a float");
                let greatest = if part == "field" { greatest(&case["field"]) } else { 0.05 };
                if slot.abs() < 1e-2 * greatest {
                    return;
                }
                let mut changed = original.clone();
                *changed.pointer_mut(path).expect("the path exists") = json!(value);
                tried += 1;
                assert!(!findings(&study, &changed).is_empty(), "{path} was changed from {slot} and not found");
            });
        }
        assert!(tried > 30, "only {tried} numbers were tried");
    }
}
