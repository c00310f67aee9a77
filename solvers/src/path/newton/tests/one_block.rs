//! A rigid block on a floor with two compliant points at its corners: pieces, events and ends by hand.

use crate::path::continuation::load_control::LoadControl;
use crate::path::newton::NewtonPath;
use crate::path::twins::favoured;
use crate::path::two_blocks::{Kept, STIFFNESS, block, finite, followed, force, point, pushed_at, strategies};
use std::sync::Arc;
use voussoir_core::limit::Status;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{LimitPointEnd, LoadStepEnd, Loading, PathSolver};

/// Load at the limit point of a block that tips about its right corner: the left one has just opened, at the tilt
/// sin θ = W/(k b) that the compression of the right one gives.
fn tipping(height: f64) -> f64 {
    let sine: f64 = 1.0 / STIFFNESS;
    let cosine = (1.0 - sine * sine).sqrt();
    (0.5 * cosine - 0.5 * sine) / (height * cosine + sine)
}

/// A block that slides on under a constant load is a mechanism: λ = μ W, by every strategy.
#[test]
fn a_block_that_slides_is_a_plateau() {
    for strategy in strategies() {
        let answer = followed(&block(0.3, pushed_at(0.1)), strategy);
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        assert!((answer.factor.expect("a factor") - 0.3).abs() < 1e-10, "{:?}", answer.factor);
        assert_eq!(answer.limit_points.len(), 1, "{:?}", answer.limit_points);
    }
}

/// The moved state of a plateau is in equilibrium under the same forces.
#[test]
fn forces_rest_on_a_plateau() {
    let mut states = Kept(Vec::new());
    NewtonPath {}.trace(&block(0.3, pushed_at(0.1)), &finite(None), &mut states);
    let [.., before, after] = &states.0[..] else { panic!("{} states", states.0.len()) };
    assert!(after.motion[1][0] - before.motion[1][0] > 0.9e-2);
    for (a, b) in before.force.iter().flatten().zip(after.force.iter().flatten()) {
        assert!((a - b).abs() < 1e-9, "{a} {b}");
    }
}

/// A block that is pushed high up tips. Its limit point is the event at which a corner opens, and the load falls to half.
#[test]
fn a_block_that_tips_has_a_limit_point() {
    for strategy in strategies() {
        let answer = followed(&block(0.9, pushed_at(0.8)), strategy);
        assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
        let [peak] = &answer.limit_points[..] else { panic!("{:?}", answer.limit_points) };
        assert!((peak.factor - tipping(0.8)).abs() < 1e-10, "{} {}", peak.factor, tipping(0.8));
        assert!(peak.lowest < 0.55 * peak.factor, "{peak:?}");
    }
}

/// Load control ends at the limit point that the others pass.
#[test]
fn load_control_ends_at_the_limit_point() {
    let answer = followed(&block(0.9, pushed_at(0.8)), Some(Arc::new(LoadControl::default())));
    assert_eq!(answer.status, Status::LimitPoint, "{:?}", answer.notes);
    assert!((answer.factor.expect("a factor") - tipping(0.8)).abs() < 1e-10, "{:?}", answer.factor);
}

/// A stage with a target above the limit point ends there.
#[test]
fn a_stage_with_a_factor_ends_at_its_limit_point() {
    let mut problem = block(0.9, pushed_at(0.8));
    problem.load_steps[1].end = LoadStepEnd::Factor(2.0);
    let answer = followed(&problem, None);
    assert_eq!((answer.status, answer.limit_point_end), (Status::LimitPoint, Some(LimitPointEnd::Target)));
    assert!((answer.factor.expect("a factor") - tipping(0.8)).abs() < 1e-10, "{:?}", answer.factor);
}

/// A stage with a target below the limit point stands at its factor.
#[test]
fn a_stage_below_the_limit_point_stands() {
    let mut problem = block(0.9, pushed_at(0.8));
    problem.load_steps[1].end = LoadStepEnd::Factor(0.5);
    let answer = followed(&problem, None);
    assert_eq!((answer.status, answer.factor), (Status::Stands, Some(0.5)), "{:?}", answer.notes);
    assert!(answer.limit_points.is_empty());
}

/// The mirror image tips under the same load.
#[test]
fn the_mirror_image_has_the_same_limit_point() {
    let mirrored = block(0.9, force(Vec2::new(1.0, 0.8), Vec2::new(-1.0, 0.0)));
    let [one, other] = [block(0.9, pushed_at(0.8)), mirrored].map(|problem| followed(&problem, None));
    let [one, other] = [one, other].map(|answer| answer.factor.expect("a factor"));
    assert!((one - other).abs() < 1e-12, "{one} {other}");
}

/// The order of the points has no influence.
#[test]
fn renumbered_points_have_the_same_limit_points() {
    for height in [0.1, 0.8] {
        let problem = block(0.6, pushed_at(height));
        let mut renumbered = problem.clone();
        renumbered.contacts.reverse();
        let [one, other] = [problem, renumbered].map(|problem| followed(&problem, None));
        assert_eq!(one.status, other.status);
        let pairs = one.limit_points.iter().zip(&other.limit_points);
        assert!(pairs.clone().count() > 0 && one.limit_points.len() == other.limit_points.len());
        pairs.for_each(|(a, b)| assert!((a.factor - b.factor).abs() < 1e-11, "{a:?} {b:?}"));
    }
}

/// A negative target is a push in the other direction: the block slides at −μ W.
#[test]
fn a_negative_target_is_approached_from_above() {
    let mut problem = block(0.3, pushed_at(0.1));
    problem.load_steps[1].end = LoadStepEnd::Factor(-0.2);
    let answer = followed(&problem, None);
    assert_eq!((answer.status, answer.factor), (Status::Stands, Some(-0.2)), "{:?}", answer.notes);
}

/// A statically determinate structure moves with its support under constant forces: no mechanism, no limit point.
#[test]
fn a_settlement_of_a_determinate_structure_is_no_mechanism() {
    let settlement = Loading { settlements: vec![(0, [0.05, -0.02, 0.1])], ..Loading::default() };
    let mut problem = block(0.5, settlement);
    problem.load_steps[1].end = LoadStepEnd::Factor(1.0);
    let answer = followed(&problem, None);
    assert_eq!((answer.status, answer.factor), (Status::Stands, Some(1.0)), "{:?}", answer.notes);
    let normal: f64 = answer.state.force.iter().map(|r| r[0]).sum();
    // The floor has turned by a tenth: the forces across it carry W cos 0.1.
    assert!((normal - 0.1f64.cos()).abs() < 1e-9, "{normal}");
}

/// A mechanism that closes a gap is not a collapse: after that the wall carries the load.
#[test]
fn a_mechanism_that_closes_a_gap_is_no_plateau() {
    let mut problem = block(0.3, pushed_at(0.1));
    problem.contacts.push(point(1, Vec2::new(1.0, 0.1), Vec2::new(-1.0, 0.0), 0.3, 5e-4));
    problem.load_steps[1].end = LoadStepEnd::Collapse(2.0);
    let answer = followed(&problem, None);
    assert_eq!((answer.status, answer.factor), (Status::Stands, Some(2.0)), "{:?}", answer.notes);
}

/// The weight of a block closes joints that are open in the unloaded state.
#[test]
fn a_path_begins_with_open_joints() {
    let mut problem = block(0.3, pushed_at(0.1));
    problem.contacts.iter_mut().for_each(|contact| contact.gap = 1e-4);
    let answer = followed(&problem, None);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert!((answer.factor.expect("a factor") - 0.3).abs() < 1e-10, "{:?}", answer.factor);
}

/// A block that slides off its face: the joint is lost under the load of the limit point at which it began to slide.
#[test]
fn a_corner_that_leaves_its_face_ends_the_path() {
    let mut problem = block(0.3, pushed_at(0.1));
    // Events within a thousandth of the size: the block slides less far than on a plateau.
    problem.contacts.iter_mut().for_each(|contact| contact.sliding.slip = [-5e-4, 5e-4]);
    let answer = followed(&problem, None);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert!((answer.factor.expect("a factor") - 0.3).abs() < 1e-10, "{:?}", answer.factor);
}

/// Twins: the one on which the present load does more work is followed; without a load the one that moves to the right.
#[test]
fn twins_are_told_apart_by_loads() {
    let [right, left] = [[[0.0; 3], [1.0, 0.0, 0.0]], [[0.0; 3], [-1.0, 0.0, 0.0]]];
    let pushed = block(0.3, pushed_at(0.1));
    assert_eq!(favoured(&pushed, 1, &[&left, &right]), 1);
    let pulled = block(0.3, force(Vec2::new(0.0, 0.1), Vec2::new(-1.0, 0.0)));
    assert_eq!(favoured(&pulled, 1, &[&left, &right]), 0);
    let idle = block(0.3, Loading::default());
    assert_eq!(favoured(&idle, 1, &[&left, &right]), 1);
    // The twins are nearly equal.
    let [right, left] = [[[0.0; 3], [1.0 + 1e-8, 0.0, 0.0]], [[0.0; 3], [1.0 - 1e-8, 0.0, 0.0]]];
    assert_eq!(favoured(&pushed, 1, &[&left, &right]), 1);
    assert_eq!(favoured(&pulled, 1, &[&left, &right]), 0);
}

/// A stage whose target is its start changes nothing, and stands.
#[test]
fn a_stage_without_a_change_stands() {
    let mut problem = block(0.3, pushed_at(0.1));
    problem.load_steps[1].end = LoadStepEnd::Factor(0.0);
    let answer = followed(&problem, None);
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
}
