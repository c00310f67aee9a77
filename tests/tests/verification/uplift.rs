//! Uplift in an open joint: a dam monolith on its base, against the equilibrium of its closed part.

use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir::verify::verify;
use voussoir_tests::{Arch, answered, assert_close, changed, passes, study};

/// Base B, height of the dam, weight per length W, level h, and specific weight of water.
const BASE: f64 = 4.0;
const WEIGHT: f64 = 2400.0 * 10.0 * BASE * 6.0;
const LEVEL: f64 = 6.0;
const WATER: f64 = 10e3;

/// A block of 4 m × 6 m × 1 m. The water rises to 6 m with its thrust γ h²/2 at h/3, and the joint is fine.
const DAM: &str = r#"name = "dam"
[scene]
scene = "blocks"
width = 1.0
material = "concrete"
joint = "base"
blocks = [
  { name = "rock", vertices = [[-1.0, -1.0], [5.0, -1.0], [5.0, 0.0], [-1.0, 0.0]], fixed = true },
  { name = "dam", vertices = [[0.0, 0.0], [4.0, 0.0], [4.0, 6.0], [0.0, 6.0]] },
]
[scene.mesh]
elements = [1, 200]
order = 2
[materials.concrete]
law = "rigid"
density = 2400.0
[joints.base]
law = "uplift_joint"
friction = 0.9
normal_stiffness = "10 GPa/m"
shear_stiffness = "4 GPa/m"
water_weight = "10 kPa/m"
[[stages]]
name = "weight"
gravity = 10.0
fields = { water_level = "0 m" }
[[stages]]
name = "water"
fields = { water_level = "6 m" }
loads = [{ kind = "point", block = "dam", point = [0.0, 2.0], force = ["180 kN", 0.0] }]
"#;

/// Solves a study that must stand, with a certificate that passes and that `verify` confirms.
fn confirmed(text: &str) -> CaseResult {
    let result = answered(text);
    assert_eq!(result.status, Status::Stands, "{:?}", result.notes);
    passes(&result);
    let study = study(text);
    assert_eq!(verify(&study, &study.results("test", vec![result.clone()])), vec![]);
    result
}

/// Returns the normal force of the joint \[N\].
fn force(result: &CaseResult) -> f64 {
    result.proof.field.as_ref().expect("a field").iter().map(|entry| entry.force[0]).sum()
}

/// Returns the rotation of the dam.
fn rotation(result: &CaseResult) -> f64 {
    let all = result.path.displacements.as_ref().expect("displacements");
    all.iter().find(|entry| entry.body == "dam").expect("the dam").displacement[2]
}

/// Returns the length of the closed part and the rotation, from equilibrium with the pressure p in the crack: a triangle
/// of effective pressure on c carries W − p B, so c = 3 ((W − p B) B/2 − H a)/(W − p B) and θ = 2 (W − p B)/(k c²).
fn by_hand(pressure: f64) -> (f64, f64) {
    let (thrust, arm) = (0.5 * WATER * LEVEL * LEVEL, LEVEL / 3.0);
    let effective = WEIGHT - pressure * BASE;
    let closed = 3.0 * (0.5 * effective * BASE - thrust * arm) / effective;
    (closed, 2.0 * effective / (10e9 * closed * closed))
}

/// Returns the length of the closed part of the base \[m\]: of the points with more pressure than water has, by their
/// areas.
fn closed(result: &CaseResult) -> f64 {
    let field = result.proof.field.as_ref().expect("a field");
    let open = field.iter().filter(|entry| entry.point[0] < 2.0).count();
    assert!(open > 0);
    // Forces of points of one rule: the middle of an element represents 2/3 of it, and the pressure there is the mean.
    let length = BASE / 200.0;
    let pressures = field.iter().filter(|entry| ((entry.point[0] / length).fract() - 0.5).abs() < 1e-6);
    pressures.filter(|entry| entry.force[0] / (2.0 / 3.0 * length) > WATER * LEVEL * (1.0 + 1e-9)).count() as f64
        * length
}

/// The crack opens to the length of the closed form, and the dam rotates by its angle.
#[test]
fn the_base_opens_to_the_length_of_the_closed_form() {
    let result = confirmed(DAM);
    let (length, angle) = by_hand(WATER * LEVEL);
    assert!(length < BASE, "the base must open: {length}");
    assert_close(force(&result), WEIGHT, 1e-9);
    assert_close(-rotation(&result), angle, 1e-4);
    assert!((closed(&result) - length).abs() < 1.5 * BASE / 200.0, "{} instead of {length}", closed(&result));
}

/// Returns the values of an output.
fn output(result: &CaseResult, name: &str) -> Vec<f64> {
    let entry = result.outputs.iter().find(|entry| entry.name == name).expect("an output");
    entry.values.iter().map(|value| value.expect("a number")).collect()
}

/// The outputs of the law give the length of the crack and the force of the water in it.
#[test]
fn the_outputs_give_the_crack_and_its_water() {
    let result = confirmed(DAM);
    let (closed, _) = by_hand(WATER * LEVEL);
    let (crack, water) = (BASE - closed, WATER * LEVEL);
    let spacing = BASE / 200.0;
    let [length] = output(&result, "crack_length")[..] else { panic!("one joint") };
    assert!((length - crack).abs() < spacing, "{length} instead of {crack}");
    assert_eq!(output(&result, "total_crack_length"), [length]);
    let [force] = output(&result, "water_force")[..] else { panic!("one joint") };
    assert_close(force, water * length, 1e-9);
    let pressures = output(&result, "water_pressure");
    assert_eq!(pressures.len(), result.proof.field.as_ref().expect("a field").len());
    assert!(pressures.iter().all(|own| *own == 0.0 || (own - water).abs() < 1e-6 * water));
}

/// The outputs follow from the stored state: a changed value is found.
#[test]
fn a_changed_output_is_found() {
    let (study, result) = (study(DAM), confirmed(DAM));
    let findings = |change: &dyn Fn(&mut CaseResult)| {
        let mut changed = result.clone();
        change(&mut changed);
        let found = verify(&study, &study.results("test", vec![changed]));
        found.first().map(|(_, why)| why.clone()).unwrap_or_default()
    };
    let length = result.outputs.iter().position(|entry| entry.name == "crack_length").expect("an output");
    let longer = findings(&|result| result.outputs[length].values[0] = Some(9.0));
    assert!(
        longer.starts_with("output \"crack_length\" of uplift_joint, value 0 is 9.0, but the stored state gives"),
        "{longer}"
    );
    let gone = findings(&|result| drop(result.outputs.remove(length)));
    assert!(gone.starts_with("the list of names in outputs is"), "{gone}");
    let elsewhere = findings(&|result| result.outputs[length].places[0] = 7);
    assert_eq!(elsewhere, "output \"crack_length\": a place is not in the scene");
}

/// Without the field no water enters: the same thrust opens the base less.
#[test]
fn a_dry_base_opens_less() {
    let dry =
        changed(&changed(DAM, "fields = { water_level = \"0 m\" }", ""), "fields = { water_level = \"6 m\" }", "");
    let (length, angle) = by_hand(0.0);
    let result = confirmed(&dry);
    if length >= BASE {
        // Closed everywhere: θ = 12 M/(k B³).
        let moment = 0.5 * WATER * LEVEL * LEVEL * LEVEL / 3.0;
        assert_close(-rotation(&result), 12.0 * moment / (10e9 * BASE.powi(3)), 1e-6);
    } else {
        assert_close(-rotation(&result), angle, 1e-4);
    }
}

/// The thrust at which the dam slides is μ (W − p B): friction acts on the effective pressure.
#[test]
fn the_dam_slides_at_the_friction_of_the_effective_weight() {
    let push = "[[stages]]\nname = \"push\"\nuntil = \"collapse\"\nloads = [{ kind = \"point\", block = \"dam\", point = [0.0, 0.05], force = [\"1 kN\", 0.0] }]\n";
    let low = changed(DAM, "friction = 0.9", "friction = 0.7");
    let result = answered(&format!("{low}{push}"));
    assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
    passes(&result);
    let limit = 0.7 * (WEIGHT - WATER * LEVEL * BASE) - 180e3;
    assert_close(result.load_factor.expect("a factor"), limit / 1e3, 1e-6);
}

/// Without water the law is that of `coulomb` with the same springs: arches carry the same loads, even if the path begins at a small
/// load because the law changes its tangent there.
#[test]
fn without_water_the_joint_is_a_dry_one() {
    let springs = "normal_stiffness = 1e10\nshear_stiffness = 5e9";
    for (rise, thickness, voussoirs, elements, friction, span_fraction) in [
        (3.363, 0.786, 9, "[1, 4]", 0.4766, 0.4),
        (3.395, 0.755, 9, "[1, 2]", 0.4762, 0.4),
        (3.0, 0.6, 7, "[1, 2]", 0.6, 0.25),
    ] {
        let load = |law: &str| {
            let joint = format!("law = \"{law}\"\nfriction = {friction}\n{springs}");
            let (ends, mesh) = ("jointed", format!("elements = {elements}"));
            let solver = "newton_path";
            let arch = Arch { rise, thickness, voussoirs, span_fraction, joint, ends, mesh, solver, ..Arch::default() };
            let result = answered(&arch.study());
            assert_eq!(result.status, Status::Collapse, "{law}, rise {rise}: {:?}", result.notes);
            result.load_factor.expect("a factor")
        };
        assert_close(load("uplift_joint"), load("coulomb"), 1e-7);
    }
}
