//! Two blocks of 1 m by 1 m and W = 1 N each on top of each other.

use crate::path::two_blocks::{assert_close, forces, stack, traced, v};
use voussoir_core::limit::Status;
use voussoir_core::path::Loading;

fn pushed(body: usize, height: f64) -> Loading {
    forces(&[(body, v(0.0, height), v(1.0, 0.0))])
}

/// A push on the upper block slides the weaker joint: λ = min(2 μ₀ W, μ₁ W).
#[test]
fn a_push_on_the_upper_block_slides_the_weaker_joint() {
    for [lower, upper] in [[0.1, 0.4], [0.3, 0.4], [0.3, 0.7], [0.2, 0.3]] {
        let answer = traced(&stack([lower, upper], pushed(2, 1.0)));
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert_close(answer.factor.expect("a factor"), f64::min(2.0 * lower, upper), 1e-12);
    }
}

/// If the upper joint slides, the lower block rests; if the lower one slides, both blocks move with v = 1.
#[test]
fn the_mechanism_is_that_of_the_weaker_joint() {
    for ([lower, upper], below) in [([0.3, 0.4], 0.0), ([0.1, 0.4], 1.0)] {
        let motion = traced(&stack([lower, upper], pushed(2, 1.0))).motion.expect("a mechanism");
        assert_close(motion[1][0], below, 1e-9);
        assert_close(motion[2][0], 1.0, 1e-9);
    }
}

/// A push on the lower block carries the upper one along, whatever its friction: λ = 2 μ₀ W.
#[test]
fn a_push_on_the_lower_block_carries_the_upper_one() {
    for upper in [0.05, 0.1, 0.8] {
        let answer = traced(&stack([0.2, upper], pushed(1, 0.1)));
        assert_eq!(answer.status, Status::Collapse, "{upper}: {:?}", answer.notes);
        assert_close(answer.factor.expect("a factor"), 0.4, 1e-12);
    }
}

/// A block that rests on a joint without friction is free to slide, but no load moves it: λ = 2 μ₀ W of the joint below.
#[test]
fn a_motion_on_which_the_load_does_no_work_is_no_mechanism() {
    let answer = traced(&stack([0.2, 0.0], pushed(1, 0.1)));
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 0.4, 1e-12);
}

/// Pushed at height H, both blocks tip at λ = 2 W b/(2 H) or the upper one at W b/(2 (H − 1 m)): at H = 2 m at the same load,
/// below it the whole stack first.
#[test]
fn the_whole_stack_tips_before_its_upper_block() {
    for height in [1.25, 1.5, 1.9] {
        let answer = traced(&stack([2.0, 2.0], pushed(2, height)));
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert_close(answer.factor.expect("a factor"), f64::min(1.0 / height, 0.5 / (height - 1.0)), 1e-12);
    }
}

/// A stack that is pressed at the top carries any load: the ray is half of it at each corner of both joints.
#[test]
fn a_pressed_stack_has_a_ray() {
    let answer = traced(&stack([0.2, 0.2], forces(&[(2, v(0.5, 2.0), v(0.0, -1.0))])));
    assert_eq!(answer.status, Status::Unbounded, "{:?}", answer.notes);
    for r in answer.ray.expect("a ray") {
        assert_close(r[0], 0.5, 1e-12);
        assert_close(r[1], 0.0, 1e-12);
    }
}
