//! A block of weight W = 1 N that is pushed over a floor with friction μ: slip, its events and its mechanism.

use crate::path::two_blocks::{
    STIFFNESS, assert_close, block, block_on, coulomb, force, live, pushed_at, stage, states, traced, v,
};
use voussoir_core::limit::Status;
use voussoir_core::path::{ContactEvent, LoadStepEnd};

const FRICTION: f64 = 0.3;

/// A block slides at λ = μ W.
#[test]
fn a_block_slides_at_its_friction() {
    let answer = traced(&block(FRICTION, pushed_at(0.1)));
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), FRICTION, 1e-12);
}

/// A force that lifts at an angle α slides the block at λ = μ W / (cos α + μ sin α).
#[test]
fn a_lifting_force_slides_the_block_earlier() {
    for angle in [0.2, 0.5, 1.0f64] {
        let answer = traced(&block(FRICTION, force(v(0.5, 0.0), v(angle.cos(), angle.sin()))));
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        let right = FRICTION / (angle.cos() + FRICTION * angle.sin());
        assert_close(answer.factor.expect("a factor"), right, 1e-12);
    }
}

/// A force that presses at an angle α with tan α < 1/μ slides the block at λ = μ W / (cos α − μ sin α).
#[test]
fn a_pressing_force_slides_the_block_later() {
    for angle in [0.2, 0.5, 1.0f64] {
        let answer = traced(&block(FRICTION, force(v(0.5, 0.0), v(angle.cos(), -angle.sin()))));
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        let right = FRICTION / (angle.cos() - FRICTION * angle.sin());
        assert_close(answer.factor.expect("a factor"), right, 1e-12);
    }
}

/// A force inside the friction cone, tan α > 1/μ, is carried without limit, and the ray is in balance with it.
#[test]
fn a_force_inside_the_friction_cone_is_carried_without_limit() {
    let angle = 1.4f64;
    let answer = traced(&block(FRICTION, force(v(0.5, 0.0), v(angle.cos(), -angle.sin()))));
    assert_eq!(answer.status, Status::Unbounded, "{:?}", answer.notes);
    let ray = answer.ray.expect("a ray");
    // t points to the left.
    assert_close(ray.iter().map(|r| r[0]).sum(), angle.sin(), 1e-12);
    assert_close(ray.iter().map(|r| r[1]).sum(), angle.cos(), 1e-12);
}

/// Slip without dilatancy moves the block along the floor: q̇ = (1, 0, 0) with p·q̇ = 1.
#[test]
fn the_mechanism_of_sliding_is_a_translation() {
    let answer = traced(&block(FRICTION, pushed_at(0.1)));
    let motion = answer.motion.expect("a mechanism");
    [1.0, 0.0, 0.0].iter().zip(motion[1]).for_each(|(right, found)| assert_close(found, *right, 1e-9));
}

/// Associated slip lifts the block by μ per unit of slip: q̇ = (1, μ, 0) under a force along the floor.
#[test]
fn the_mechanism_of_associated_sliding_rises_with_the_friction() {
    let answer = traced(&block_on(&[0.0, 1.0], &coulomb(FRICTION, 0.0, FRICTION), live(pushed_at(0.1))));
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), FRICTION, 1e-12);
    let motion = answer.motion.expect("a mechanism");
    [1.0, FRICTION, 0.0].iter().zip(motion[1]).for_each(|(right, found)| assert_close(found, *right, 1e-9));
}

/// Cohesion c on an area A of both points adds to friction: λ = μ W + c A.
#[test]
fn cohesion_adds_to_friction() {
    let cohesion = 0.05;
    let answer = traced(&block_on(&[0.0, 1.0], &coulomb(FRICTION, cohesion, 0.0), live(pushed_at(0.1))));
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), FRICTION + 2.0 * cohesion, 1e-12);
}

/// Pushed at height h, the left corner slips first, at λ/2 = μ (W/2 − λ h).
#[test]
fn the_unloaded_corner_slips_first() {
    let height = 0.4;
    let answer = traced(&block(FRICTION, pushed_at(height)));
    let first = answer.events.first().expect("an event");
    // t points to the left.
    assert_eq!((first.contact, first.what), (0, ContactEvent::SlipsBackward));
    assert_close(first.factor, FRICTION / (1.0 + 2.0 * FRICTION * height), 1e-12);
}

/// Between the two slips the load moves by u = (λ − μ (W/2 − λ h))/k + 2 λ h²/k.
#[test]
fn the_displacement_with_one_corner_slipping() {
    let (height, factor) = (0.4, 0.28);
    let pushed = stage(1, pushed_at(height), LoadStepEnd::Factor(factor));
    let answer = traced(&block_on(&[0.0, 1.0], &coulomb(FRICTION, 0.0, 0.0), pushed));
    assert_eq!((answer.status, answer.factor), (Status::Stands, Some(factor)), "{:?}", answer.notes);
    let slipping = FRICTION * (0.5 - factor * height);
    let right = ((factor - slipping) + 2.0 * factor * height * height) / STIFFNESS;
    assert_close(answer.state.displacement, right, 1e-12 * right);
}

/// After unloading, the corner that slipped keeps a force: t = μ (W/2 − λ h) − λ/2, the other one the opposite.
#[test]
fn a_slip_leaves_forces_behind() {
    let (height, factor) = (0.4, 0.28);
    let mut problem = block(FRICTION, pushed_at(height));
    problem.load_steps[1].end = LoadStepEnd::Factor(factor);
    problem.load_steps.push(stage(2, force(v(0.0, height), v(-1.0, 0.0)), LoadStepEnd::Factor(factor)));
    let answer = traced(&problem);
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    let kept = FRICTION * (0.5 - factor * height) - 0.5 * factor;
    assert_close(answer.state.force[0][1], kept, 1e-12);
    assert_close(answer.state.force[1][1], -kept, 1e-12);
}

/// A load that goes from 0 to λ < −μ W slides the block to the other side, at λ = −μ W.
#[test]
fn a_falling_load_slides_the_block_back() {
    let mut problem = block(FRICTION, pushed_at(0.1));
    problem.load_steps[1].end = LoadStepEnd::Factor(-1.0);
    let answer = traced(&problem);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), -FRICTION, 1e-12);
}

/// A second stage continues from the first: pushed by λ₁, the block slides at λ₂ = μ W − λ₁.
#[test]
fn stages_of_the_same_load_add_up() {
    let mut problem = block(FRICTION, pushed_at(0.1));
    problem.load_steps[1].end = LoadStepEnd::Factor(0.2);
    problem.load_steps.push(stage(2, pushed_at(0.1), LoadStepEnd::Collapse(f64::INFINITY)));
    let answer = traced(&problem);
    assert_eq!((answer.status, answer.load_step), (Status::Collapse, 2), "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), FRICTION - 0.2, 1e-12);
}

/// More weight P in a stage before the push raises the load: λ = μ (W + P).
#[test]
fn a_weight_added_before_raises_the_load() {
    let mut problem = block(FRICTION, force(v(0.5, 1.0), v(0.0, -1.0)));
    problem.load_steps[1].end = LoadStepEnd::Factor(2.0);
    problem.load_steps.push(stage(2, pushed_at(0.1), LoadStepEnd::Collapse(f64::INFINITY)));
    let answer = traced(&problem);
    assert_close(answer.factor.expect("a factor"), FRICTION * 3.0, 1e-12);
}

/// Before any slip forces and motions are in proportion to the load: the state at λ/2 is halfway.
#[test]
fn an_elastic_path_is_straight() {
    let at = |factor: f64| {
        let mut problem = block(FRICTION, pushed_at(0.4));
        problem.load_steps[1].end = LoadStepEnd::Factor(factor);
        states(&problem).pop().expect("a state")
    };
    let [start, half, whole] = [1e-9, 0.1, 0.2].map(at);
    for c in 0..2 {
        for k in 0..2 {
            assert_close(half.force[c][k], 0.5 * (start.force[c][k] + whole.force[c][k]), 1e-9);
        }
    }
}
