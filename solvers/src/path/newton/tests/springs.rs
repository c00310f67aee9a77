//! A block on two springs of stiffness k at a distance of 1 m that keep their directions: with φ its rotation to the right,
//! they store k |u|² + ½ k (1 − cos φ). A dead load P at height H and a push F there give tan φ = F H/(½ k − P H).

use crate::path::newton::NewtonPath;
use crate::path::two_blocks::{assert_close, finite, followed, force, on_springs, stage, strategies, v};
use voussoir_core::limit::Status;
use voussoir_core::path::{LoadStepEnd, PathProblem, PathSolver, PathState, Unobserved};

const SPRING: f64 = 20.0;
const HEIGHT: f64 = 0.8;

/// Pressed by P, then pushed by F.
fn pressed_and_pushed(pressed: f64, pushed: f64) -> PathProblem {
    let at = v(0.0, HEIGHT);
    let press = stage(0, force(at, v(0.0, -1.0)), LoadStepEnd::Factor(pressed));
    on_springs(SPRING, vec![press, stage(1, force(at, v(1.0, 0.0)), LoadStepEnd::Factor(pushed))])
}

/// The last state, which stands.
fn end(problem: &PathProblem) -> PathState {
    let answer = followed(problem, None);
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    answer.state
}

/// tan φ of the state.
fn tangent(pressed: f64, pushed: f64) -> f64 {
    pushed * HEIGHT / (0.5 * SPRING - pressed * HEIGHT)
}

/// tan φ = 2 F H/k of a push alone, whose direction does not change, up to rotations of 50°.
#[test]
fn a_dead_push_turns_by_the_arc_tangent() {
    for pushed in [1.0, 5.0, 15.0] {
        assert_close(-end(&pressed_and_pushed(1e-9, pushed)).motion[1][2].tan(), tangent(0.0, pushed), 1e-6);
    }
}

/// A load P at the height H softens the rotation: tan φ = F H/(½ k − P H).
#[test]
fn a_vertical_load_softens_the_rotation() {
    for pressed in [2.0, 5.0, 10.0] {
        let found = -end(&pressed_and_pushed(pressed, 3.0)).motion[1][2].tan();
        assert_close(found, tangent(pressed, 3.0), 1e-9);
    }
}

/// A load that pulls upwards stiffens it, by the same formula with P < 0.
#[test]
fn an_upward_load_stiffens_the_rotation() {
    let found = -end(&pressed_and_pushed(-10.0, 3.0)).motion[1][2].tan();
    assert_close(found, tangent(-10.0, 3.0), 1e-9);
}

/// The middle between the springs moves by (F, −P)/(2 k), whatever the rotation.
#[test]
fn the_springs_take_the_forces_without_rotation() {
    let state = end(&pressed_and_pushed(5.0, 3.0));
    assert_close(state.motion[1][0], 3.0 / (2.0 * SPRING), 1e-10);
    assert_close(state.motion[1][1], -5.0 / (2.0 * SPRING), 1e-10);
}

/// Stored energy k |u|² + ½ k (1 − cos φ).
#[test]
fn the_stored_energy_is_that_of_the_springs() {
    let state = end(&pressed_and_pushed(5.0, 3.0));
    let turned = tangent(5.0, 3.0).atan();
    let right = (9.0 + 25.0) / (4.0 * SPRING) + 0.5 * SPRING * (1.0 - turned.cos());
    assert_close(state.stored, right, 1e-9);
}

/// The load's displacement is F/(2 k) + H sin φ.
#[test]
fn the_displacement_of_the_load_follows_its_point() {
    let state = end(&pressed_and_pushed(5.0, 3.0));
    let right = 3.0 / (2.0 * SPRING) + HEIGHT * tangent(5.0, 3.0).atan().sin();
    assert_close(state.displacement, right, 1e-9);
}

/// All strategies reach the same state at the target.
#[test]
fn strategies_reach_the_same_state() {
    for strategy in strategies() {
        let answer = followed(&pressed_and_pushed(5.0, 3.0), strategy);
        assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
        assert_close(-answer.state.motion[1][2].tan(), tangent(5.0, 3.0), 1e-9);
    }
}

/// The second-order work of the pressed block is positive if P H < ½ k.
#[test]
fn a_pressed_block_is_stable_below_its_buckling_load() {
    let mut problem = pressed_and_pushed(0.9 * 0.5 * SPRING / HEIGHT, 0.0);
    problem.load_steps.truncate(1);
    let answer = NewtonPath {}.trace(&problem, &finite(None), &mut Unobserved);
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    assert_eq!(answer.stability[0].under_load, Some(true), "{:?}", answer.stability);
}

/// At P = ½ k/H the pressed block buckles to either side: beyond this bifurcation the load does not grow.
#[test]
fn a_pressed_block_buckles_at_its_critical_load() {
    let critical = 0.5 * SPRING / HEIGHT;
    let mut problem = pressed_and_pushed(1.04 * critical, 0.0);
    problem.load_steps.truncate(1);
    let answer = followed(&problem, None);
    assert_eq!(answer.status, Status::LimitPoint, "{:?}", answer.notes);
    assert_close(answer.state.factor, critical, 1e-6 * critical);
    let [branching] = &answer.branchings[..] else { panic!("{:?}", answer.branchings) };
    assert!(branching.twins && !branching.snaps, "{branching:?}");
    assert_close(branching.factor, critical, 1e-6 * critical);
}
