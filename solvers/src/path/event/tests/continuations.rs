//! Continuations that are not unique, and the events with which a mechanism begins.

use crate::path::two_blocks::{
    assert_close, between, block, dead, forces, ground, live, point, pushed_at, rigid, scene, traced, v,
};
use voussoir_core::limit::Status;
use voussoir_core::path::{ContactEvent, LoadStep, PathProblem};

/// Two equal blocks side by side on a floor, not in touch, each pushed by the same force.
fn two_equal_blocks() -> PathProblem {
    let (up, right) = (v(0.0, 1.0), v(1.0, 0.0));
    let corners =
        |body: usize, x: f64| [x, x + 1.0].map(|x| between(0, body, point(body - 1, v(x, 0.0), up, 0.3, 0.0)));
    let centres = [v(0.5, 0.5), v(3.5, 0.5)];
    let weights = forces(&[(1, centres[0], -up), (2, centres[1], -up)]);
    let pushed = forces(&[(1, v(0.0, 0.1), right), (2, v(3.0, 0.1), right)]);
    let bodies = vec![ground(), rigid(centres[0]), rigid(centres[1])];
    let contacts = [corners(1, 0.0), corners(2, 3.0)].concat();
    scene(bodies, contacts, vec![LoadStep { gravity: false, ..dead(weights) }, live(pushed)])
}

/// Two blocks that may slide, each alone, are twins: one of them slides at μ W, and the answer lists the branch.
#[test]
fn one_of_two_equal_blocks_slides_and_the_other_is_its_twin() {
    let answer = traced(&two_equal_blocks());
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 0.3, 1e-12);
    assert!(answer.branchings.iter().any(|branching| branching.twins), "{:?}", answer.branchings);
    let speeds: Vec<f64> = answer.motion.expect("a mechanism").iter().map(|body| body[0]).collect();
    assert!(speeds[1].abs().min(speeds[2].abs()) < 1e-9 && speeds[1].abs().max(speeds[2].abs()) > 0.5, "{speeds:?}");
}

/// The slip with which a mechanism begins is an event at the collapse load; t points to the left.
#[test]
fn the_last_slip_is_listed() {
    let answer = traced(&block(0.3, pushed_at(0.1)));
    let last = answer.events.last().expect("an event");
    assert_eq!((last.what, last.load_step), (ContactEvent::SlipsBackward, 1), "{:?}", answer.events);
    assert_close(last.factor, 0.3, 1e-12);
}
