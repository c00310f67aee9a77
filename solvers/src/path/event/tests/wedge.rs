//! Blocks on inclined faces, at walls and under a ceiling.

use crate::path::two_blocks::{
    STIFFNESS, assert_close, block, dead, force, ground, live, point, rigid, scene, stage, traced, v,
};
use voussoir_core::limit::Status;
use voussoir_core::path::{ContactEvent, LoadStep, LoadStepEnd, PathProblem};

/// A block on two points of a plane with the inclination α, under its weight, whose centre is 0.2 m above the plane.
fn on_incline(angle: f64, friction: f64, then: Option<LoadStep>) -> PathProblem {
    let (normal, along) = (v(-angle.sin(), angle.cos()), v(angle.cos(), angle.sin()));
    let centre = normal * 0.2;
    let contacts = [-0.5, 0.5].map(|s| point(0, along * s, normal, friction, 0.0)).to_vec();
    let weight = dead(force(centre, v(0.0, -1.0)));
    scene(vec![ground(), rigid(centre)], contacts, [weight].into_iter().chain(then).collect())
}

/// A block rests on a plane of inclination α if tan α < μ.
#[test]
fn a_block_stands_on_a_gentle_incline() {
    let answer = traced(&on_incline(0.3, 0.32, None));
    assert_eq!((answer.status, answer.factor), (Status::Stands, Some(1.0)), "{:?}", answer.notes);
}

/// If tan α > μ, no equilibrium under its weight exists.
#[test]
fn a_block_slides_down_a_steep_incline() {
    let answer = traced(&on_incline(0.3, 0.3, None));
    assert_eq!(answer.status, Status::NoEquilibrium, "{:?}", answer.notes);
    // It moves down the plane, and its weight does work.
    let motion = answer.motion.expect("a mechanism")[1];
    assert!(motion[0] < 0.0 && motion[1] < 0.0, "{motion:?}");
    assert_close(motion[1] / motion[0], 0.3f64.tan(), 1e-9);
}

/// A pull up the plane of inclination α moves the block at λ = W (sin α + μ cos α).
#[test]
fn a_pull_up_the_incline_overcomes_weight_and_friction() {
    let (angle, friction) = (0.3f64, 0.4);
    let pulled = live(force(v(0.0, 0.0), v(angle.cos(), angle.sin())));
    let answer = traced(&on_incline(angle, friction, Some(pulled)));
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), angle.sin() + friction * angle.cos(), 1e-12);
}

/// A pull down the plane moves it at λ = W (μ cos α − sin α).
#[test]
fn a_pull_down_the_incline_needs_what_friction_leaves() {
    let (angle, friction) = (0.3f64, 0.4);
    let pulled = live(force(v(0.0, 0.0), v(-angle.cos(), -angle.sin())));
    let answer = traced(&on_incline(angle, friction, Some(pulled)));
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), friction * angle.cos() - angle.sin(), 1e-12);
}

/// A wedge pressed by P between two walls whose normals rise by β carries N = P/(2 (sin β + μ cos β)) at each wall as it slips.
#[test]
fn a_wedge_presses_its_walls_apart() {
    let (rise, friction) = (0.35f64, 0.3);
    let normals = [v(rise.cos(), rise.sin()), v(-rise.cos(), rise.sin())];
    let at = |k: usize, s: f64| {
        let normal = normals[k];
        // Up along the wall.
        let along = v(-normal.x.signum() * rise.sin(), rise.cos());
        point(k, v(-normal.x.signum() * 0.5, 0.0) + along * s, normal, friction, 0.0)
    };
    let contacts = vec![at(0, -0.25), at(0, 0.25), at(1, -0.25), at(1, 0.25)];
    let pressed = stage(0, force(v(0.0, 0.5), v(0.0, -1.0)), LoadStepEnd::Factor(1.0));
    let answer = traced(&scene(vec![ground(), rigid(v(0.0, 0.0))], contacts, vec![pressed]));
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    let wall = |c: usize| answer.state.force[c][0] + answer.state.force[c + 1][0];
    let right = 0.5 / (rise.sin() + friction * rise.cos());
    assert_close(wall(0), right, 1e-12);
    assert_close(wall(2), right, 1e-12);
}

/// A wall at a distance d from the foot of a block is reached at λ = 2 k d. It then carries a third of the further load.
#[test]
fn a_gap_closes_and_shares_the_load() {
    let (gap, factor) = (1e-5, 0.25);
    let mut problem = block(0.9, force(v(0.0, 0.0), v(1.0, 0.0)));
    problem.contacts.push(point(1, v(1.0, 0.0), v(-1.0, 0.0), 0.0, gap));
    problem.load_steps[1].end = LoadStepEnd::Factor(factor);
    let answer = traced(&problem);
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    let [closes] = &answer.events[..] else { panic!("{:?}", answer.events) };
    assert_eq!((closes.contact, closes.what), (2, ContactEvent::Closes));
    assert_close(closes.factor, 2.0 * STIFFNESS * gap, 1e-12);
    assert_close(answer.state.force[2][0], (factor - 2.0 * STIFFNESS * gap) / 3.0, 1e-12);
}

/// A block that slides until it meets a wall is no collapse: the wall then carries any load.
#[test]
fn a_mechanism_that_meets_a_wall_is_no_collapse() {
    let mut problem = block(0.3, force(v(0.0, 0.0), v(1.0, 0.0)));
    problem.contacts.push(point(1, v(1.0, 0.0), v(-1.0, 0.0), 0.0, 1e-3));
    let answer = traced(&problem);
    assert_eq!(answer.status, Status::Unbounded, "{:?}", answer.notes);
    assert_close(answer.ray.expect("a ray")[2][0], 1.0, 1e-12);
    let closes = answer.events.iter().find(|event| event.what == ContactEvent::Closes).expect("it closes");
    assert_close(closes.factor, 0.3, 1e-12);
}

/// A block under a ceiling without tensile strength falls: no equilibrium at λ = 0.
#[test]
fn a_block_under_a_ceiling_falls() {
    let contacts = [0.0, 1.0].map(|x| point(0, v(x, 1.0), v(0.0, -1.0), 0.5, 0.0)).to_vec();
    let weight = dead(force(v(0.5, 0.5), v(0.0, -1.0)));
    let answer = traced(&scene(vec![ground(), rigid(v(0.5, 0.5))], contacts, vec![weight]));
    assert_eq!(answer.status, Status::NoEquilibrium, "{:?}", answer.notes);
    assert!(answer.motion.expect("a mechanism")[1][1] < 0.0);
}
