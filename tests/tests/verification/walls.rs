//! Walls of Ferris & Tin-Loi (2001), Int. J. Mech. Sci. 43, and Gilbert, Casapulla & Ahmed (2006), Computers &
//! Structures 84: associated load factors .643, .404, .332, computed to eight digits by an independent program.

use voussoir::core::limit::Status;
use voussoir_tests::known::{FIVE, SIX, published_wall};
use voussoir_tests::{Wall, answered, assert_close, collapse_factor};

fn associated(number: usize) {
    let known = published_wall(number);
    assert_close(collapse_factor(&known.wall.study()), known.associated, 2e-8);
}

/// The load factor of wall 1 is 0.64285900.
#[test]
fn wall_1() {
    associated(1);
}

/// The load factor of wall 3, with a window, is 0.40369410.
#[test]
fn wall_3() {
    associated(3);
}

/// The load factor of wall 4, with two windows, is 0.33194840.
#[test]
fn wall_4() {
    associated(4);
}

/// A wall of 20 courses by 20 bricks is solved and certified with a relative gap of at most 1e-9.
#[test]
fn twenty_by_twenty() {
    let result = answered(&Wall::in_bond(20, 20).study());
    assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
    let [low, high] = result.both_bounds().expect("bounds");
    assert!((high - low) / high <= 1e-9 && result.certificate.passed);
}

/// A wall without weight carries no push: the factor is exactly 0.
#[test]
fn a_weightless_wall_carries_nothing() {
    let result = answered(&Wall { gravity: 0.0, ..Wall::of_rows(&[SIX, FIVE]) }.study());
    assert_eq!((result.status, result.load_factor), (Status::Collapse, Some(0.0)));
}

/// A wall of 40 courses by 40 bricks needs one program by blocks, and its bounds are equal within rounding although
/// some rows carry almost no force. Another program (Clarabel with a polish of its solution) gives 0.4530678655, with a
/// field that exceeds strengths by 7e-13 of the load, which is 6e-11 of the factor.
#[test]
fn forty_by_forty() {
    let result = answered(&Wall::in_bond(40, 40).study());
    assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
    let [low, high] = result.both_bounds().expect("bounds");
    assert!((high - low) / high <= 1e-12 && result.certificate.passed, "{low} {high}");
    assert_close(low, 0.4530678655, 2e-10);
    let counters = &result.counters;
    assert!(counters["programs"] == 1 && counters["interior_point_iterations"] <= 60, "{counters:?}");
    assert!(counters["factorisations"] <= 62, "{counters:?}");
}

/// A wall of 150 courses by 150 bricks is solved and certified: the factors alone leave 6e-10 of the load out of
/// equilibrium, and conjugate corrections remove it.
#[test]
#[ignore = "by hand: half a minute of processor time"]
fn a_hundred_and_fifty_by_a_hundred_and_fifty() {
    let result = answered(&Wall::in_bond(150, 150).study());
    assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
    let [low, high] = result.both_bounds().expect("bounds");
    assert!((high - low) / high <= 5e-12 && result.certificate.passed, "{low} {high}");
    let equilibrium = result.certificate.residuals["equilibrium"];
    assert!(equilibrium <= 1e-15 && result.counters["programs"] == 1, "{equilibrium} {:?}", result.counters);
}
