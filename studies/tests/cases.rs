//! The cases of a study file: shared keys, keys that depend on other keys, and the numbers of a case.

use serde_json::json;
use voussoir::study::{NumberKind, Study, load, meaning_in, numeric_keys, study_keys};

const ARCH: &str = include_str!("../src/commands/new/arch.toml");

fn study(text: &str) -> Study {
    load(text, "arch.toml", &[]).unwrap_or_else(|wrong| panic!("{wrong}"))
}

/// Each case is equal to the case of its own file, if cases change one key or all keys.
#[test]
fn cases_of_a_study_are_those_of_studies_of_one_case() {
    let own = |sets: &[(String, String)]| load(ARCH, "arch.toml", sets).unwrap_or_else(|wrong| panic!("{wrong}"));
    for (key, values) in [
        ("scene.profile.rise", ["1.5", "2.5"]),
        ("stages.0.gravity", ["9.81", "5.0"]),
        ("materials.stone.density", ["\"22 kN/m3\"", "2200.0"]),
        ("solver.tolerance", ["1e-9", "1e-6"]),
        ("output.fields", ["true", "false"]),
    ] {
        let swept = study(&format!("{ARCH}\n[sweep]\n\"{key}\" = {{ list = [{}] }}\n", values.join(", ")));
        for (case, value) in swept.cases.iter().zip(values) {
            let own = &own(&[(key.to_string(), value.to_string())]).cases[0];
            assert_eq!((&case.resolved, &case.notes), (&own.resolved, &own.notes), "{key} = {value}");
        }
    }
}

/// Specific weights use the gravity of their case, and names refer to the tables of their case.
#[test]
fn what_a_key_depends_on_is_looked_at_in_each_case() {
    let heavy = ARCH.replacen("density = 2200.0", "density = \"22 kN/m3\"", 1);
    assert_ne!(heavy, ARCH);
    let swept = study(&format!("{heavy}\n[sweep]\n\"stages.0.gravity\" = {{ list = [10.0, 5.0] }}\n"));
    let densities: Vec<_> = swept.cases.iter().map(|case| &case.resolved["materials"]["stone"]["density"]).collect();
    assert_eq!(densities, [&json!(2200.0), &json!(4400.0)]);
    let moved = swept.at(0, &[("stages.0.gravity".into(), json!(20.0))]).unwrap_or_else(|wrong| panic!("{wrong}"));
    assert_eq!(moved.resolved["materials"]["stone"]["density"], json!(1100.0));
    let other = "[[variants]]\nname = \"a\"\n[[variants]]\nname = \"b\"\n\
                 set = { \"joints.damp.law\" = \"coulomb_associated\", \"joints.damp.friction\" = 0.4, \"scene.joint\" = \"damp\" }\n";
    let joints = study(&format!("{ARCH}\n{other}"));
    assert_eq!(joints.cases[1].resolved["scene"]["joint"], "damp");
}

#[test]
fn every_number_of_an_arch_is_found_with_its_range_and_unit() {
    let study = study(ARCH);
    let keys = numeric_keys(study_keys(), &study.cases[0].resolved.to_json(), 12);
    let of = |key: &str| keys.iter().find(|own| own.key == key).unwrap_or_else(|| panic!("{key} in {keys:?}"));
    assert!(of("scene.profile.span").value.is_some() && of("scene.springing").value.is_none());
    assert!(matches!(of("scene.voussoirs").kind, NumberKind::Whole(..)));
    let unit = |key: &str| meaning_in(&study.cases[0].resolved, &of(key).key).and_then(|meaning| meaning.unit());
    assert_eq!(
        ["scene.profile.span", "scene.springing", "materials.stone.density", "stages.1.loads.0.force.1"].map(unit),
        [Some("m"), Some("deg"), Some("kg/m3"), Some("N")]
    );
    assert!(keys.iter().all(|key| !key.key.contains("solver") && key.value.is_none_or(f64::is_finite)));
}
