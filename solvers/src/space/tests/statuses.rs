//! Every status with its proof, and questions without an answer.

use super::scenes::{COLLAPSE, Scene, certified, collapse, rectangle};
use crate::space::{solve, solve_by_clarabel};
use voussoir_core::limit::{LimitQuestion, Status};
use voussoir_core::space::{SpaceProblem, Vec3};

/// A unit cube on the ground with μ = 0.4.
fn cube() -> Scene {
    let mut scene = Scene::default();
    let cube = scene.add_box([0.0, 1.0], [0.0, 1.0], [0.0, 1.0]);
    scene.contacts.push((None, Some(cube), rectangle([0.0, 1.0], [0.0, 1.0], 0.0), Vec3::z(), 0.4));
    scene
}

fn vertical(x: f64) -> Vec<Vec3> {
    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[y, z]| Vec3::new(x, y, z)).to_vec()
}

/// Returns the certified status of an answer, which must be the hint.
fn status(problem: &SpaceProblem, question: LimitQuestion) -> Status {
    let answer = solve(problem, question);
    let verdict = certified(problem, &answer, question);
    assert_eq!(verdict.status, answer.status, "{:?} {:?}", answer.notes, verdict.certificate);
    verdict.status
}

/// Below the collapse factor the cube stands, above it a motion refutes equilibrium; a search that ends below the
/// collapse factor stands at its end.
#[test]
fn a_cube_stands_below_its_collapse_factor_only() {
    let problem = cube().problem(&Vec3::x());
    assert_eq!(status(&problem, LimitQuestion::Admissible(0.39)), Status::Stands);
    assert_eq!(status(&problem, LimitQuestion::Admissible(0.41)), Status::NoEquilibrium);
    assert_eq!(status(&problem, LimitQuestion::Collapse { start: 0.5, max: 1.0 }), Status::NoEquilibrium);
    assert_eq!(status(&problem, LimitQuestion::Collapse { start: -0.2, max: 0.3 }), Status::Stands);
    assert_eq!(status(&problem, LimitQuestion::Collapse { start: -0.5, max: 0.3 }), Status::NoEquilibrium);
    let answer = solve(&problem, LimitQuestion::Collapse { start: -0.2, max: 0.5 });
    assert!((answer.factor.unwrap() - 0.4).abs() < 1e-9);
}

/// Blocks that nothing holds fall, alone or in contact with each other, also beside a cube that is jammed between walls.
#[test]
fn blocks_without_ground_fall() {
    let mut scene = cube();
    scene.contacts.push((Some(0), None, vertical(1.0), Vec3::x(), 0.4));
    scene.contacts.push((Some(0), None, vertical(0.0), -Vec3::x(), 0.4));
    let low = scene.add_box([0.0, 1.0], [0.0, 1.0], [3.0, 4.0]);
    for stacked in [false, true] {
        if stacked {
            let high = scene.add_box([0.0, 1.0], [0.0, 1.0], [4.0, 5.0]);
            scene.contacts.push((Some(low), Some(high), rectangle([0.0, 1.0], [0.0, 1.0], 4.0), Vec3::z(), 0.4));
        }
        let problem = scene.problem(&Vec3::x());
        for question in [LimitQuestion::Admissible(0.0), COLLAPSE] {
            assert_eq!(status(&problem, question), Status::NoEquilibrium);
            let second = solve_by_clarabel(&problem, question);
            assert_eq!(certified(&problem, &second, question).status, Status::NoEquilibrium);
        }
    }
}

/// Loads into the ground and loads on nothing but the ground are carried at every factor, without a self-stress.
#[test]
fn a_load_into_the_ground_is_unbounded() {
    let problem = cube().problem(&-Vec3::z());
    assert_eq!(status(&problem, COLLAPSE), Status::Unbounded);
    assert!(!solve(&problem, COLLAPSE).self_stress);
    let mut idle = cube().problem(&Vec3::x());
    idle.varying = vec![[0.0; 6]];
    assert_eq!(status(&idle, COLLAPSE), Status::Unbounded);
}

/// A cube between two walls jams: a self-stress strictly inside the cones makes every load carried. With one wall
/// the factor is finite: with associated flow at least μ √(1 + μ²), because friction on the ground presses the cube on it.
#[test]
fn a_jammed_cube_has_a_self_stress() {
    let mut jammed = cube();
    jammed.contacts.push((Some(0), None, vertical(1.0), Vec3::x(), 0.4));
    assert!(collapse(&jammed.problem(&Vec3::y())) > 0.4 * 1.16f64.sqrt());
    jammed.contacts.push((Some(0), None, vertical(0.0), -Vec3::x(), 0.4));
    jammed.contacts[0].2.iter_mut().for_each(|point| point.x = 0.5 * point.x + 0.25);
    let top = jammed.contacts[0].2.iter().map(|x| x + Vec3::z()).collect();
    jammed.contacts.push((Some(0), None, top, Vec3::z(), 0.4));
    for direction in [Vec3::x(), Vec3::y(), Vec3::z()] {
        let problem = jammed.problem(&direction);
        assert_eq!(status(&problem, COLLAPSE), Status::Unbounded);
        assert!(solve(&problem, COLLAPSE).self_stress);
        assert!(solve_by_clarabel(&problem, COLLAPSE).self_stress);
    }
}

/// Beside a jammed cube, which no mechanism moves, a free cube slides at μ; a cube on the jammed one does too.
#[test]
fn a_jammed_part_does_not_spoil_the_proof_of_the_rest() {
    let mut scene = cube();
    for (x, normal) in [(1.0, Vec3::x()), (0.0, -Vec3::x())] {
        scene.contacts.push((Some(0), None, vertical(x), normal, 0.4));
    }
    let top = [[0.0, 0.0], [0.5, 0.0], [0.5, 1.0], [0.0, 1.0]].map(|[x, y]| Vec3::new(x, y, 1.0)).to_vec();
    scene.contacts.push((Some(0), None, top, Vec3::z(), 0.4));
    let beside = scene.add_box([3.0, 4.0], [0.0, 1.0], [0.0, 1.0]);
    scene.contacts.push((None, Some(beside), rectangle([3.0, 4.0], [0.0, 1.0], 0.0), Vec3::z(), 0.4));
    let above = scene.add_box([0.5, 1.0], [0.0, 1.0], [1.0, 1.4]);
    scene.contacts.push((Some(0), Some(above), rectangle([0.5, 1.0], [0.0, 1.0], 1.0), Vec3::z(), 0.3));
    for (direction, expected) in [(Vec3::x(), 0.3), (Vec3::y(), 0.3)] {
        assert!((collapse(&scene.problem(&direction)) - expected).abs() < 1e-9);
    }
}

/// One mechanism is unique; two equal cubes that can move apart, and a block at the corner between two edges, have several.
#[test]
fn uniqueness_of_mechanisms() {
    let unique = |scene: &Scene, direction: Vec3| {
        let answer = solve(&scene.problem(&direction), COLLAPSE);
        assert_eq!(answer.status, Status::Collapse);
        answer.unique
    };
    let diagonal = Vec3::new(1.0, 1.0, 0.0);
    assert_eq!(unique(&cube(), Vec3::new(1.0, 0.3, 0.0)), Some(true));
    let mut tall = cube();
    tall.bodies[0].1.z = 2.0;
    assert_eq!(unique(&tall, Vec3::new(1.0, 0.3, 0.0)), Some(true));
    assert_eq!(unique(&tall, diagonal), Some(false));
    let mut two = cube();
    let other = two.add_box([3.0, 4.0], [0.0, 1.0], [0.0, 1.0]);
    two.contacts.push((None, Some(other), rectangle([3.0, 4.0], [0.0, 1.0], 0.0), Vec3::z(), 0.4));
    assert_eq!(unique(&two, Vec3::x()), Some(false));
    two.contacts[1].4 = 0.41;
    assert_eq!(unique(&two, Vec3::x()), Some(true));
}

/// Without friction a side wall presses only if the load pushes against it; it can carry no force before.
#[test]
fn contacts_that_cannot_be_loaded_do_not_spoil_the_proof() {
    let mut scene = cube();
    scene.contacts[0].4 = 0.0;
    assert_eq!(status(&scene.problem(&Vec3::x()), LimitQuestion::Admissible(0.0)), Status::Stands);
    scene.contacts.push((Some(0), None, vertical(1.0), Vec3::x(), 0.0));
    assert_eq!(status(&scene.problem(&Vec3::x()), LimitQuestion::Admissible(0.0)), Status::Stands);
    assert_eq!(status(&scene.problem(&-Vec3::x()), LimitQuestion::Admissible(0.1)), Status::NoEquilibrium);
    // The push at mid-height is met by the wall at the same height.
    assert_eq!(status(&scene.problem(&Vec3::x()), COLLAPSE), Status::Unbounded);
}

/// A block without contact falls; a block on an edge stands only if its weight is above the edge.
#[test]
fn loose_blocks_have_no_equilibrium() {
    let mut loose = cube();
    loose.add_box([2.0, 3.0], [0.0, 1.0], [0.0, 1.0]);
    assert_eq!(status(&loose.problem(&Vec3::x()), COLLAPSE), Status::NoEquilibrium);
    let mut edge = cube();
    edge.contacts[0].2 = vec![Vec3::new(0.2, 0.0, 0.0), Vec3::new(0.2, 1.0, 0.0)];
    assert_eq!(status(&edge.problem(&Vec3::x()), COLLAPSE), Status::NoEquilibrium);
}

/// Problems without bodies, and wrong ones, cause no panic.
#[test]
fn empty_and_wrong_problems_do_not_panic() {
    let empty = Scene::default().problem(&Vec3::x());
    assert_eq!(solve(&empty, COLLAPSE).status, Status::Unbounded);
    assert_eq!(solve(&empty, LimitQuestion::Admissible(1.0)).status, Status::Stands);
    let mut wrong = cube().problem(&Vec3::x());
    wrong.fixed[0][2] = f64::NAN;
    assert_eq!(solve(&wrong, COLLAPSE).status, Status::Stalled);
    wrong.fixed.clear();
    assert_eq!(solve(&wrong, COLLAPSE).status, Status::Stalled);
    let free = Scene { bodies: vec![(1.0, Vec3::zeros())], contacts: Vec::new() };
    assert_eq!(solve(&free.problem(&Vec3::x()), COLLAPSE).status, Status::NoEquilibrium);
}
