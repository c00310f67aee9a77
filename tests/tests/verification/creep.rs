//! Joints that creep and relax in stages with a duration, against closed forms.

use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir::study::load;
use voussoir::verify::verify;
use voussoir_tests::{answered, assert_close, changed, passes, study};

/// Stiffness of the joint \[Pa/m\], creep coefficient and weight per area of the block \[Pa\].
const STIFFNESS: f64 = 1e9;
const CREEP: f64 = 2.0;
const PRESSURE: f64 = 40e3;

/// A block of 1 m × 2 m on a joint with a retardation time of 100 days, under its weight.
const STANDING: &str = r#"name = "standing"
[scene]
scene = "blocks"
width = 0.5
material = "stone"
joint = "mortar"
blocks = [
  { name = "ground", vertices = [[0.0, -0.5], [1.0, -0.5], [1.0, 0.0], [0.0, 0.0]], fixed = true },
  { name = "a", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]] },
]
[materials.stone]
law = "rigid"
density = 2000.0
[joints.mortar]
law = "creeping_mortar"
friction = 0.6
normal_stiffness = "1 GPa/m"
shear_stiffness = "0.4 GPa/m"
creep_coefficient = 2.0
retardation_time = "100 d"
[[stages]]
name = "weight"
gravity = 10.0
[[stages]]
name = "wait"
duration = "150 d"
"#;

/// The same block under a support that moves down by 0.1 mm and stays there.
const HELD: &str = r#"name = "held"
[scene]
scene = "blocks"
width = 0.5
material = "stone"
joint = "mortar"
blocks = [
  { name = "ground", vertices = [[0.0, -0.5], [1.0, -0.5], [1.0, 0.0], [0.0, 0.0]], fixed = true },
  { name = "a", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 2.0], [0.0, 2.0]] },
  { name = "top", vertices = [[0.0, 2.0], [1.0, 2.0], [1.0, 2.5], [0.0, 2.5]], fixed = true },
]
[materials.stone]
law = "rigid"
density = 2000.0
[joints.mortar]
law = "creeping_mortar"
friction = 0.6
normal_stiffness = "1 GPa/m"
shear_stiffness = "0.4 GPa/m"
creep_coefficient = 2.0
retardation_time = "100 d"
[[stages]]
name = "press"
settlement = [{ support = "top", displacement = [0.0, "-0.1 mm"] }]
[[stages]]
name = "hold"
duration = "150 d"
"#;

/// Returns the vertical displacement of the block \[m\].
fn lowered(result: &CaseResult) -> f64 {
    let all = result.path.displacements.as_ref().expect("displacements");
    all.iter().find(|entry| entry.body == "a").expect("the block").displacement[1]
}

/// Returns the pressure of a joint of 0.5 m² \[Pa\].
fn pressure(result: &CaseResult, joint: usize) -> f64 {
    let field = result.proof.field.as_ref().expect("a field").iter();
    field.filter(|entry| entry.joint == joint).map(|entry| entry.force[0]).sum::<f64>() / 0.5
}

/// Solves a study that must stand, with a certificate that passes and that `verify` confirms.
fn confirmed(text: &str) -> CaseResult {
    let result = answered(text);
    assert_eq!(result.status, Status::Stands, "{:?}", result.notes);
    passes(&result);
    assert_eq!(result.path.end_is_checked, Some(true));
    let study = study(text);
    assert_eq!(verify(&study, &study.results("test", vec![result.clone()])), vec![]);
    result
}

/// Returns a study whose waiting stage has another duration and additional keys.
fn waiting(days: f64, more: &str) -> String {
    changed(STANDING, "duration = \"150 d\"", &format!("duration = \"{days} d\"\n{more}"))
}

/// Under a constant load u = −p/k (1 + φ (1 − e^(−t/τ))).
#[test]
fn a_constant_load_creeps() {
    for days in [1.0, 30.0, 150.0, 2000.0] {
        let exact = -PRESSURE / STIFFNESS * (1.0 + CREEP * (1.0 - (-days / 100.0_f64).exp()));
        assert_close(lowered(&confirmed(&waiting(days, ""))), exact, 2e-5);
    }
}

/// Under a constant load the outputs give the creep p/k φ (1 − e^(−t/τ)), which is the same everywhere.
#[test]
fn the_outputs_give_the_creep() {
    let result = confirmed(STANDING);
    let exact = PRESSURE / STIFFNESS * CREEP * (1.0 - (-1.5_f64).exp());
    for name in ["creep_closing", "mean_creep_closing", "greatest_creep_closing"] {
        let entry = result.outputs.iter().find(|entry| entry.name == name).expect("an output");
        assert!(!entry.values.is_empty() && entry.note().is_none());
        entry.values.iter().flatten().for_each(|value| assert_close(*value, exact, 5e-5));
    }
}

/// With finite displacements the same block creeps by the same amount.
#[test]
fn finite_displacements_give_the_same_creep() {
    let text = format!("{STANDING}[solver]\nkinematics = \"finite\"\n");
    assert_close(lowered(&confirmed(&text)), lowered(&confirmed(STANDING)), 1e-6);
}

/// Under a gap that is held, t = k g/(1 + φ) (1 + φ e^(−(1 + φ) t/τ)) in both joints.
#[test]
fn a_held_gap_relaxes() {
    let exact = STIFFNESS * 0.5e-4 / (1.0 + CREEP) * (1.0 + CREEP * (-(1.0 + CREEP) * 1.5_f64).exp());
    let result = confirmed(HELD);
    for joint in 0..2 {
        assert_close(pressure(&result, joint), exact, 1e-9);
    }
}

/// A load that grows in proportion to time creeps by p/k (x + φ (x − (1 − e^(−x)) / X)) with x = t/τ, X its end.
#[test]
fn a_load_that_grows_with_time_creeps_less() {
    let load = "loads = [{ kind = \"point\", block = \"a\", point = [0.5, 2.0], force = [0.0, \"-20 kN\"] }]";
    let weight = lowered(&confirmed(&waiting(150.0, "")));
    let both = lowered(&confirmed(&waiting(150.0, load)));
    let x = 1.5_f64;
    let exact = -PRESSURE / STIFFNESS * (1.0 + CREEP * (x - 1.0 + (-x).exp()) / x);
    assert_close(both - weight, exact, 5e-5);
}

/// Two stages of half the duration give the same creep as one: the time steps resolve the stage.
#[test]
fn two_halves_of_a_stage_creep_like_the_whole() {
    let halves = waiting(75.0, "[[stages]]\nname = \"wait on\"\nduration = \"75 d\"\n");
    assert_close(lowered(&confirmed(&halves)), lowered(&confirmed(STANDING)), 2e-5);
}

/// An eccentric load opens the joint. Stresses do not change in time, so all gaps grow by 1 + φ (1 − e^(−t/τ)).
#[test]
fn an_open_joint_creeps_on() {
    let push = "loads = [{ kind = \"point\", block = \"a\", point = [0.0, 1.0], force = [\"5 kN\", 0.0] }]";
    let loaded = changed(STANDING, "name = \"wait\"", &format!("name = \"push\"\n{push}\n[[stages]]\nname = \"wait\""));
    let turned = |result: &CaseResult| result.path.displacements.as_ref().expect("displacements")[1].displacement[2];
    let at_once = confirmed(&changed(&loaded, "[[stages]]\nname = \"wait\"\nduration = \"150 d\"\n", ""));
    let later = confirmed(&loaded);
    assert_close(pressure(&later, 0), PRESSURE, 1e-9);
    assert_close(turned(&later) / turned(&at_once), 1.0 + CREEP * (1.0 - (-1.5_f64).exp()), 2e-5);
}

/// Creep does not change the collapse load: friction is reached at 0.6 of the weight.
#[test]
fn creep_does_not_change_the_collapse_load() {
    let push = "[[stages]]\nname = \"push\"\nuntil = \"collapse\"\nloads = [{ kind = \"point\", block = \"a\", point = [0.0, 0.1], force = [\"1 kN\", 0.0] }]\n";
    let result = answered(&format!("{STANDING}{push}"));
    assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
    passes(&result);
    assert_close(result.load_factor.expect("a factor"), 12.0, 1e-8);
}

/// A forged duration of the last step is found.
#[test]
fn a_forged_time_step_is_found() {
    let study = study(STANDING);
    let mut result = answered(STANDING);
    result.path.joint_time_step = result.path.joint_time_step.map(|time_step| 1.5 * time_step);
    assert_ne!(verify(&study, &study.results("test", vec![result])), vec![]);
}

/// The event path refuses the law at its key. Wrong durations and fields are refused at theirs.
#[test]
fn wrong_input_is_refused_at_its_key() {
    let refused = |text: &str| load(text, "test.toml", &[]).expect_err("a mistake").to_string();
    let event = refused(&format!("{STANDING}[solver]\nsolver = \"event_path\"\n"));
    assert!(event.contains("test.toml:15:7: joints.mortar.law") && event.contains("\"creeping_mortar\""), "{event}");
    for (more, words) in [
        ("factor = 0.0", "stages.1.duration: time grows with the factor"),
        (
            "until = \"collapse\"\nloads = [{ kind = \"point\", block = \"a\", point = [0.0, 1.0], force = [1.0, 0.0] }]",
            "stages.1.duration: time grows to the factor of a stage",
        ),
        ("fields = { water_level = \"3 m\" }", "stages.1.fields.water_level: the first stage does not set"),
        ("fields = { temprature = 300.0 }", "stages.1.fields.temprature"),
    ] {
        let wrong = refused(&waiting(150.0, more));
        assert!(wrong.contains(words), "{words}: {wrong}");
    }
    let wrong = refused(&changed(STANDING, "\"150 d\"", "\"150 days\""));
    assert!(wrong.contains("units here: s, min, h, d, a"), "{wrong}");
}
