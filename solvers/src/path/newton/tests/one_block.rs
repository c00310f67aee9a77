//! A rigid block on a floor with two compliant points at its corners: pieces, events and ends by hand.

use super::{Kept, body, settings};
use crate::path::continuation::arc_length::ArcLength;
use crate::path::continuation::displacement_control::DisplacementControl;
use crate::path::continuation::dissipation::Dissipation;
use crate::path::continuation::load_control::LoadControl;
use crate::path::newton::NewtonPath;
use crate::path::newton::twins::favoured;
use std::sync::Arc;
use voussoir_core::law::Facet;
use voussoir_core::limit::{Counters, Status};
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{
    Attachment, Contact, Continuation, LimitPointEnd, LoadStep, LoadStepEnd, Loading, PathAnswer, PathProblem,
    PathSettings, PathSolver, PointLaw, Sliding, Unobserved,
};

/// Stiffness of a point \[N/m\]; the block has a width of 1 m and a weight of 1 N.
const STIFFNESS: f64 = 1e4;

/// A point between the ground (body 0) and the block (body 1), by its place and the normal that points into the block.
fn point(joint: usize, position: Vec2, normal: Vec2, friction: f64, gap: f64) -> Contact {
    let [left, right] = Facet::friction(friction, 0.0, 0.0);
    Contact {
        joint,
        position,
        normal,
        tangent: Vec2::new(-normal.y, normal.x),
        minus: Attachment { body: 0, slot: None },
        plus: Attachment { body: 1, slot: None },
        area: 1.0,
        gap,
        law: PointLaw::Facets(vec![Facet::opening(0.0), left, right].into()),
        compliance: [1.0 / STIFFNESS; 2],
        sliding: Sliding::fixed(0.0),
    }
}

fn stage(stage: usize, loading: Loading, end: LoadStepEnd) -> LoadStep {
    LoadStep { stage, gravity: false, loading, start: 0.0, end }
}

fn force(at: Vec2, force: Vec2) -> Loading {
    Loading { forces: vec![(1, None, at, force)], ..Loading::default() }
}

/// The block under its weight, then `pushed` until collapse.
fn block(friction: f64, pushed: Loading) -> PathProblem {
    let up = Vec2::new(0.0, 1.0);
    let centre = Vec2::new(0.5, 0.5);
    PathProblem {
        bodies: vec![body(Vec2::zeros(), vec![], None, true), body(centre, vec![], None, false)],
        body_of: vec![0, 1],
        contacts: vec![
            point(0, Vec2::new(0.0, 0.0), up, friction, 0.0),
            point(0, Vec2::new(1.0, 0.0), up, friction, 0.0),
        ],
        load_steps: vec![
            stage(0, force(centre, -up), LoadStepEnd::Factor(1.0)),
            stage(1, pushed, LoadStepEnd::Collapse(f64::INFINITY)),
        ],
        length: 1.0,
        span: 1.0,
        counters: Counters::new(),
    }
}

/// Pushed by 1 N to the right at a height of the left face.
fn pushed_at(height: f64) -> Loading {
    force(Vec2::new(0.0, height), Vec2::new(1.0, 0.0))
}

fn finite(strategy: Option<Arc<dyn Continuation>>) -> PathSettings {
    PathSettings { finite: true, ..settings(strategy) }
}

fn followed(problem: &PathProblem, strategy: Option<Arc<dyn Continuation>>) -> PathAnswer {
    NewtonPath {}.trace(problem, &finite(strategy), &mut Unobserved)
}

/// Strategies that pass limit points, with whole and half steps.
fn strategies() -> Vec<Option<Arc<dyn Continuation>>> {
    vec![
        None,
        Some(Arc::new(ArcLength { first_step: 0.05, ..ArcLength::default() })),
        Some(Arc::new(ArcLength { first_step: 0.01, ..ArcLength::default() })),
        Some(Arc::new(DisplacementControl::default())),
        Some(Arc::new(Dissipation::default())),
    ]
}

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

/// A stage that asks for more than the limit point ends there.
#[test]
fn a_stage_with_a_factor_ends_at_its_limit_point() {
    let mut problem = block(0.9, pushed_at(0.8));
    problem.load_steps[1].end = LoadStepEnd::Factor(2.0);
    let answer = followed(&problem, None);
    assert_eq!((answer.status, answer.limit_point_end), (Status::LimitPoint, Some(LimitPointEnd::Target)));
    assert!((answer.factor.expect("a factor") - tipping(0.8)).abs() < 1e-10, "{:?}", answer.factor);
}

/// A stage that asks for less stands at its factor.
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

/// A load that is to fall below nothing pushes the other way: the block slides at −μ W.
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

/// A mechanism that closes a gap is no collapse: behind it the wall carries the load.
#[test]
fn a_mechanism_that_closes_a_gap_is_no_plateau() {
    let mut problem = block(0.3, pushed_at(0.1));
    problem.contacts.push(point(1, Vec2::new(1.0, 0.1), Vec2::new(-1.0, 0.0), 0.3, 5e-4));
    problem.load_steps[1].end = LoadStepEnd::Collapse(2.0);
    let answer = followed(&problem, None);
    assert_eq!((answer.status, answer.factor), (Status::Stands, Some(2.0)), "{:?}", answer.notes);
}

/// From nothing: the weight of a block whose joints are open at first closes them.
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
    // Events within a thousandth of the size: the block slides on for less than a plateau.
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
}
