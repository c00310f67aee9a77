//! Voussoir as a library: studies from values or built step by step, mistakes as errors, runs that are observed and
//! cancelled.

use std::error::Error;
use std::sync::Mutex;
use voussoir::prelude::*;

fn block() -> StudyBuilder {
    Study::builder("block")
        .scene(
            "wall",
            json!({ "width": 1.0, "brick": [0.4, 0.2], "courses": 1, "bricks": 1, "material": "stone", "joint": "dry" }),
        )
        .material("stone", "rigid", json!({ "density": 2000.0 }))
        .joint("dry", "coulomb", json!({ "friction": 0.4 }))
        .gravity(9.81)
        .until_collapse("push", json!([{ "kind": "body", "acceleration": [9.81, 0.0] }]))
}

/// A study from a value, from TOML and built step by step is the same study: the same resolved cases, the same results.
#[test]
fn a_value_and_a_text_are_one_study() -> Result<(), StudyError> {
    let text = r#"
        name = "block"
        [scene]
        scene = "wall"
        width = 1.0
        brick = [0.4, 0.2]
        courses = 1
        bricks = 1
        material = "stone"
        joint = "dry"
        [materials.stone]
        law = "rigid"
        density = 2000.0
        [joints.dry]
        law = "coulomb"
        friction = 0.4
        [[stages]]
        name = "dead"
        gravity = 9.81
        [[stages]]
        name = "push"
        until = "collapse"
        loads = [{ kind = "body", acceleration = [9.81, 0.0] }]
    "#;
    let value: serde_json::Value = toml::from_str(text).expect("TOML");
    let studies = [Study::from_toml(text)?, Study::from_value(&value)?, block().build()?];
    for study in &studies {
        assert_eq!(study.cases[0].resolved, studies[0].cases[0].resolved);
        let results = study.run();
        assert!((results.case(0).and_then(|case| case.load_factor).expect("a factor") - 0.4).abs() < 1e-9);
        assert!(results.certified() && results.case(1).is_none());
    }
    Ok(())
}

/// All mistakes are reported at once, each with its key; no key is ignored silently.
#[test]
fn mistakes_are_errors_with_their_keys() {
    let wrong = block()
        .joint("dry", "coulom", json!({ "friction": 0.4 }))
        .set("scene.widht", 2.0)
        .set("stages.push.factor", "many")
        .build()
        .expect_err("three mistakes");
    let keys: Vec<&str> = wrong.mistakes().iter().map(|mistake| mistake.key.as_str()).collect();
    assert!(keys.contains(&"joints.dry.law") && keys.contains(&"scene.widht"), "{wrong}");
    assert!(wrong.to_string().contains("study: joints.dry.law: there is no interface law \"coulom\""), "{wrong}");
    assert!(wrong.to_string().contains("did you mean \"coulomb\"?") && wrong.source().is_some());
    let null = Study::from_value(&json!({ "name": "x", "scene": { "scene": null } })).expect_err("null");
    assert!(null.to_string().contains("study: scene.scene: is null"), "{null}");
    let table = block().material("stone", "rigid", json!(3.0)).build().expect_err("no table");
    assert!(table.to_string().contains("materials.stone"), "{table}");
    let file = Study::from_file("no/such.toml").expect_err("no file");
    assert!(file.to_string().contains("no/such.toml") && file.source().is_some() && file.mistakes().is_empty());
}

/// A path is observed state by state and cancelled in the middle. The cancelled case has no result, the case before it
/// keeps its result, and unknown ids are ignored.
#[test]
fn a_run_is_watched_and_cancelled() -> Result<(), StudyError> {
    let study = Study::builder("arch")
        .scene(
            "arch",
            json!({ "profile": { "shape": "segmental", "span": 9.42, "rise": 2.99 }, "thickness": 0.6, "width": 5.81,
                    "voussoirs": 9, "ends": "bonded", "material": "stone", "joint": "dry", "mesh": { "elements": [1, 2] } }),
        )
        .material("stone", "elastic", json!({ "young_modulus": "5 GPa", "poisson_ratio": 0.3, "density": 2200.0 }))
        .joint("dry", "coulomb_associated", json!({ "friction": 0.6 }))
        .gravity(9.81)
        .until_collapse("live", json!([{ "kind": "point", "span_fraction": 0.25, "force": [0.0, -1000.0] }]))
        .sweep("scene.thickness", &[0.6, 0.65])
        .build()?;
    let factors = Mutex::new(Vec::new());
    let watch = Watch::new(|event| match event {
        RunEvent::State(at) if at.case == 1 => {
            factors.lock().expect("no panic").push(at.factor);
            assert!(!at.problem.load_steps.is_empty() && at.state.factor == at.factor);
            at.states < 5
        }
        _ => true,
    });
    let results = study.run_with(&RunOptions { cases: Some(&[1, 0, 7]), observer: &watch, ..RunOptions::default() });
    assert_eq!(results.cases.iter().map(|case| case.label.id).collect::<Vec<_>>(), [0]);
    assert_eq!((results.only_cases.as_deref(), watch.cancelled()), (Some(&[0][..]), true));
    assert_eq!(factors.lock().expect("no panic").len(), 5);
    let whole = study.run_with(&RunOptions { jobs: 2, ..RunOptions::default() });
    assert_eq!(whole.cases.len(), 2);
    assert_eq!(whole.case(0).map(|case| case.load_factor), results.case(0).map(|case| case.load_factor));
    Ok(())
}
