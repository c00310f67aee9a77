//! Steps along a piece: a block of 1 N on two points that is pushed at height h, and one on two bonded springs.

use super::super::advance::{Advance, StepEnd, Watched, advance, between, first_crossing, state_at};
use super::{Piece, State, StepSystem, piece_at, second_step};
use crate::path::newton::pieces::monitors::{Reading, What};
use crate::path::two_blocks::{STIFFNESS, assert_close, block, force, on_springs, pushed_at, stage, v};
use voussoir_core::path::{LoadStepEnd, PathProblem};

const FRICTION: f64 = 0.3;
const HEIGHT: f64 = 0.4;
const UNWATCHED: Watched = Watched { sense: None, target: None };

/// Load on two springs at a rotation φ to the right: λ = ½ (k − W) sin φ/(h cos φ + ½ sin φ).
fn load(turned: f64) -> f64 {
    0.5 * (STIFFNESS - 1.0) * turned.sin() / (HEIGHT * turned.cos() + 0.5 * turned.sin())
}

/// A block on soft springs, pressed by 1 N and pushed by λ at the height of 0.8 m.
fn soft() -> PathProblem {
    let at = v(0.0, 0.8);
    let load = |k: usize, direction| stage(k, force(at, direction), LoadStepEnd::Factor(1.0));
    on_springs(20.0, vec![load(0, v(0.0, -1.0)), load(1, v(1.0, 0.0))])
}

/// Motions and factor of a piece's tangent have the size 1 in units.
#[test]
fn the_row_of_a_piece_has_unit_size() {
    let problem = block(FRICTION, pushed_at(HEIGHT));
    let (mut system, state) = second_step(&problem);
    let piece = piece_at(&mut system, &state);
    assert_close(piece.row.iter().map(|x| x * x).sum(), 1.0, 1e-12);
    assert_close(piece.row[piece.row.len() - 1], piece.tangent.factor / system.units().factor, 1e-12);
}

/// A step without an event ends on the exact curve λ(φ).
#[test]
fn a_whole_step_ends_on_the_curve() {
    let problem = block(FRICTION, pushed_at(HEIGHT));
    let (mut system, state) = second_step(&problem);
    let piece = piece_at(&mut system, &state);
    let length = 0.1 * system.units().factor / piece.tangent.factor;
    let Advance::Whole(end) = advance(&mut system, (&state, &piece), length, UNWATCHED) else { panic!("an event") };
    assert!(end.state.factor > 0.05);
    assert_close(end.state.factor, load(-end.state.motion[1][2]), 1e-10);
    assert_close(end.length, length, 0.0);
}

/// A step that is too long ends at the first slip, where the slack μ n − t of the left corner is zero.
#[test]
fn a_long_step_ends_at_the_event() {
    let problem = block(FRICTION, pushed_at(HEIGHT));
    let (mut system, state) = second_step(&problem);
    let piece = piece_at(&mut system, &state);
    let length = 2.0 / piece.tangent.factor;
    let Advance::Event(end, hits) = advance(&mut system, (&state, &piece), length, UNWATCHED) else {
        panic!("no event")
    };
    let hits: Vec<_> = hits.iter().map(|hit| piece.monitors.0[*hit]).collect();
    assert!(hits.iter().all(|hit| hit.contact == 0 && hit.what == What::Slack(1)), "{hits:?}");
    let [normal, tangential] = end.state.force[0];
    assert_close(FRICTION * normal - tangential, 0.0, 1e-9);
}

/// A step that reaches its target before any event ends there exactly.
#[test]
fn a_step_ends_at_its_target() {
    let problem = block(FRICTION, pushed_at(HEIGHT));
    let (mut system, state) = second_step(&problem);
    let piece = piece_at(&mut system, &state);
    let watched = Watched { sense: Some(1.0), target: Some((0.123, 1.0)) };
    let Advance::Target(end) = advance(&mut system, (&state, &piece), 2.0 / piece.tangent.factor, watched) else {
        panic!("no target")
    };
    assert_close(end.state.factor, 0.123, 1e-14);
}

/// Returns the state at a length along a piece.
fn state_on(system: &mut StepSystem, state: &State, piece: &Piece, length: f64) -> Option<StepEnd> {
    state_at(system, (state, piece), &[&StepEnd::first(state, piece)], length)
}

/// A state at a length is found whatever the readings of its monitors: beyond the first slip the slack is negative.
#[test]
fn a_state_beyond_an_event_violates_its_monitor() {
    let problem = block(FRICTION, pushed_at(HEIGHT));
    let (mut system, state) = second_step(&problem);
    let piece = piece_at(&mut system, &state);
    let beyond = state_on(&mut system, &state, &piece, 0.28 / piece.tangent.factor).expect("a state");
    let read = piece.read(&system, &state, &beyond.state, &beyond.rate);
    let violated: Vec<_> =
        piece.monitors.0.iter().zip(&read).filter(|(_, r)| r.is_violated()).map(|(m, _)| (m.contact, m.what)).collect();
    assert_eq!(violated, [(0, What::Slack(1))]);
}

/// The distance between prediction and state, relative to the step, is of first order in the length.
#[test]
fn the_error_of_a_prediction_is_of_second_order() {
    let problem = soft();
    let (mut system, state) = second_step(&problem);
    let piece = piece_at(&mut system, &state);
    let error = |system: &mut _, length: f64| state_on(system, &state, &piece, length).expect("a state").error;
    let [long, short] = [0.4, 0.2].map(|factor| error(&mut system, factor / piece.tangent.factor));
    // The rotation is odd in the load and the vertical movement is even: errors of second order and above.
    assert!(long > 0.0 && short < 0.55 * long, "{long} {short}");
}

/// A state on a piece is on the arc tan φ = λ H/(½ k − P H), however long the step.
#[test]
fn a_long_step_of_springs_ends_on_the_arc() {
    let problem = soft();
    let (mut system, state) = second_step(&problem);
    let piece = piece_at(&mut system, &state);
    for factor in [0.1, 1.0, 4.0] {
        let end = state_on(&mut system, &state, &piece, factor / piece.tangent.factor).expect("a state").state;
        assert_close((-end.motion[1][2]).tan(), end.factor * 0.8 / (10.0 - 0.8), 1e-9);
    }
}

/// A state between two states of a piece is accurate to fourth order in their distance. If one of the two has left the curve, there is
/// no such state.
#[test]
fn a_state_between_two_others_is_of_fourth_order() {
    let problem = soft();
    let (mut system, state) = second_step(&problem);
    let piece = piece_at(&mut system, &state);
    let mut off = |by: f64| {
        let ends = [1.0, 1.0 + by].map(|factor| state_on(&mut system, &state, &piece, factor / piece.tangent.factor));
        let [low, high] = ends.map(|end| end.expect("a state"));
        let found = between(&mut system, (&state, &piece), [&low, &high], 0.5).expect("a state").state;
        let mut moved = high;
        moved.state.motion[1][2] *= 1.1;
        assert!(between(&mut system, (&state, &piece), [&low, &moved], 0.5).is_none());
        ((-found.motion[1][2]).tan() - found.factor * 0.8 / (10.0 - 0.8)).abs()
    };
    let [wide, narrow] = [0.4, 0.2].map(&mut off);
    assert!(narrow > 0.0 && narrow < 0.08 * wide && wide < 1e-4, "{wide:e} {narrow:e}");
}

/// The first crossing is the least value/−rate of the monitors that fall and are not yet zero.
#[test]
fn the_first_crossing_is_the_nearest_zero() {
    let reading =
        |value: f64, rate: Option<f64>| Reading { value, rate, tolerance: 1e-9, rate_tolerance: 0.0, of_branch: false };
    let rising = reading(0.1, Some(1.0));
    let zero = reading(0.0, Some(-1.0));
    let rate = reading(0.1, None);
    let (first, length) = first_crossing(&[reading(3.0, Some(-1.0)), reading(2.0, Some(-4.0)), rising, zero, rate]);
    assert_eq!(first, 1);
    assert_close(length, 0.5, 1e-15);
    assert_eq!(first_crossing(&[rising, zero, rate]).1, f64::INFINITY);
}
