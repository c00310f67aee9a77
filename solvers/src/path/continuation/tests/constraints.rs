//! Values and derivatives of all constraints.

use super::{all, entries, of_entries, previous, some};
use crate::path::continuation::arc_length::ArcLength;
use crate::path::continuation::displacement_control::DisplacementControl;
use crate::path::continuation::load_control::LoadControl;
use crate::path::two_blocks::assert_close;
use crate::settings::SETTINGS;
use voussoir_core::path::{Continuation, Increment};

/// ∂c of every strategy is the difference quotient of c.
#[test]
fn derivatives_are_difference_quotients() {
    let at = entries(&some());
    for strategy in all() {
        for last in previous() {
            let constraint = strategy.constraint(&some(), last.as_ref());
            for (k, right) in entries(&constraint.derivative).into_iter().enumerate() {
                let value = |step: f64| {
                    let mut moved = at.clone();
                    moved[k] += step;
                    strategy.constraint(&of_entries(&moved), last.as_ref()).value
                };
                assert_close((value(1e-6) - value(-1e-6)) / 2e-6, right, 1e-8);
            }
        }
    }
}

/// c(s x) = s c(x) for s > 0: lengths of steps are in proportion to them.
#[test]
fn constraints_are_homogeneous() {
    for strategy in all() {
        for last in previous() {
            let value = |scale: f64| {
                let scaled: Vec<f64> = entries(&some()).into_iter().map(|e| scale * e).collect();
                strategy.constraint(&of_entries(&scaled), last.as_ref()).value
            };
            assert_close(value(3.0), 3.0 * value(1.0), 1e-14);
        }
    }
}

/// A step without motion has the length 0 and finite derivatives.
#[test]
fn a_step_of_no_length_has_no_slope_that_is_not_finite() {
    for strategy in all() {
        for last in previous() {
            let constraint = strategy.constraint(&Increment::default(), last.as_ref());
            assert_eq!(constraint.value, 0.0);
            assert!(entries(&constraint.derivative).iter().all(|e| e.is_finite()), "{strategy:?}");
        }
    }
}

/// c = √(motion² + ψ² Δλ²).
#[test]
fn an_arc_length_weighs_the_factor() {
    for psi in [0.0, 0.5, 1.0, 4.0] {
        let arc = ArcLength { psi, ..ArcLength::default() };
        let right = (0.4f64 * 0.4 + psi * psi * 0.3 * 0.3).sqrt();
        assert_close(arc.constraint(&some(), None).value, right, 1e-15);
    }
}

/// ψ = 0 is the cylindrical arc length: the factor has no influence.
#[test]
fn a_cylindrical_arc_length_ignores_the_factor() {
    let arc = ArcLength { psi: 0.0, ..ArcLength::default() };
    let other = Increment { factor: -100.0, ..some() };
    assert_eq!(arc.constraint(&some(), None), arc.constraint(&other, None));
}

/// c = |Δλ|, rising or falling.
#[test]
fn load_control_measures_the_factor() {
    for factor in [0.3, -0.3] {
        let constraint = LoadControl::default().constraint(&Increment { factor, ..some() }, None);
        assert_eq!((constraint.value, constraint.derivative.factor), (0.3, factor.signum()));
    }
}

/// c = |Δu|, forwards or backwards.
#[test]
fn displacement_control_measures_the_displacement() {
    for displacement in [0.7, -0.7] {
        let constraint = DisplacementControl::default().constraint(&Increment { displacement, ..some() }, None);
        assert_eq!((constraint.value, constraint.derivative.displacement), (0.7, displacement.signum()));
    }
}

/// Load control alone passes no limit points.
#[test]
fn only_load_control_ends_at_limit_points() {
    let passes: Vec<bool> = all().iter().map(|strategy| strategy.passes_limit_points()).collect();
    assert_eq!(passes, [true, true, true, true, false]);
}

/// By default the first step is 0.1, and the strategy does not bound the largest one.
#[test]
fn lengths_by_default() {
    for strategy in all() {
        assert_eq!((strategy.first_step(), strategy.largest_step()), (0.1, f64::INFINITY), "{strategy:?}");
    }
    const { assert!(SETTINGS.largest_finite_step > 0.0 && SETTINGS.largest_finite_step < 0.1) };
}

/// A strategy reports the lengths that it is given.
#[test]
fn lengths_that_are_given() {
    let arc = ArcLength { first_step: 0.02, largest_step: Some(0.3), ..ArcLength::default() };
    let load = LoadControl { first_step: 0.02, largest_step: Some(0.3) };
    assert_eq!((arc.first_step(), arc.largest_step()), (0.02, 0.3));
    assert_eq!((load.first_step(), load.largest_step()), (0.02, 0.3));
}
