//! A ground that turns under a block of 1 m by 1 m and weight W: it slides or tips at a slope that statics give.

use crate::path::two_blocks::{STIFFNESS, assert_close, block, followed, force, live, settlement, stage, v};
use voussoir_core::limit::Status;
use voussoir_core::path::{LoadStepEnd, PathProblem};

/// Radians that the ground turns per unit of the factor.
fn tilted(friction: f64, target: f64) -> PathProblem {
    let mut problem = block(friction, settlement(0, [0.0, 0.0, 1.0]));
    problem.load_steps[1].end = LoadStepEnd::Factor(target);
    problem
}

/// Below tan α = μ the block stands, and the joint carries W cos α and W sin α.
#[test]
fn a_tilted_block_stands_below_its_friction() {
    let angle = 0.25f64;
    let answer = followed(&tilted(0.3, angle), None);
    assert_eq!((answer.status, answer.factor), (Status::Stands, Some(angle)), "{:?}", answer.notes);
    let sum = |k: usize| answer.state.force.iter().map(|r| r[k]).sum::<f64>();
    // The ground turns to the left: friction pushes the block up the slope, to the right.
    assert_close(sum(0), angle.cos(), 1e-9);
    assert_close(sum(1), -angle.sin(), 1e-9);
}

/// The slope cannot exceed tan α = μ, where the block slides on with the ground at rest.
#[test]
fn a_tilted_block_slides_at_its_friction() {
    let answer = followed(&tilted(0.3, 1.0), None);
    assert_ne!(answer.status, Status::Stands, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 0.3f64.atan(), 1e-9);
}

/// With much friction the block tips about its lower corner, when the centre is above it: α + δ = 45°, where δ is the
/// turn by the compression of that corner, sin δ = W cos α/(k b).
#[test]
fn a_tilted_block_tips_at_45_degrees() {
    let answer = followed(&tilted(2.0, 1.0), None);
    assert_eq!(answer.status, Status::LimitPoint, "{:?}", answer.notes);
    let mut angle = std::f64::consts::FRAC_PI_4;
    for _ in 0..50 {
        angle = std::f64::consts::FRAC_PI_4 - (angle.cos() / STIFFNESS).asin();
    }
    assert_close(answer.factor.expect("a factor"), angle, 1e-9);
}

/// On a slope of α a push along the ground moves the block at λ = W (μ cos α + sin α) up the slope.
#[test]
fn a_push_up_the_slope_overcomes_weight_and_friction() {
    let (angle, friction) = (0.2f64, 0.4);
    let mut problem = tilted(friction, angle);
    let up = v(angle.cos(), angle.sin());
    problem.load_steps.push(stage(2, force(v(0.0, 0.0), up), live(force(v(0.0, 0.0), up)).end));
    let answer = followed(&problem, None);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), friction * angle.cos() + angle.sin(), 1e-9);
}
