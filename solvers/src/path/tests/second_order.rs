//! Second-order work of a block on springs, and the states of a path that regain a limit point.

use crate::path::stability::{SecondOrderWork, over_weak_points, regains_limit_point};
use crate::path::two_blocks::assert_close;
use nalgebra::{DMatrix, DVector, Rotation2};
use voussoir_core::path::ProvenPeak;

/// Flexibility of springs along x, y and θ: the inverse of their stiffnesses.
fn springs(stiffness: [f64; 3]) -> DMatrix<f64> {
    DMatrix::from_diagonal(&DVector::from_iterator(3, stiffness.map(|k| 1.0 / k)))
}

fn work(stiffness: [f64; 3]) -> SecondOrderWork {
    SecondOrderWork::of(&springs(stiffness), 1e-12).expect("eigenvalues")
}

/// Springs of positive stiffness are stable, and the softest one has the least second-order work.
#[test]
fn positive_springs_are_stable() {
    let found = work([3.0, 2.0, 5.0]);
    assert_eq!((found.negative, found.turned, found.symmetric), (0, 0, true));
    assert_close(found.curvature, 2.0, 1e-12);
    assert_close(found.nearest, 2.0, 1e-12);
    assert!(found.stable_under_control(1.0));
}

/// A load P at height H leaves k_θ − P H of a rotational spring, and the second-order work has the same sign.
#[test]
fn a_rotational_spring_buckles_at_its_critical_load() {
    let (rotational, height) = (10.0, 2.0);
    for (load, negative) in [(4.9, 0), (5.1, 1), (9.0, 1)] {
        let found = work([100.0, 100.0, rotational - load * height]);
        assert_eq!(found.negative, negative, "{load}");
        assert_close(found.curvature, rotational - load * height, 1e-9);
    }
}

/// The critical mode of a buckling block is its rotation.
#[test]
fn the_critical_mode_is_the_negative_spring() {
    let mode = work([100.0, 50.0, -0.2]).critical_mode().expect("a mode");
    assert_close(mode[2].abs(), 1.0, 1e-12);
    assert_close(mode[0].hypot(mode[1]), 0.0, 1e-12);
}

/// Axes have no influence: springs turned by an angle have the same numbers.
#[test]
fn turned_axes_have_the_same_second_order_work() {
    let turn = Rotation2::new(0.7);
    let mut axes = DMatrix::identity(3, 3);
    axes.view_mut((0, 0), (2, 2)).copy_from(turn.matrix());
    let flexibility = &axes * springs([3.0, -2.0, 5.0]) * axes.transpose();
    let found = SecondOrderWork::of(&flexibility, 1e-12).expect("eigenvalues");
    assert_eq!((found.negative, found.turned), (1, 1));
    assert_close(found.curvature, -2.0, 1e-12);
}

/// With the load point held one negative direction is stable if the load softens it, and two are not.
#[test]
fn control_holds_one_negative_direction() {
    assert!(work([3.0, -2.0, 5.0]).stable_under_control(-1.0));
    assert!(!work([3.0, -2.0, -5.0]).stable_under_control(-1.0));
    assert!(!work([3.0, 2.0, 5.0]).stable_under_control(-1.0));
}

/// No motion, or one that is not finite, has no second-order work.
#[test]
fn no_motion_has_no_second_order_work() {
    assert!(SecondOrderWork::of(&DMatrix::zeros(0, 0), 1e-12).is_none());
    assert!(SecondOrderWork::of(&DMatrix::from_element(2, 2, f64::NAN), 1e-12).is_none());
}

/// Weak points free: positive suffices. Weak points held: negative suffices. All else is not decided.
#[test]
fn weak_points_leave_a_state_undecided() {
    assert_eq!(over_weak_points(Some(true), None), Some(true));
    assert_eq!(over_weak_points(Some(true), Some(true)), Some(true));
    assert_eq!(over_weak_points(None, Some(false)), Some(false));
    assert_eq!(over_weak_points(Some(false), Some(true)), None);
    assert_eq!(over_weak_points(Some(false), None), None);
}

/// A load regains a limit point if it reaches its factor from below, in the same load step.
#[test]
fn a_load_regains_its_limit_point_from_below() {
    let peak = ProvenPeak { load_step: 1, factor: 2.0, displacement: 0.1, lowest: 0.5 };
    assert!(regains_limit_point(&[peak], 1, [1.9, 2.0]) && regains_limit_point(&[peak], 1, [1.0, 3.0]));
    assert!(!regains_limit_point(&[peak], 1, [1.8, 1.9]) && !regains_limit_point(&[peak], 1, [2.0, 2.1]));
    assert!(!regains_limit_point(&[peak], 0, [1.9, 2.0]) && !regains_limit_point(&[], 1, [1.9, 2.0]));
    let falling = ProvenPeak { factor: -2.0, lowest: -0.5, ..peak };
    assert!(regains_limit_point(&[falling], 1, [-1.9, -2.1]));
}
