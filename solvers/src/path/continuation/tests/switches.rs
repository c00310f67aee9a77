//! Strategies whose measure depends on the last step.

use super::{all, some};
use crate::path::continuation::arc_length::ArcLength;
use crate::path::continuation::crack_opening::CrackOpening;
use crate::path::continuation::dissipation::Dissipation;
use voussoir_core::path::{Continuation, Increment, MOST_MONITORS, Monitor};

/// A last step with a motion of 1.
fn last(dissipation: f64, opening: f64) -> Increment {
    let mut monitored = [0.0; MOST_MONITORS];
    monitored[0] = opening;
    Increment { motion: 1.0, dissipation, monitored, ..Increment::default() }
}

/// Before the first step and after elastic ones dissipation control is the arc length.
#[test]
fn dissipation_control_begins_as_arc_length() {
    let (control, arc) = (Dissipation::default(), ArcLength::default().constraint(&some(), None));
    assert_eq!(control.constraint(&some(), None), arc);
    assert_eq!(control.constraint(&some(), Some(&last(0.0, 0.0))), arc);
}

/// c = ΔD if the last step dissipated more than `switch` times its motion.
#[test]
fn dissipation_control_measures_dissipation_beyond_its_switch() {
    let control = Dissipation { switch: 0.05, ..Dissipation::default() };
    let value = |dissipation: f64| control.constraint(&some(), Some(&last(dissipation, 0.0))).value;
    assert_eq!(value(0.051), some().dissipation);
    assert_eq!(value(0.049), ArcLength::default().constraint(&some(), None).value);
}

/// c = Δg_n of the joint if it opened by more than `switch` times the motion of the last step.
#[test]
fn crack_opening_measures_the_opening_beyond_its_switch() {
    let control = CrackOpening { switch: 0.2, ..CrackOpening::of(3) };
    let value = |opening: f64| control.constraint(&some(), Some(&last(0.0, opening))).value;
    assert_eq!(value(0.21), some().monitored[0]);
    assert_eq!(value(0.19), ArcLength::default().constraint(&some(), None).value);
}

/// A closing joint is not controlled: arc length continues.
#[test]
fn a_closing_joint_is_not_controlled() {
    let control = CrackOpening::of(3);
    let found = control.constraint(&some(), Some(&last(0.0, -5.0)));
    assert_eq!(found, ArcLength::default().constraint(&some(), None));
}

/// Crack opening monitors its joint; the other strategies monitor no joint.
#[test]
fn crack_opening_watches_its_joint() {
    let at = CrackOpening { at: Some(0.25), ..CrackOpening::of(7) };
    assert_eq!(at.monitors(), [Monitor::Opening { joint: 7, at: Some(0.25) }]);
    let watching = all().iter().filter(|strategy| !strategy.monitors().is_empty()).count();
    assert_eq!(watching, 1);
}
