//! Materials whose stiffness changes: a damaged block unloads along its damaged stiffness.

use voussoir::core::limit::Status;
use voussoir_tests::{answered, assert_close, changed};

/// A block of 1 m that is bonded to the ground and pushed sideways at its top by 250 kN, then by 50 kN only.
const PULL: &str = r#"name = "pull"
[scene]
scene = "blocks"
width = 1.0
material = "stone"
joint = "glue"
plane = "stress"
mesh = { elements = [4, 4] }
blocks = [
  { name = "ground", fixed = true, vertices = [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-1.0, 0.0]] },
  { name = "stone", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] },
]
[materials.stone]
law = "mazars_damage"
young_modulus = 1e10
poisson_ratio = 0.0
density = 2200.0
tensile_strength = 1e6
fracture_energy = 20000.0
[joints.glue]
law = "mohr_coulomb"
friction = 1.0
cohesion = 1e9
tensile_strength = 1e9
[[stages]]
name = "pull"
gravity = 0.0
factor = 1.0
loads = [{ kind = "point", block = "stone", point = [0.5, 1.0], force = ["250 kN", "0 kN"] }]
[[stages]]
name = "back"
factor = 1.0
loads = [{ kind = "point", block = "stone", point = [0.5, 1.0], force = ["-200 kN", "0 kN"] }]
[output]
curve = true
"#;

/// Returns the compliance [m/N] at every state of the second stage, in which 250 kN decrease to 50 kN.
fn compliances(text: &str) -> Vec<f64> {
    let result = answered(text);
    assert_eq!((result.status, result.certificate.passed), (Status::Stands, true), "{:?}", result.notes);
    let curve = result.path.curve.expect("a curve");
    curve.iter().map(|[displacement, factor]| -displacement / (250e3 - 200e3 * factor)).collect()
}

/// Isotropic damage unloads along a line through the origin: all states have the same compliance. The number at the end comes from a
/// run in which unloading was declared as softening, so that every step used the law's tangent.
#[test]
fn a_damaged_block_unloads_through_the_origin() {
    let found = compliances(PULL);
    let last = *found.last().expect("states");
    assert_close(last, 2.896_882_00e-5 / 50e3, 1e-7);
    found.iter().for_each(|own| assert_close(*own, last, 1e-8));
}

/// The same holds if cracks can close and the block can crush far above these stresses, with another element order, in plane
/// strain, and on another mesh.
#[test]
fn unloading_does_not_depend_on_the_form_of_damage() {
    let both = PULL.replace("law = \"mazars_damage\"", "law = \"damage_plasticity\"\ncompressive_strength = 1e9");
    for text in [
        both.clone(),
        changed(&both, "elements = [4, 4]", "elements = [4, 4], order = 1"),
        changed(&both, "plane = \"stress\"", "plane = \"strain\""),
        changed(PULL, "elements = [4, 4]", "elements = [6, 6]"),
    ] {
        let found = compliances(&text);
        let last = *found.last().expect("states");
        found.iter().for_each(|own| assert_close(*own, last, 1e-6));
    }
}
