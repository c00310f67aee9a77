//! Walls of Ferris & Tin-Loi (2001), Int. J. Mech. Sci. 43, and Gilbert, Casapulla & Ahmed (2006),
//! Computers & Structures 84: associated load factors .643, .404, .332, computed to eight digits by
//! an independent program.

use voussoir::core::limit::Status;
use voussoir_tests::{answered, assert_close, collapse_factor};

fn wall(rows: &str) -> String {
    format!(
        r#"name = "wall"
[scene]
scene = "wall"
width = 1.0
brick = [0.4, 0.175]
{rows}
material = "stone"
joint = "dry"
[materials.stone]
law = "rigid"
density = 2000.0
[joints.dry]
law = "coulomb_associated"
friction = 0.65
[[stages]]
name = "dead"
gravity = 9.81
[[stages]]
name = "push"
until = "collapse"
loads = [{{ kind = "body", acceleration = [9.81, 0.0] }}]
"#
    )
}

fn rows(sequence: &[&[f64]]) -> String {
    format!("rows = {sequence:?}")
}

const FIVE: &[f64] = &[1.0; 5];
const SIX: &[f64] = &[0.5, 1.0, 1.0, 1.0, 1.0, 0.5];

/// Wall 1: 0.64285900.
#[test]
fn wall_1() {
    assert_close(collapse_factor(&wall(&rows(&[SIX, FIVE, SIX, FIVE, SIX, FIVE]))), 0.642_859_00, 2e-8);
}

/// Wall 3, with a window: 0.40369410.
#[test]
fn wall_3() {
    let (fe, fu): (&[f64], &[f64]) = (&[1.0; 4], &[0.5, 1.0, 1.0, 1.0, 0.5]);
    let (we, wu): (&[f64], &[f64]) = (&[1.0, 0.5, -1.0, 0.5, 1.0], &[0.5, 1.0, -1.0, 1.0, 0.5]);
    assert_close(collapse_factor(&wall(&rows(&[fe, fu, fe, wu, we, wu, we, wu, fe, fu, fe]))), 0.403_694_10, 2e-8);
}

/// Wall 4, with two windows: 0.33194840.
#[test]
fn wall_4() {
    let wu: &[f64] = &[1.0, -1.0, 1.0, -1.0, 1.0];
    let we: &[f64] = &[0.5, 0.5, -1.0, 0.5, 0.5, -1.0, 0.5, 0.5];
    assert_close(
        collapse_factor(&wall(&rows(&[SIX, FIVE, SIX, wu, we, wu, we, wu, SIX, FIVE, SIX]))),
        0.331_948_40,
        2e-8,
    );
}

/// A wall of 20 courses by 20 bricks is answered and certified: relative gap at most 1e-9.
#[test]
fn twenty_by_twenty() {
    let result = answered(&wall("courses = 20\nbricks = 20"));
    assert_eq!(result.status, Status::Collapse, "{:?}", result.notes);
    let [low, high] = result.bounds.expect("bounds");
    assert!((high - low) / high <= 1e-9 && result.certificate.passed);
}

/// Without weight a wall carries no push: the factor is 0, not "rounding".
#[test]
fn a_weightless_wall_carries_nothing() {
    let result = answered(&wall(&rows(&[SIX, FIVE])).replace("gravity = 9.81", "gravity = 0.0"));
    assert_eq!((result.status, result.load_factor), (Status::Collapse, Some(0.0)));
}
