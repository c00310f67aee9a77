//! Blocks that jam: elastic joints that are loaded from zero stress decide if they stand.

use super::invariance::mapped;
use super::own_flow::{duct, groove, under_a_block, without_dilatancy};
use super::scenes::{COLLAPSE, Scene, certified};
use crate::space::{solve, solve_with_own_flow};
use voussoir_core::limit::{LimitQuestion, Status};
use voussoir_core::nalgebra::Rotation3;
use voussoir_core::space::{SpaceAnswer, SpaceProblem, SpaceVerdict, Vec3};

/// Returns the certified answer for a stage that ends at a factor.
fn up_to(problem: &SpaceProblem, max: f64) -> (SpaceAnswer, SpaceVerdict) {
    let question = LimitQuestion::Collapse { start: 0.0, max };
    let answer = solve_with_own_flow(problem, question, solve);
    let verdict = certified(problem, &answer, question);
    assert_eq!(verdict.status, answer.status, "{:?} {:?}", answer.notes, verdict.certificate);
    (answer, verdict)
}

/// A key of trapezoidal plan on the floor in a slot that is narrower at its mouth x = 0. The sides are at 15° to x.
fn dovetail(friction: f64) -> Scene {
    let (sin, cos) = 15f64.to_radians().sin_cos();
    let mut scene = Scene { bodies: vec![(1.0, Vec3::new(-0.55, 0.0, 0.25))], contacts: Vec::new() };
    let half = |x: f64| 0.4 - x * sin / cos;
    let corners = [[0.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [0.0, -1.0]];
    let floor = corners.map(|[x, side]| Vec3::new(x, side * half(x), 0.0)).to_vec();
    scene.contacts.push((None, Some(0), floor, Vec3::z(), friction));
    for side in [1.0, -1.0] {
        let corner = |x: f64, z: f64| Vec3::new(x, side * half(x), z);
        let face = vec![corner(0.0, 0.0), corner(-1.0, 0.0), corner(-1.0, 0.5), corner(0.0, 0.5)];
        scene.contacts.push((None, Some(0), face, Vec3::new(-sin, -side * cos, 0.0), friction));
    }
    scene
}

/// A block in a duct stands below the load at which it slides, and collapses above it. Pulled against a face it stands at every factor.
/// Statics alone carries all of these loads.
#[test]
fn a_block_in_a_duct_stands_below_its_load() {
    let (scene, normal) = duct(30.0, 0.4);
    let along = without_dilatancy(&scene, &Vec3::x());
    assert_eq!(solve(&along, COLLAPSE).status, Status::Unbounded);
    let load = 0.4 * (0.5 + 0.75f64.sqrt());
    for (factor, status) in [(0.2, Status::Stands), (0.999, Status::Stands), (1.001, Status::Collapse)] {
        let (answer, _) = up_to(&along, factor * load);
        assert_eq!(answer.status, status, "{factor} {:?}", answer.notes);
        assert!(answer.self_stress && answer.factor.is_none_or(|found| (found - load).abs() < 1e-8));
    }
    let across = without_dilatancy(&scene, &normal);
    assert_eq!(up_to(&across, 5.0).0.status, Status::Stands);
    assert_eq!(up_to(&across, f64::INFINITY).0.status, Status::Unbounded);
}

/// A dovetail resists at every factor if it is pulled towards the mouth of its slot, and slides at μ the other way. The status does not
/// depend on the frame.
#[test]
fn a_dovetail_jams_in_one_direction() {
    let turn = Rotation3::from_euler_angles(0.4, -1.1, 2.3);
    let mirror = |x: &Vec3| Vec3::new(x.x, -x.y, x.z);
    for (direction, factor, status) in
        [(Vec3::x(), 3.0, Status::Stands), (-Vec3::x(), 0.49, Status::Stands), (-Vec3::x(), 0.51, Status::Collapse)]
    {
        let own = without_dilatancy(&dovetail(0.5), &direction);
        let turned = mapped(&own, |x| turn * x, |x| turn * x, false);
        let mirrored = mapped(&own, mirror, mirror, true);
        for problem in [own, turned, mirrored] {
            let (answer, _) = up_to(&problem, factor);
            assert_eq!(answer.status, status, "{factor} {:?}", answer.notes);
            assert!(answer.factor.is_none_or(|found| (found - 0.5).abs() < 1e-8));
        }
    }
}

/// With a friction of 1 a slab under a cube at a wall jams with associated flow. If stiffnesses disagree about a factor, the answer is
/// open, and a collapse state proves the upper end.
#[test]
fn courses_that_disagree_leave_the_factor_open() {
    let problem = under_a_block(1.0, &[Vec3::x()], &Vec3::x());
    for (max, status) in [(1.4, Status::Stands), (2.0, Status::Stands), (2.2, Status::Open), (2.4, Status::Collapse)] {
        let (answer, verdict) = up_to(&problem, max);
        assert_eq!(answer.status, status, "{max} {:?}", answer.notes);
        let [_, upper] = verdict.bounds;
        assert_eq!(upper.is_some_and(|upper| (1.5..1.51).contains(&upper)), status != Status::Stands);
    }
}

/// A block in a groove slides at .7071, and at .8165 with associated flow. Between both it does not stand.
#[test]
fn a_factor_below_the_associated_load_is_no_proof() {
    let problem = groove(45.0, 0.5, 6.0);
    assert_eq!(up_to(&problem, 0.7).0.status, Status::Stands);
    for max in [0.71, 0.8, 0.82] {
        let (answer, _) = up_to(&problem, max);
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert!((answer.factor.unwrap() - 0.5f64.sqrt()).abs() < 1e-8);
    }
}
