//! Every status with its proof, on scenes whose answer follows from statics alone.

use voussoir::core::certificate::MechanismKind;
use voussoir::core::limit::Status;
use voussoir_tests::{answered, assert_close, changed, compliant};

/// A block of 1 m × 1 m × 1 m, density 1000, g 10 (weight 10 kN), on a rough ground.
fn block(joint: &str, gravity: &str, stages: &str, solver: &str) -> String {
    format!(
        r#"name = "block"
[scene]
scene = "blocks"
width = 1.0
material = "stone"
joint = "dry"
blocks = [
  {{ name = "ground", vertices = [[-2.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-2.0, 0.0]], fixed = true }},
  {{ name = "a", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] }},
]
[materials.stone]
law = "rigid"
density = 1000.0
[joints.dry]
{joint}
[solver]
solver = "{solver}"
[[stages]]
name = "dead"
gravity = {gravity}
{stages}
"#
    )
}

fn push(height: f64, extra: &str) -> String {
    format!(
        "[[stages]]\nname = \"push\"\nuntil = \"collapse\"\n{extra}\nloads = [{{ kind = \"point\", block = \"a\", point = [0.0, {height:?}], force = [1000.0, 0.0] }}]"
    )
}

const SOLVERS: [&str; 2] = ["limit_chain", "limit_conic"];
const ROUGH: &str = "law = \"coulomb_associated\"\nfriction = 0.6";

/// Pushed at its top with μ 0.6 a cube tips about its edge at W/2 = 5 kN; pushed at its foot it slides at μ W = 6 kN.
#[test]
fn a_cube_tips_or_slides() {
    for solver in SOLVERS {
        let tips = answered(&block(ROUGH, "10.0", &push(1.0, ""), solver));
        assert_close(tips.load_factor.expect("a collapse"), 5.0, 1e-14);
        let mechanism = tips.mechanism.expect("a mechanism");
        assert_eq!((mechanism.kind, mechanism.hinge_count), (MechanismKind::Rocking, 1));
        assert_eq!(mechanism.hinges[0].point, [1.0, 0.0]);
        let slides = answered(&block(ROUGH, "10.0", &push(0.0, ""), solver));
        assert_close(slides.load_factor.expect("a collapse"), 6.0, 1e-14);
        assert_eq!(slides.mechanism.expect("a mechanism").kind, MechanismKind::Sliding);
    }
}

/// With cohesion 2 kPa, tension 1 kPa and crushing 100 kPa the integrated joint slides at c A + μ W = 8 kN, and tips at
/// the top at M = (N + f_t A)(f_c A − N) h / (2 A (f_c + f_t)).
#[test]
fn a_mortared_cube_follows_the_stress_block() {
    let mortar = "law = \"mohr_coulomb\"\nfriction = 0.6\ncohesion = 2000.0\ntensile_strength = 1000.0\ncompressive_strength = 1e5";
    for solver in SOLVERS {
        let slides = answered(&block(mortar, "10.0", &push(0.0, ""), solver));
        assert_close(slides.load_factor.expect("a collapse"), 8.0, 1e-12);
        let tips = answered(&block(mortar, "10.0", &push(1.0, ""), solver));
        let moment = (10.0 + 1.0) * (100.0 - 10.0) / (2.0 * 101.0);
        assert_close(tips.load_factor.expect("a collapse"), moment, 1e-12);
    }
}

/// Gravity outside the friction cone: there is no equilibrium, refuted by a sliding motion. A push in the opposite
/// direction makes it possible from 2 kN, which is reported as an interval and not as a load factor.
#[test]
fn dead_load_alone_fails() {
    let tilted = "[8.0, -10.0]";
    let back = "[[stages]]\nname = \"push\"\nuntil = \"collapse\"\nloads = [{ kind = \"point\", block = \"a\", point = [1.0, 0.0], force = [-1000.0, 0.0] }]";
    for solver in SOLVERS {
        let result = answered(&block(ROUGH, tilted, back, solver));
        assert_eq!((result.status, result.load_factor), (Status::NoEquilibrium, None));
        assert!(result.certificate.passed, "{:?}", result.certificate);
        let [low, high] = result.feasible_interval.expect("an interval");
        assert_close(low.expect("finite"), 2.0, 1e-12);
        assert!(high.expect("finite") > 2.0);
        assert_eq!(result.stages[0].status, Status::NoEquilibrium);
        // Dead load alone: the same status, without an interval.
        let dead = answered(&block(ROUGH, tilted, "", solver));
        assert_eq!((dead.status, dead.feasible_interval), (Status::NoEquilibrium, None));
        assert!(dead.certificate.passed, "{:?}", dead.certificate);
    }
}

/// With finite displacements too: if friction alone holds no share of gravity, none is tried; with cohesion c A = 1 kN
/// the block slides at the share c A / (8 kN − 0.6 · 10 kN) = ½.
#[test]
fn finite_displacements_know_what_carries_no_share_of_its_weight() {
    let tilted = |joint: &str| {
        let joint = compliant(joint, 1e9, 1e9);
        answered(&block(&joint, "[8.0, -10.0]", "", "newton_path\"\nkinematics = \"finite"))
    };
    let dry = tilted("law = \"coulomb\"\nfriction = 0.6");
    assert_eq!(dry.status, Status::NoEquilibrium);
    assert!(dry.certificate.passed && dry.notes[0].contains("No load path was computed"), "{:?}", dry.notes);
    let glued = tilted("law = \"mohr_coulomb\"\nfriction = 0.6\ncohesion = 1000.0\ndilatancy_angle = 0.0");
    assert_eq!((glued.status, glued.solver.as_str()), (Status::NoEquilibrium, "newton_path"), "{:?}", glued.notes);
    assert!(glued.notes.iter().any(|note| note.contains("up to 0.500000")), "{:?}", glued.notes);
    assert_eq!(tilted("law = \"coulomb\"\nfriction = 0.81").status, Status::Stands);
}

/// No factor makes equilibrium possible if a sliding block is pushed upwards.
#[test]
fn no_factor_makes_equilibrium_possible() {
    let level = "[[stages]]\nname = \"down\"\nuntil = \"collapse\"\nloads = [{ kind = \"point\", block = \"a\", point = [0.5, 1.0], force = [600.0, -1000.0] }]";
    for solver in SOLVERS {
        let result = answered(&block(ROUGH, "[8.0, -10.0]", level, solver));
        assert_eq!((result.status, result.feasible_interval), (Status::NoEquilibrium, None), "{:?}", result.notes);
        assert!(result.certificate.passed, "{:?}", result.certificate);
    }
}

/// A load that presses the block on the ground is carried at any factor, with a ray; limited by factor_max it stands.
#[test]
fn a_pressed_block_is_unbounded_and_stands_up_to_a_cap() {
    let press = |extra: &str| {
        format!(
            "[[stages]]\nname = \"press\"\nuntil = \"collapse\"\n{extra}\nloads = [{{ kind = \"point\", block = \"a\", point = [0.5, 1.0], force = [0.0, -1000.0] }}]"
        )
    };
    for solver in SOLVERS {
        let free = answered(&block(ROUGH, "10.0", &press(""), solver));
        assert_eq!((free.status, free.load_factor), (Status::Unbounded, None));
        assert!(free.certificate.passed && free.proof.ray.is_some());
        let capped = answered(&block(ROUGH, "10.0", &press("factor_max = 7.0"), solver));
        assert_eq!((capped.status, capped.load_factor, capped.proof.field_factor), (Status::Stands, None, Some(7.0)));
        assert!(capped.certificate.passed);
    }
}

/// A stage with a factor stands if the factor is reached, and collapses otherwise.
#[test]
fn a_stage_with_a_factor_stands_or_collapses_on_the_way() {
    let to = |factor: f64| changed(&push(1.0, ""), "until = \"collapse\"", &format!("factor = {factor:?}"));
    for solver in SOLVERS {
        assert_eq!(answered(&block(ROUGH, "10.0", &to(4.9), solver)).status, Status::Stands);
        let short = answered(&block(ROUGH, "10.0", &to(5.1), solver));
        assert_eq!(short.status, Status::Collapse);
        assert_close(short.load_factor.expect("a collapse"), 5.0, 1e-14);
    }
}

/// Frictionless joints slide under any push; zero friction and `unilateral` with a free tangent agree.
#[test]
fn zero_friction_is_frictionless() {
    for solver in SOLVERS {
        for law in ["law = \"coulomb_associated\"\nfriction = 0.0", "law = \"unilateral\"\ntangential = \"free\""] {
            let result = answered(&block(law, "10.0", &push(0.5, ""), solver));
            assert_eq!((result.status, result.load_factor), (Status::Collapse, Some(0.0)), "{law}");
            assert!(result.certificate.passed);
        }
    }
}

/// A non-associated law has its own flow; a solver with associated flow reports it.
#[test]
fn non_associated_friction_is_flagged() {
    let coulomb = "law = \"coulomb\"\nfriction = 0.6";
    let own = answered(&block(coulomb, "10.0", &push(1.0, ""), "auto"));
    assert_eq!((own.solver.as_str(), own.flow_read_as.as_deref()), ("limit_least", None));
    assert_close(own.load_factor.expect("a collapse"), 5.0, 1e-12);
    for solver in SOLVERS {
        let result = answered(&block(coulomb, "10.0", &push(1.0, ""), solver));
        assert_eq!(result.flow_read_as.as_deref(), Some("associated"));
        assert!(result.notes.iter().any(|note| note.contains("upper bound")));
    }
    assert_eq!(answered(&block(ROUGH, "10.0", &push(1.0, ""), "auto")).flow_read_as, None);
}
