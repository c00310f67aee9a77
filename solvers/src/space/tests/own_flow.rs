//! Collapse states with slip that does not open the joints: scenes whose least load is known.

use super::invariance::mapped;
use super::scenes::{COLLAPSE, Scene, certified, rectangle};
use crate::space::{solve, solve_with_own_flow};
use voussoir_core::law::FrictionCone;
use voussoir_core::limit::Status;
use voussoir_core::nalgebra::Rotation3;
use voussoir_core::space::{SpaceProblem, Vec3};

/// Relative distance to loads that are exact.
const EXACT: f64 = 1e-8;

/// Returns the problem with slip that does not open the joints.
pub fn without_dilatancy(scene: &Scene, direction: &Vec3) -> SpaceProblem {
    let mut problem = scene.problem(direction);
    problem.contacts.iter_mut().for_each(|contact| contact.law = FrictionCone::dry(contact.law.friction, 0.0));
    problem
}

/// Returns the certified collapse factor and the associated one.
pub fn found(problem: &SpaceProblem) -> (f64, Option<f64>) {
    let answer = solve_with_own_flow(problem, COLLAPSE, solve);
    let verdict = certified(problem, &answer, COLLAPSE);
    assert_eq!(verdict.status, Status::Collapse, "{:?} {:?}", answer.notes, verdict.certificate);
    (answer.factor.unwrap(), answer.non_associated.unwrap().associated_factor)
}

fn meets(found: f64, expected: f64, case: &str) {
    assert!((found - expected).abs() <= EXACT * expected, "{case}: {found} instead of {expected}");
}

/// A prism of length `length` in a groove whose faces are at α to the vertical, pulled along the groove.
pub fn groove(alpha: f64, friction: f64, length: f64) -> SpaceProblem {
    let (sin, cos) = alpha.to_radians().sin_cos();
    let mut scene = Scene { bodies: vec![(1.0, Vec3::new(length / 2.0, 0.0, cos * 2.0 / 3.0))], contacts: Vec::new() };
    for side in [1.0, -1.0] {
        let corner = |x: f64, along: f64| Vec3::new(x, side * along * sin, along * cos);
        let face = vec![corner(0.0, 0.0), corner(length, 0.0), corner(length, 1.0), corner(0.0, 1.0)];
        scene.contacts.push((None, Some(0), face, Vec3::new(0.0, -side * cos, sin), friction));
    }
    without_dilatancy(&scene, &Vec3::x())
}

/// A block in a groove slides at μ / sin α. The associated factor is (μ / sin α) / √(1 − μ² cot² α).
#[test]
fn a_block_in_a_groove_slides_at_the_friction_of_both_faces() {
    for (alpha, friction, length) in [(45.0, 0.5, 40.0), (45.0, 0.5, 6.0), (30.0, 0.3, 6.0)] {
        let (least, associated) = found(&groove(alpha, friction, length));
        let sin = f64::to_radians(alpha).sin();
        let case = format!("{alpha}° {friction} {length}");
        meets(least, friction / sin, &case);
        let jam = friction / f64::to_radians(alpha).tan();
        meets(associated.unwrap(), friction / sin / (1.0 - jam * jam).sqrt(), &case);
    }
}

/// A block that fills a square duct turned by β about its axis x. Also returns the normal of a face.
pub fn duct(beta: f64, friction: f64) -> (Scene, Vec3) {
    let (sin, cos) = beta.to_radians().sin_cos();
    let mut scene = Scene { bodies: vec![(1.0, Vec3::new(2.0, 0.0, 0.0))], contacts: Vec::new() };
    let turned = |x: f64, y: f64, z: f64| Vec3::new(x, y * cos - z * sin, y * sin + z * cos);
    for (y, z) in [(0.0, 1.0), (0.0, -1.0), (1.0, 0.0), (-1.0, 0.0)] {
        let corner = |x: f64, along: f64| turned(x, 0.5 * y - along * z, 0.5 * z + along * y);
        let face = vec![corner(0.0, -0.5), corner(4.0, -0.5), corner(4.0, 0.5), corner(0.0, 0.5)];
        scene.contacts.push((None, Some(0), face, turned(0.0, -y, -z), friction));
    }
    (scene, turned(0.0, 1.0, 0.0))
}

/// A block that fills a square duct turned by β about its axis jams with associated flow; it slides at μ (cos β + sin β).
#[test]
fn a_block_in_a_duct_slides_where_statics_alone_jams() {
    for (beta, friction) in [(30.0, 0.4), (20.0, 0.7), (0.0, 0.6)] {
        let (sin, cos) = f64::to_radians(beta).sin_cos();
        let (least, associated) = found(&without_dilatancy(&duct(beta, friction).0, &Vec3::x()));
        assert_eq!(associated, None);
        meets(least, friction * (cos + sin), &format!("{beta}° {friction}"));
    }
}

/// A slab 2 × 2 × .5 on the floor with a cube on it that touches walls; the slab is pulled towards them.
pub fn under_a_block(friction: f64, walls: &[Vec3], direction: &Vec3) -> SpaceProblem {
    let mut scene = Scene::default();
    scene.add_box([-1.0, 1.0], [-1.0, 1.0], [0.0, 0.5]);
    scene.add_box([-0.5, 0.5], [-0.5, 0.5], [0.5, 1.5]);
    scene.contacts.push((None, Some(0), rectangle([-1.0, 1.0], [-1.0, 1.0], 0.0), Vec3::z(), friction));
    scene.contacts.push((Some(0), Some(1), rectangle([-0.5, 0.5], [-0.5, 0.5], 0.5), Vec3::z(), friction));
    for wall in walls {
        let across = Vec3::z().cross(wall);
        let corner = |a: f64, z: f64| wall * 0.5 + across * a + Vec3::z() * z;
        let face = vec![corner(-0.5, 0.5), corner(0.5, 0.5), corner(0.5, 1.5), corner(-0.5, 1.5)];
        scene.contacts.push((None, Some(1), face, -wall, friction));
    }
    let mut problem = without_dilatancy(&scene, direction);
    problem.varying[1] = [0.0; 6];
    problem
}

/// A slab drawn out from under a cube at a wall: μ (1 + 2 w / (1 + μ²)) with w = .5; the associated factor is
/// μ (1 + 2 w / (1 − μ²)).
#[test]
fn a_slab_is_drawn_out_from_under_a_block_at_a_wall() {
    for friction in [0.6, 0.4] {
        let (least, associated) = found(&under_a_block(friction, &[Vec3::x()], &Vec3::x()));
        meets(associated.unwrap(), friction * (1.0 + 1.0 / (1.0 - friction * friction)), "associated");
        meets(least, friction * (1.0 + 1.0 / (1.0 + friction * friction)), "least");
    }
    // With a friction of 1 the blocks jam with associated flow.
    let (least, associated) = found(&under_a_block(1.0, &[Vec3::x()], &Vec3::x()));
    assert_eq!(associated, None);
    meets(least, 1.5, "jam");
}

/// The slab in a corner of two walls, pulled along the diagonal.
pub fn in_a_corner() -> SpaceProblem {
    under_a_block(0.6, &[Vec3::x(), Vec3::y()], &Vec3::new(1.0, 1.0, 0.0).normalize())
}

/// In a corner the slab turns about one corner of its base while it slides: a state at 0.857514, below the 0.966659 of the translation.
/// Eighty random starts of an independent program found 0.8574, with states that hold to 1e-6.
#[test]
fn a_slab_is_drawn_out_from_a_corner() {
    let (least, associated) = found(&in_a_corner());
    meets(associated.unwrap(), 2.250_147_330_8, "associated");
    meets(least, 0.857_514_057_75, "least");
}

/// A mirrored and turned scene has the same load.
#[test]
fn loads_do_not_depend_on_the_frame() {
    let turn = Rotation3::from_euler_angles(0.4, -1.1, 2.3);
    let mirror = |x: &Vec3| Vec3::new(x.x, -x.y, x.z);
    for problem in [groove(45.0, 0.5, 6.0), under_a_block(0.6, &[Vec3::x()], &Vec3::x()), in_a_corner()] {
        let own = found(&problem).0;
        meets(found(&mapped(&problem, |x| turn * x, |x| turn * x, false)).0, own, "turned");
        meets(found(&mapped(&problem, mirror, mirror, true)).0, own, "mirrored");
    }
}
