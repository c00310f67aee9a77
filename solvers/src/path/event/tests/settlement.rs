//! Supports that move: a block of weight W = 1 N on supports that are separate bodies.

use crate::path::two_blocks::{
    STIFFNESS, assert_close, between, block, force, ground, point, rigid, scene, settlement, stage, states, traced, v,
};
use voussoir_core::limit::Status;
use voussoir_core::path::{ContactEvent, LoadStepEnd, Loading, PathProblem};

/// The block on supports at the given places, body 0 first, then 2, 3, … A stage moves them.
fn supported(places: &[f64], friction: f64, moved: Loading) -> PathProblem {
    let up = v(0.0, 1.0);
    let support = |k: usize| if k == 0 { 0 } else { k + 1 };
    let at = |(k, x): (usize, &f64)| between(support(k), 1, point(k, v(*x, 0.0), up, friction, 0.0));
    let contacts = places.iter().enumerate().map(at).collect();
    let mut bodies = vec![ground(), rigid(v(0.5, 0.5))];
    bodies.resize(places.len() + 1, ground());
    let weight = stage(0, force(v(0.5, 0.5), -up), LoadStepEnd::Factor(1.0));
    scene(bodies, contacts, vec![weight, stage(1, moved, LoadStepEnd::Factor(1.0))])
}

/// A ground that moves and turns as a whole leaves all forces as they are.
#[test]
fn a_rigid_motion_of_the_ground_changes_no_force() {
    let mut problem = block(0.5, settlement(0, [3e-4, -2e-4, 5e-4]));
    problem.load_steps[1].end = LoadStepEnd::Factor(1.0);
    let answer = traced(&problem);
    assert_eq!((answer.status, answer.factor), (Status::Stands, Some(1.0)), "{:?}", answer.notes);
    for r in &answer.state.force {
        assert_close(r[0], 0.5, 1e-11);
        assert_close(r[1], 0.0, 1e-11);
    }
}

/// If one of two supports sinks by δ, the block turns by −δ/b, and each support keeps W/2.
#[test]
fn a_sinking_support_turns_a_determinate_block() {
    let sunk = 1e-3;
    let answer = traced(&supported(&[0.0, 1.0], 0.5, settlement(2, [0.0, -sunk, 0.0])));
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    assert_close(answer.state.motion[1][2], -sunk, 1e-12);
    answer.state.force.iter().for_each(|r| assert_close(r[0], 0.5, 1e-11));
}

/// Supports that spread by δ hold the block by k δ/2 each, two springs in series.
#[test]
fn spreading_supports_pull_by_their_stiffness() {
    let spread = 1e-5;
    let answer = traced(&supported(&[0.0, 1.0], 0.5, settlement(2, [spread, 0.0, 0.0])));
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    // t points to the left: the left support pulls to the left, the right one to the right.
    assert_close(answer.state.force[0][1], 0.5 * STIFFNESS * spread, 1e-12);
    assert_close(answer.state.force[1][1], -0.5 * STIFFNESS * spread, 1e-12);
}

/// Supports that spread slip at k δ/2 = μ W/2, both at once, and hold μ W/2 from then on.
#[test]
fn spreading_supports_slip_at_the_friction() {
    let (friction, spread) = (0.5, 2e-4);
    let answer = traced(&supported(&[0.0, 1.0], friction, settlement(2, [spread, 0.0, 0.0])));
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    assert_close(answer.state.force[0][1].abs(), 0.5 * friction, 1e-12);
    let slips = answer
        .events
        .iter()
        .filter(|event| matches!(event.what, ContactEvent::SlipsForward | ContactEvent::SlipsBackward));
    let slips: Vec<f64> = slips.map(|event| event.factor * spread).collect();
    assert!(!slips.is_empty(), "{:?}", answer.events);
    slips.iter().for_each(|slip| assert_close(*slip, friction / STIFFNESS, 1e-15));
}

/// If the middle one of three supports sinks by δ, it keeps N = W/3 − 2 k δ/3.
#[test]
fn a_sinking_middle_support_is_relieved_by_stiffness() {
    let sunk = 2e-5;
    let answer = traced(&supported(&[0.0, 0.5, 1.0], 0.5, settlement(2, [0.0, -sunk, 0.0])));
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    let middle = 1.0 / 3.0 - 2.0 / 3.0 * STIFFNESS * sunk;
    assert_close(answer.state.force[1][0], middle, 1e-12);
    assert_close(answer.state.force[0][0], 0.5 * (1.0 - middle), 1e-12);
}

/// The middle support is free from δ = W/(2 k) on, and the outer ones carry W/2.
#[test]
fn a_middle_support_that_sinks_far_opens() {
    let sunk = 1e-3;
    let answer = traced(&supported(&[0.0, 0.5, 1.0], 0.5, settlement(2, [0.0, -sunk, 0.0])));
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    let opens = answer.events.iter().find(|e| e.what == ContactEvent::Opens).expect("it opens");
    assert_eq!(opens.contact, 1);
    assert_close(opens.factor * sunk, 0.5 / STIFFNESS, 1e-14);
    assert_close(answer.state.force[0][0], 0.5, 1e-11);
    assert_close(answer.state.gap[1][0], sunk - 0.5 / STIFFNESS, 1e-12);
}

/// A support that sinks by δ under W/2 does the work −W δ/2, and the weight does W δ/2: nothing more is stored.
#[test]
fn a_sinking_support_does_the_work_of_its_reaction() {
    let all = states(&supported(&[0.0, 1.0], 0.5, settlement(2, [0.0, -1e-3, 0.0])));
    let [.., end] = &all[..] else { panic!("no state") };
    let before = all.iter().rfind(|state| state.load_step == 0).expect("a state under weight");
    assert_close(end.work - before.work, 0.0, 1e-14);
    assert_close(end.stored - before.stored, 0.0, 1e-14);
}
