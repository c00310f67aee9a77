//! Joint laws with directional friction and with wear, and blocks that tear or fail in shear, in whole scenes with
//! every solver that supports them, against closed forms.

use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir::study::load;
use voussoir_tests::{answered, assert_close};

/// A block of 1 m × 0.5 m and 10 kN on the ground, pushed along its foot by λ kN; t of the joint points to the left.
fn pushed(joint: &str, push: f64, solver: &str, more: &str) -> String {
    format!(
        r#"name = "pushed"
[scene]
scene = "blocks"
width = 0.1
material = "stone"
joint = "bed"
blocks = [
  {{ name = "ground", vertices = [[-1.0, -0.5], [2.0, -0.5], [2.0, 0.0], [-1.0, 0.0]], fixed = true }},
  {{ name = "a", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.5], [0.0, 0.5]] }},
]
[materials.stone]
law = "rigid"
density = "200 kN/m3"
[joints.bed]
{joint}
normal_stiffness = 1e11
shear_stiffness = 4e10
[solver]
solver = "{solver}"
{more}
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "push"
until = "collapse"
loads = [{{ kind = "point", block = "a", point = [{}, 0.05], force = [{:?}, 0.0] }}]
"#,
        if push > 0.0 { 0.0 } else { 1.0 },
        1000.0 * push
    )
}

fn certified(result: &CaseResult) {
    assert!(result.certificate.passed, "{}: {:?} {:?}", result.solver, result.certificate.failures, result.notes);
}

/// A block pushed to the right slips along −t at μ₋ W, pushed to the left at μ₊ W. Limit analysis, event path and
/// Newton path agree.
#[test]
fn a_block_slides_at_the_friction_of_its_sense() {
    let joint = "law = \"coulomb_directional\"\nfriction_forward = 0.7\nfriction_backward = 0.4";
    for solver in ["auto", "limit_chain", "limit_conic", "limit_sequential", "limit_least", "event_path", "newton_path"]
    {
        for (push, factor) in [(1.0, 4.0), (-1.0, 7.0)] {
            let result = answered(&pushed(joint, push, solver, ""));
            assert_eq!(result.status, Status::Collapse, "{solver}: {:?}", result.notes);
            certified(&result);
            assert_close(result.load_factor.expect("a factor"), factor, 1e-8);
        }
    }
}

/// A rough block wears smooth: with slip z = u − λ W_1/(k_t A), where u is the displacement of the block and W_1 = 1
/// kN, λ = W (μ + tan ψ_0 e^(−z/z_0)) along the whole path, from a peak of W (μ + tan ψ_0) towards W μ.
#[test]
fn a_rough_block_wears_smooth() {
    let joint = "law = \"coulomb_wearing\"\nfriction = 0.5\ndilatancy_angle = 15.0\nwear_slip = 2e-3";
    let output = "continuation = { strategy = \"arc_length\" }\nstop = { displacement = 4e-3 }\n[output]\ncurve = true";
    let result = answered(&pushed(joint, 1.0, "newton_path", output));
    certified(&result);
    let slope = 15.0_f64.to_radians().tan();
    assert_close(result.path.first_limit_point.expect("a peak"), 10.0 * (0.5 + slope), 1e-4);
    let curve = result.path.curve.expect("a curve");
    let (mut compared, mut furthest) = (0, 0.0_f64);
    // The push rotates the block a little on its joint, which moves the load point by less than 1e-6 m relative to its
    // foot.
    for [displacement, factor] in curve {
        let slip = displacement - factor * 1e3 / (4e10 * 0.1);
        if slip > 2e-5 {
            assert_close(factor, 10.0 * (0.5 + slope * (-slip / 2e-3).exp()), 2e-3);
            compared += 1;
            furthest = furthest.max(slip);
        }
    }
    assert!(compared >= 5 && furthest > 2e-3, "{compared} points up to {furthest:e} m");
}

/// A block with a uniform pressure of 1 MPa from its weight, pushed in the plane of the joint, slides at tan(25° + 10
/// log10 100) = 1 times its weight.
#[test]
fn a_rock_joint_slides_at_its_peak_strength() {
    let joint = "law = \"barton_bandis\"\nroughness = 10.0\nwall_strength = 1e8\nresidual_angle = 25.0\ngreatest_closure = 2e-4";
    let text = pushed(
        joint,
        1.0,
        "newton_path",
        "continuation = { strategy = \"arc_length\" }\nstop = { displacement = 1e-3 }",
    );
    // 10 kN on 0.01 m².
    let text = text.replace("width = 0.1", "width = 0.01").replace("200 kN/m3", "2000 kN/m3");
    let text = text
        .replace("normal_stiffness = 1e11", "normal_stiffness = 1e10")
        .replace("point = [0, 0.05]", "point = [0.0, 0.0]");
    let result = answered(&text);
    certified(&result);
    assert_close(result.load_factor.expect("a factor"), 10.0, 1e-9);
}

/// A law without facets is refused by name if facets are needed; the message names the solvers that support it.
#[test]
fn wear_is_refused_by_limit_analysis_by_name() {
    let joint = "law = \"coulomb_wearing\"\nfriction = 0.5\ndilatancy_angle = 15.0\nwear_slip = 2e-3";
    let wrong = load(&pushed(joint, 1.0, "limit_chain", ""), "a.toml", &[]).expect_err("refused");
    let text = wrong.mistakes()[0].to_string();
    assert!(text.contains("coulomb_wearing") && text.contains("solvers that can take it: newton_path"), "{text}");
}

/// A column of 0.5 m² on smooth ground in plane stress, under a pressure of λ kPa on its top; ν = 0.
fn column(material: &str, pressure: f64) -> String {
    format!(
        r#"name = "column"
[scene]
scene = "blocks"
width = 0.5
plane = "stress"
material = "stone"
joint = "bed"
blocks = [
  {{ name = "ground", vertices = [[-1.0, -0.5], [2.0, -0.5], [2.0, 0.0], [-1.0, 0.0]], fixed = true }},
  {{ name = "a", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] }},
]
[scene.mesh]
elements = [1, 1]
[materials.stone]
{material}
young_modulus = 4e9
poisson_ratio = 0.0
density = 2200.0
[joints.bed]
law = "mohr_coulomb"
friction = 0.6
cohesion = 1e9
tensile_strength = 1e9
[solver]
solver = "newton_path"
stop = {{ displacement = 5e-4 }}
continuation = {{ strategy = "displacement_control", first_step = 0.2 }}
[[stages]]
name = "press"
until = "collapse"
loads = [{{ kind = "pressure", block = "a", edge = 2, value = {pressure:?} }}]
"#
    )
}

/// Blocks carry the exact strengths: in tension f_t, in compression of `mohr_coulomb_solid` 2 c cos φ / (1 − sin φ),
/// with ψ = 0 and ν = 0 also if the foot is glued, because σ_z = 0 allows flow out of plane.
#[test]
fn blocks_carry_their_strengths() {
    let rankine = "law = \"rankine\"\ntensile_strength = 1e6";
    let solid = "law = \"mohr_coulomb_solid\"\ncohesion = 1e6\nfriction_angle = 30.0\ntensile_strength = 5e5";
    for (material, pressure, strength) in [(rankine, -1e3, 1e6), (solid, -1e3, 5e5), (solid, 1e3, 2e6 * 3.0_f64.sqrt())]
    {
        let result = answered(&column(material, pressure));
        assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
        certified(&result);
        assert_close(result.load_factor.expect("a factor"), strength / 1e3, 1e-9);
    }
}
