//! Monitors of a block of 1 N on two points with friction μ that is pushed at height h.

use super::{piece_at, second_step};
use crate::contact::mode::ContactMode;
use crate::path::newton::model::state::State;
use crate::path::newton::pieces::monitors::{Monitors, Reading, What};
use crate::path::two_blocks::{STIFFNESS, assert_close, block, pushed_at};

const FRICTION: f64 = 0.3;
const HEIGHT: f64 = 0.4;

fn reading(value: f64, rate: Option<f64>) -> Reading {
    Reading { value, rate, tolerance: 1e-3, rate_tolerance: 1e-2, of_branch: false }
}

/// A mode has ended if its monitor is below zero by more than the tolerance.
#[test]
fn a_monitor_is_violated_beyond_its_tolerance() {
    assert!(reading(-2e-3, None).is_violated());
    assert!(!reading(-0.5e-3, None).is_violated() && !reading(0.0, None).is_violated());
}

/// A value takes part in an event up to 100 tolerances, a rate up to one.
#[test]
fn values_are_active_further_than_rates() {
    assert!(reading(0.09, Some(0.0)).is_active() && !reading(0.11, Some(0.0)).is_active());
    assert!(reading(0.9e-3, None).is_active() && !reading(1.1e-3, None).is_active());
}

/// A rate leaves a mode if an active value falls, or if the value is a rate and is negative.
#[test]
fn a_rate_leaves_a_mode_that_is_at_its_end() {
    assert!(reading(0.0, Some(-0.1)).leaves());
    assert!(!reading(0.0, Some(-1e-3)).leaves() && !reading(0.0, Some(0.1)).leaves());
    assert!(!reading(1.0, Some(-0.1)).leaves());
    assert!(reading(-0.1, None).leaves() && !reading(0.1, None).leaves());
}

/// A point that sticks has 3 slacks, one on a facet 1 rate and 2 slacks, an open one 1 opening.
#[test]
fn each_mode_has_its_monitors() {
    let problem = block(FRICTION, pushed_at(HEIGHT));
    let (system, state) = second_step(&problem);
    let of = |mode| -> Vec<What> {
        let all = Monitors::of(&system, &State { mode: vec![mode, ContactMode::Open], ..state.clone() }).0;
        all.iter().filter(|monitor| monitor.contact == 0).map(|monitor| monitor.what).collect()
    };
    assert_eq!(of(ContactMode::Stick), [What::Slack(0), What::Slack(1), What::Slack(2)]);
    assert_eq!(of(ContactMode::Facet(2)), [What::Flow(0), What::Slack(0), What::Slack(1)]);
    assert_eq!(of(ContactMode::Open), [What::Opening]);
    assert_eq!(of(ContactMode::Facet(0)), [What::Opening, What::Slack(1), What::Slack(2)]);
}

/// A point that slides has monitors for both ends of its face if they are near; a point that sticks has none.
#[test]
fn a_sliding_point_watches_the_ends_of_its_face() {
    let mut problem = block(FRICTION, pushed_at(HEIGHT));
    problem.contacts[0].sliding.slip = [-0.1, f64::INFINITY];
    let (system, state) = second_step(&problem);
    let faces = |mode| {
        let all = Monitors::of(&system, &State { mode: vec![mode; 2], ..state.clone() }).0;
        all.iter().filter(|monitor| matches!(monitor.what, What::Face { .. })).map(|m| m.contact).collect::<Vec<_>>()
    };
    assert_eq!(faces(ContactMode::Facet(1)), [0]);
    assert!(faces(ContactMode::Stick).is_empty());
}

/// Under W each corner has the slack W/2 of opening and μ W/2 of sliding, over |a| = √(1 + μ²).
#[test]
fn slacks_under_weight() {
    let problem = block(FRICTION, pushed_at(HEIGHT));
    let (mut system, state) = second_step(&problem);
    let piece = piece_at(&mut system, &state);
    let read = piece.read(&system, &state, &state, &piece.tangent);
    let unit = 1f64.hypot(FRICTION);
    for (monitor, reading) in piece.monitors.0.iter().zip(&read) {
        let right = if monitor.what == What::Slack(0) { 0.5 } else { FRICTION * 0.5 / unit };
        assert_close(reading.value, right, 1e-9);
    }
    assert_eq!(read.len(), 6);
}

/// Per unit of λ the left corner loses h k/(k − W) of its normal force and gains ½ of the tangential one.
#[test]
fn rates_of_slacks_under_the_push() {
    let problem = block(FRICTION, pushed_at(HEIGHT));
    let (mut system, state) = second_step(&problem);
    let piece = piece_at(&mut system, &state);
    let read = piece.read(&system, &state, &state, &piece.tangent);
    let per_factor = |what: What| {
        let at = piece.monitors.0.iter().position(|m| m.contact == 0 && m.what == what).expect("a monitor");
        read[at].rate.expect("a rate") / piece.tangent.factor
    };
    let lost = HEIGHT * STIFFNESS / (STIFFNESS - 1.0);
    let unit = 1f64.hypot(FRICTION);
    assert_close(per_factor(What::Slack(0)), -lost, 1e-8);
    assert_close(per_factor(What::Slack(1)), (-FRICTION * lost - 0.5) / unit, 1e-8);
    assert_close(per_factor(What::Slack(2)), (-FRICTION * lost + 0.5) / unit, 1e-8);
}
