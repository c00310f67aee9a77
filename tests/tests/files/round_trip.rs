//! A study and its `resolved.toml` have the same cases.

use voussoir::study::{Study, load};

const TEXT: &str = r#"
name = "round trip"
[scene]
scene = "arch"
profile = { shape = "segmental", span = "9.42 m", rise = 2.99 }
thickness = "600 mm"
width = 5.81
voussoirs = 15
ends = "jointed"
material = "stone"
joint = "dry"
[materials.stone]
law = "rigid"
density = "22 kN/m3"
[joints.dry]
law = "coulomb"
friction = 0.6
cohesion = 1000.0
normal_stiffness = "1 GPa/m"
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "live"
until = "collapse"
loads = [{ kind = "point", span_fraction = 0.25, force = [0.0, "-1 kN"] }]
[solver]
stop = { displacement = 0.05 }
[sweep]
"scene.profile.rise" = { from = 3.59, to = 2.39, step = -0.30 }
[sweep.zip]
"scene.thickness" = { list = ["500 mm", 0.6] }
"joints.dry.friction" = { list = [0.5, 0.7] }
[[variants]]
name = "as is"
[[variants]]
name = "strengths"
set = { "joints.dry.law" = "mohr_coulomb" }
[[variants]]
name = "moon"
set = { "stages.dead.gravity" = 1.62 }
"#;

fn read(text: &str, sets: &[(&str, &str)]) -> Study {
    let sets: Vec<_> = sets.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    load(text, "a.toml", &sets).unwrap_or_else(|wrong| panic!("{wrong}"))
}

#[test]
fn the_resolved_study_makes_the_same_cases() {
    let study = read(TEXT, &[("stages.live.loads.0.span_fraction", "0.3"), ("joints.dry.law", "coulomb_associated")]);
    assert_eq!(study.cases.len(), 3 * 5 * 2);
    let again = read(&toml::to_string(&study.resolved).unwrap(), &[]);
    assert_eq!(again.cases.len(), study.cases.len());
    for (case, again) in study.cases.iter().zip(&again.cases) {
        assert_eq!(format!("{case:?}"), format!("{again:?}"));
    }
    assert_eq!(again.resolved, study.resolved);
}

#[test]
fn a_specific_weight_weighs_what_it_says_and_a_swept_value_is_the_rounded_one() {
    let study = read(TEXT, &[]);
    for case in &study.cases {
        let gravity = case.stages[0].gravity.unwrap().norm();
        let density = case.assembly.catalogue.materials[0].1.density();
        assert!((density * gravity - 22e3).abs() < 1e-9);
    }
    assert_eq!(study.cases[4].parameters["scene.profile.rise"].as_f64(), Some(2.99));
    assert_eq!(study.cases[4].assembly.arch.as_ref().unwrap().rise, 2.99);
    assert_eq!(study.cases[0].stages[1].forces[0].force.y, -1000.0);
}

#[test]
fn keys_without_influence_are_noted() {
    // A compliant joint needs a path; here limit analysis is chosen by name.
    let study = read(TEXT, &[("solver.solver", "limit_chain")]);
    assert_eq!(
        study.cases[0].notes,
        [
            "joints.dry.cohesion is not used by interface law \"coulomb\"",
            "joints.dry.normal_stiffness has no influence on a limit load",
            "solver.stop is not used by limit analysis",
        ]
    );
    let strengths = study.cases.iter().find(|case| case.variant.as_deref() == Some("strengths")).unwrap();
    assert!(strengths.notes.iter().all(|note| !note.contains("cohesion")));
    assert_eq!(strengths.resolved["joints"]["dry"]["cohesion"], 1000.0);
}

#[test]
fn the_order_of_axes_survives_the_round_trip() {
    let head = TEXT.split("[sweep]").next().unwrap();
    let axes = r#"
[sweep]
"scene.width" = { list = [1.0, 2.0] }
zip = { "scene.thickness" = { list = [0.5, 0.6] }, "joints.dry.friction" = { list = [0.5, 0.7] } }
"scene.profile.rise" = { from = 2.0, to = 3.0, count = 2 }
"#;
    let study = read(&format!("{head}{axes}"), &[]);
    let order = |study: &Study| study.cases.iter().map(|case| format!("{:?}", case.parameters)).collect::<Vec<_>>();
    assert_eq!(study.cases[1].parameters["scene.width"].as_f64(), Some(1.0));
    assert_eq!(study.cases[1].parameters["scene.profile.rise"].as_f64(), Some(3.0));
    let again = read(&toml::to_string(&study.resolved).unwrap(), &[]);
    assert_eq!(order(&study), order(&again));
}
