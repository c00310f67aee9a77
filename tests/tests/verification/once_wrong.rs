//! Difficult scenes with known answers.

use voussoir::core::limit::Status;
use voussoir::verify::case::verify_case;
use voussoir_tests::{Wall, answered, assert_close, changed, first_case, passes};

/// Returns the reference arch, elastic, with dry joints of friction 0.6, with its rise, ends, mesh, stages and solver.
fn bridge(rise: f64, ends: &str, mesh: &str, stages: &str, solver: &str) -> String {
    format!(
        r#"name = "bridge"
[scene]
scene = "arch"
profile = {{ shape = "segmental", span = 9.42, rise = {rise:?} }}
thickness = 0.60
width = 5.81
voussoirs = 15
ends = "{ends}"
material = "stone"
joint = "dry"
mesh = {{ {mesh} }}
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
{stages}
[solver]
{solver}
"#
    )
}

fn live(at: f64) -> String {
    format!(
        "[[stages]]\nname = \"live\"\nuntil = \"collapse\"\nloads = [{{ kind = \"point\", span_fraction = {at:?}, force = [0.0, -1000.0] }}]"
    )
}

fn left(x: f64) -> String {
    format!("[[stages]]\nname = \"settle\"\nsettlement = [{{ support = \"left\", displacement = [{x:?}, 0.0] }}]\n")
}

/// An elastic block of 19.62 kN follows its ground, which moves down, or sideways by friction. By statics each of its
/// corners carries half of its weight, which shortens the block.
#[test]
fn an_elastic_block_goes_with_its_ground() {
    let scene = r#"name = "ground"
[scene]
scene = "blocks"
width = 1.0
material = "stone"
joint = "dry"
mesh = { elements = [1, 1], order = 1 }
blocks = [
 { name = "ground", vertices = [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-1.0, 0.0]], fixed = true },
 { name = "block", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] },
]
[materials.stone]
law = "elastic"
young_modulus = 1e9
poisson_ratio = 0.2
density = 2000.0
[joints.dry]
law = "coulomb"
friction = 0.5
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "settle"
settlement = [{ support = "ground", displacement = [0.0, 0.0] }]
[solver]
solver = "event_path"
"#;
    for solver in ["event_path", "newton_path"] {
        let of =
            |d: &str| answered(&changed(&changed(scene, "event_path", solver), "[0.0, 0.0] }", &format!("{d} }}")));
        let unmoved = of("[0.0, 0.0]");
        for (d, by) in [("[0.0, -0.001]", [0.0, -1e-3]), ("[0.001, 0.0]", [1e-3, 0.0])] {
            let result = of(d);
            assert_eq!(result.status, Status::Stands, "{solver} {d} {:?}", result.notes);
            passes(&result);
            let field = result.proof.field.as_ref().expect("a field");
            field.iter().for_each(|entry| assert_close(entry.force[0], 9810.0, 1e-12));
            let [after, before] = [&result, &unmoved].map(|r| r.path.displacements.clone().expect("displacements"));
            for (after, before) in after.iter().zip(&before) {
                (0..2).for_each(|i| {
                    assert!((after.displacement[i] - before.displacement[i] - by[i]).abs() < 1e-15, "{after:?}")
                });
            }
        }
    }
}

/// 62 dry bricks around a window on compliant joints stand: one brick is held by its vertical joints only, so that no
/// path begins, but a field carries the weight. `auto` reports that the wall stands and the flow rule; named in the
/// study, the path solver stalls. The ground may move down without change.
#[test]
fn dry_bricks_around_a_window_stand() {
    let wall = |solver: &str| Wall::around_a_window("friction_angle = \"30 deg\"", solver).under_its_weight();
    let settled =
        "[[stages]]\nname = \"settle\"\nsettlement = [{ support = \"ground\", displacement = [0.0, -0.01] }]\n";
    for more in ["", settled] {
        let text = wall("auto") + more;
        let result = answered(&text);
        assert_eq!(result.status, Status::Stands, "{more} {:?}", result.notes);
        passes(&result);
        assert_eq!(result.flow_read_as.as_deref(), Some("associated"), "{:?}", result.notes);
        assert!(result.notes.iter().any(|note| note.contains("no path from unloaded joints")), "{:?}", result.notes);
        assert_eq!(verify_case(&first_case(&text), &result), Vec::<String>::new());
    }
    let by_path = answered(&wall("newton_path"));
    assert_eq!(by_path.status, Status::Stalled);
}

/// The weight of held bodies that move down with their support does work: exact paths balance within rounding.
#[test]
fn the_weight_of_held_bodies_counts_in_the_work() {
    let scene = r#"name = "energy"
[scene]
scene = "arch"
profile = { shape = "segmental", span = 4.0, rise = 1.0 }
thickness = 0.5
width = 1.0
voussoirs = 7
ends = "bonded"
material = "stone"
joint = "dry"
mesh = { elements = [1, 2], order = 2 }
[materials.stone]
law = "elastic"
young_modulus = 2e9
poisson_ratio = 0.2
density = 2000.0
[joints.dry]
law = "coulomb"
friction = 0.7
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "settle"
settlement = [{ support = "right", displacement = [0.0, -0.001] }]
[solver]
solver = "event_path"
"#;
    let compliant = changed(scene, "young_modulus = 2e9\npoisson_ratio = 0.2\n", "");
    let compliant = changed(&compliant, "law = \"elastic\"", "law = \"rigid\"");
    let compliant =
        changed(&compliant, "friction = 0.7", "friction = 0.7\nnormal_stiffness = 1e9\nshear_stiffness = 1e9");
    for text in [scene, &compliant] {
        for ends in ["bonded", "jointed"] {
            let result = answered(&changed(text, "\"bonded\"", &format!("\"{ends}\"")));
            assert_eq!(result.status, Status::Stands, "{:?}", result.notes);
            passes(&result);
            let energy = result.certificate.residuals["path_energy"];
            assert!(energy < 1e-12, "{ends} {energy}");
        }
    }
}

/// Jointed arches that are too high for their thickness have no equilibrium, with finite displacements as by limit
/// analysis.
#[test]
fn arches_too_high_for_their_thickness_have_no_equilibrium() {
    for rise in [5.69, 5.39, 5.09] {
        for solver in ["solver = \"newton_path\"\nkinematics = \"finite\"", "solver = \"limit_conic\""] {
            let mesh = "elements = [4, 10], order = 2, grading = 8.0";
            let result = answered(&bridge(rise, "jointed", mesh, &live(0.25), solver));
            assert_eq!(result.status, Status::NoEquilibrium, "{rise} {solver} {:?}", result.notes);
            passes(&result);
        }
    }
}

/// A load at midspan of a symmetric arch has a symmetric mechanism: five hinges, the one at the crown shared by two
/// joints.
#[test]
fn a_symmetric_scene_has_a_symmetric_mechanism() {
    let text = bridge(3.89, "bonded", "elements = [4, 6], order = 2", &live(0.5), "solver = \"event_path\"");
    let result = answered(&text);
    assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
    passes(&result);
    assert_close(result.load_factor.expect("a collapse"), 987.1088814998997, 1e-9);
    let mechanism = result.mechanism.expect("a mechanism");
    let joints: Vec<usize> = mechanism.hinges.iter().map(|hinge| hinge.joint).collect();
    assert_eq!(joints, [1, 4, 7, 8, 11, 14]);
    for (hinge, twin) in mechanism.hinges.iter().zip(mechanism.hinges.iter().rev()) {
        assert_eq!(hinge.side, twin.side);
        assert_close(hinge.rotation, twin.rotation, 1e-9);
    }
}

/// A bridge of elastic voussoirs on dry joints, spread by five centimetres, carries 593.5 kN; without the settlement it
/// carries 624. The first peak is 92.513.
#[test]
fn a_spread_elastic_bridge_carries_nearly_what_the_unsettled_one_does() {
    let mesh = "elements = [4, 10], order = 2, grading = 8.0";
    let stages = format!("{}{}", left(-0.05), live(0.25));
    let result = answered(&bridge(2.99, "bonded", mesh, &stages, "solver = \"newton_path\"\nkinematics = \"finite\""));
    assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
    passes(&result);
    assert_close(result.load_factor.expect("a collapse"), 593.516, 1e-4);
}

/// A bridge of compliant joints with Coulomb friction carries 608.5 when spread by 5 mm, and near 600 when spread by 5
/// cm.
#[test]
fn a_spread_bridge_of_compliant_joints_carries_near_six_hundred() {
    for (x, load) in [(-0.005, 608.5013), (-0.05, 586.8142)] {
        let stages = format!("{}{}", left(x), live(0.25));
        let solver = "solver = \"newton_path\"\nkinematics = \"finite\"";
        let text = bridge(2.99, "bonded", "elements = [1, 8]", &stages, solver);
        let text = changed(&text, "law = \"elastic\"\nyoung_modulus = 5e9\npoisson_ratio = 0.3", "law = \"rigid\"");
        let joints = "friction = 0.6\nnormal_stiffness = 2e10\nshear_stiffness = 1e10";
        let result = answered(&changed(&text, "friction = 0.6", joints));
        assert_eq!(result.status, Status::Collapse, "{x} {:?}", result.notes);
        passes(&result);
        assert_close(result.load_factor.expect("a collapse"), load, 1e-4);
        assert!(result.certificate.residuals["path_energy"] < 1e-3, "{:?}", result.certificate.residuals);
    }
}

/// A stiff shallow bridge is followed over a sharp fold: beyond the peak and its trough a point closes while the load
/// rises, and sticks, and the path turns back there. Displacement control and dissipation give the same load to 1e-11.
#[test]
fn a_stiff_shallow_bridge_is_followed_over_a_sharp_fold() {
    let mesh = "elements = [4, 8], order = 2, grading = 8.0";
    let solver = "solver = \"newton_path\"\nkinematics = \"finite\"\ncontinuation = { strategy = \"arc_length\" }";
    let text = bridge(0.29, "bonded", mesh, &live(0.25), solver);
    let result = answered(&changed(&text, "young_modulus = 5e9", "young_modulus = 5e11"));
    assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
    passes(&result);
    assert_close(result.load_factor.expect("a collapse"), 2_619_328.726_8, 1e-9);
}
