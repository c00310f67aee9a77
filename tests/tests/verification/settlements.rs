//! Supports that move, small displacements: what is statically determinate moves at constant forces, and the load after
//! any settlement is that of the arch whose supports have not moved.

use voussoir::core::certificate::Side;
use voussoir::core::limit::Status;
use voussoir::results::CaseResult;
use voussoir_tests::{answered, assert_close, changed};

/// The reference arch of 15 elastic voussoirs: dead load, a settlement, a load at the quarter.
fn arch(solver: &str, settlement: &str, after: &str) -> String {
    format!(
        r#"name = "settled"
[scene]
scene = "arch"
profile = {{ shape = "segmental", span = 9.42, rise = 2.99 }}
thickness = 0.60
width = 5.81
voussoirs = 15
ends = "bonded"
material = "stone"
joint = "dry"
mesh = {{ elements = [2, 4], order = 2 }}
[materials.stone]
law = "elastic"
young_modulus = 5e9
poisson_ratio = 0.3
density = 2200.0
[joints.dry]
law = "coulomb"
friction = 0.6
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "settle"
settlement = [{settlement}]
{after}
[solver]
solver = "{solver}"
"#
    )
}

const LIVE: &str = "[[stages]]\nname = \"live\"\nuntil = \"collapse\"\nloads = [{ kind = \"point\", span_fraction = 0.25, force = [0.0, -1000.0] }]";

/// Limit load of the rigid blocks, without any settlement.
const LOAD: f64 = 698.0226652123788;

fn passes(result: &CaseResult) {
    assert!(result.certificate.passed, "{:?} {:?}", result.certificate, result.notes);
}

/// Out, in, down, both, turned: with small displacements rigid-block limit analysis does not see where supports are.
#[test]
fn the_load_after_any_settlement_is_that_of_the_unmoved_arch() {
    let left =
        |d: &str, rotation: f64| format!("{{ support = \"left\", displacement = {d}, rotation = {rotation:?} }}");
    let both = format!("{}, {{ support = \"right\", displacement = [0.05, 0.0] }}", left("[-0.05, 0.0]", 0.0));
    for settlement in [left("[-0.05, 0.0]", 0.0), left("[0.05, 0.0]", 0.0), left("[0.0, 0.0]", 0.0175), both] {
        for solver in ["event_path", "newton_path"] {
            let result = answered(&arch(solver, &settlement, LIVE));
            assert_eq!(result.status, Status::Collapse, "{solver} {settlement} {:?}", result.notes);
            passes(&result);
            assert_close(result.load_factor.expect("a collapse"), LOAD, 1e-9);
        }
    }
}

/// Three hinges on the sides that a spreading and a closing support open, as Mery's thrust lines have them; the arch
/// stands, and its hinges are listed with their sides.
#[test]
fn a_spread_arch_stands_on_three_hinges() {
    for (x, crown, springing) in [(-0.05, Side::Extrados, Side::Intrados), (0.05, Side::Intrados, Side::Extrados)] {
        let moved = format!("{{ support = \"left\", displacement = [{x:?}, 0.0] }}");
        let result = answered(&arch("event_path", &moved, ""));
        assert_eq!(result.status, Status::Stands, "{:?}", result.notes);
        passes(&result);
        let hinges = &result.stages[1].hinges;
        let greatest = hinges.iter().fold(0.0, |a: f64, h| a.max(h.rotation.abs()));
        let main: Vec<_> = hinges.iter().filter(|h| h.rotation.abs() > 0.3 * greatest).collect();
        let sides: Vec<_> = main.iter().map(|h| h.side.expect("an arch has sides")).collect();
        assert_eq!(sides, [springing, crown, springing], "{hinges:?}");
    }
}

/// Two stages that move a support to and fro leave the forces of the one that moved it least, not of the last.
#[test]
fn a_support_that_moves_back_stands_too() {
    let back = "[[stages]]\nname = \"back\"\nsettlement = [{ support = \"left\", displacement = [0.05, 0.0] }]";
    for solver in ["event_path", "newton_path"] {
        let result =
            answered(&arch(solver, "{ support = \"left\", displacement = [-0.05, 0.0] }", &format!("{back}\n{LIVE}")));
        assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
        passes(&result);
        assert_close(result.load_factor.expect("a collapse"), LOAD, 1e-9);
    }
}

/// A settlement without end is carried by constant forces.
#[test]
fn a_support_spreads_without_end_with_small_displacements() {
    let text = arch("event_path", "{ support = \"left\", displacement = [-1.0, 0.0] }", "");
    let result = answered(&changed(&text, "name = \"settle\"", "name = \"settle\"\nuntil = \"collapse\""));
    assert_eq!(result.status, Status::Unbounded, "{:?}", result.notes);
    passes(&result);
}

/// One block on a ground that moves, alone and in a wall: a rigid motion changes no force.
#[test]
fn what_stands_on_one_ground_moves_with_it() {
    let wall = r#"name = "wall"
[scene]
scene = "wall"
width = 0.24
brick = [0.5, 0.25]
courses = 4
bricks = 4
material = "stone"
joint = "dry"
[materials.stone]
law = "rigid"
density = 2000.0
[joints.dry]
law = "coulomb"
friction = 0.577
normal_stiffness = 1e10
shear_stiffness = 4e9
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "settle"
settlement = [{ support = "ground", displacement = [0.003, -0.01], rotation = 0.002 }]
[solver]
solver = "event_path"
"#;
    let unmoved = changed(wall, "displacement = [0.003, -0.01], rotation = 0.002", "displacement = [0.0, 0.0]");
    let [moved, unmoved] = [wall, unmoved.as_str()].map(answered);
    passes(&moved);
    assert_eq!(moved.status, Status::Stands, "{:?}", moved.notes);
    let [a, b] = [&moved, &unmoved].map(|result| result.proof.field.as_ref().expect("a field"));
    let size = b.iter().flat_map(|f| f.force).fold(0.0, |a: f64, r| a.max(r.abs()));
    for (a, b) in a.iter().zip(b) {
        (0..2).for_each(|i| assert!((a.force[i] - b.force[i]).abs() <= 1e-12 * size, "{a:?} {b:?}"));
    }
}

/// Strategies that follow a load have none in a stage that only moves a support: each stage has its own.
#[test]
fn each_stage_has_its_own_strategy() {
    let text = arch("newton_path", "{ support = \"left\", displacement = [-0.005, 0.0] }", LIVE);
    let own = changed(
        &text,
        "until = \"collapse\"",
        "until = \"collapse\"\ncontinuation = { strategy = \"displacement_control\" }\nstop = { displacement = 0.01 }",
    );
    let all = changed(
        &text,
        "solver = \"newton_path\"",
        "solver = \"newton_path\"\ncontinuation = { strategy = \"displacement_control\" }",
    );
    for text in [own, all] {
        let result = answered(&text);
        passes(&result);
        let factor = result.load_factor.expect("an end");
        assert!((factor - LOAD).abs() <= 1e-6 * LOAD, "{factor} {:?} {:?}", result.status, result.notes);
    }
}
