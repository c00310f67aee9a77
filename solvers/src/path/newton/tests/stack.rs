//! Two blocks of 1 m by 1 m and W = 1 N each on top of each other, with finite displacements.

use crate::path::two_blocks::{STIFFNESS, assert_close, followed, forces, stack, v};
use voussoir_core::limit::Status;
use voussoir_core::path::{Loading, PathAnswer};

fn pushed(height: f64) -> Loading {
    forces(&[(2, v(0.0, height), v(1.0, 0.0))])
}

fn collapse(friction: [f64; 2], height: f64) -> PathAnswer {
    let answer = followed(&stack(friction, pushed(height)), None);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    answer
}

/// If the lower block has turned by φ to the right, the upper one slides on it at λ = W tan(atan μ − φ).
#[test]
fn the_upper_block_slides_earlier_on_a_face_that_has_turned() {
    let friction = 0.6f64;
    let answer = collapse([0.9, friction], 1.0);
    let turned = -answer.state.motion[1][2];
    assert!(turned > 1.0 / STIFFNESS, "{turned}");
    assert_close(answer.limit_points[0].factor, (friction.atan() - turned).tan(), 1e-9);
}

/// The floor does not turn: the whole stack slides at λ = 2 μ W.
#[test]
fn the_stack_slides_on_the_floor() {
    let answer = collapse([0.2, 0.9], 1.0);
    assert_close(answer.factor.expect("a factor"), 0.4, 1e-9);
}

/// The stack tips as a whole below 2 W b/(2 H), by a share of order W/(k b).
#[test]
fn the_stack_tips_below_the_load_of_rigid_blocks() {
    for height in [1.25, 1.9] {
        let rigid = 1.0 / height;
        let found = collapse([0.95, 0.95], height).factor.expect("a factor");
        assert!(found < rigid && found > rigid * (1.0 - 20.0 / STIFFNESS), "{found} {rigid}");
    }
}

/// At the limit point of tipping the left corner of the floor is idle, and the right one carries both blocks.
#[test]
fn the_right_corner_carries_the_stack_at_its_limit_point() {
    let state = collapse([0.95, 0.95], 1.25).state;
    assert_close(state.force[0][0], 0.0, 1e-9);
    assert_close(state.force[1][0], 2.0, 1e-9);
}
