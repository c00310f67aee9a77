//! Requests of a study with finite displacements: first limit point, strategies, stages, observers.

use crate::path::continuation::arc_length::ArcLength;
use crate::path::continuation::crack_opening::CrackOpening;
use crate::path::continuation::load_control::LoadControl;
use crate::path::newton::NewtonPath;
use crate::path::two_blocks::{
    STIFFNESS, assert_close, block, block_on, coulomb, finite, followed, live, pushed_at, scene, settings, stage,
    traced,
};
use std::sync::Arc;
use voussoir_core::limit::Status;
use voussoir_core::path::{
    ContactEvent, LimitPointEnd, LoadStepEnd, PathObserver, PathProblem, PathSettings, PathSolver, PathState,
    StageSettings, Unobserved,
};

/// Stops every path.
struct Impatient;

impl PathObserver for Impatient {
    fn state(&mut self, _problem: &PathProblem, _state: &PathState) -> bool {
        false
    }
}

/// Load control ends at the first limit point, like a path with a request for it.
#[test]
fn load_control_is_a_request_for_the_first_limit_point() {
    let problem = block(0.9, pushed_at(0.8));
    let first = StageSettings { first_limit_point: true, ..StageSettings::default() };
    let how = PathSettings { stages: vec![StageSettings::default(), first], ..finite(None) };
    let requested = NewtonPath {}.trace(&problem, &how, &mut Unobserved);
    let controlled = followed(&problem, Some(Arc::new(LoadControl::default())));
    assert_eq!([requested.status, controlled.status], [Status::LimitPoint; 2], "{:?}", requested.notes);
    assert_close(requested.factor.expect("a factor"), controlled.factor.expect("a factor"), 1e-11);
}

/// A request for the first limit point finds the one that the whole path lists first.
#[test]
fn the_first_limit_point_is_the_first_of_the_whole_path() {
    let problem = block(0.9, pushed_at(0.8));
    let first = StageSettings { first_limit_point: true, ..StageSettings::default() };
    let how = PathSettings { stages: vec![StageSettings::default(), first], ..finite(None) };
    let requested = NewtonPath {}.trace(&problem, &how, &mut Unobserved);
    let whole = followed(&problem, None);
    assert_close(requested.factor.expect("a factor"), whole.limit_points[0].factor, 1e-11);
}

/// The event at which the left corner slips: t = ½ λ + ½ k (1 − cos φ) reaches μ n = μ ½ (W − k sin φ), with
/// λ (h cos φ + ½ sin φ) = ½ (k − W) sin φ.
#[test]
fn the_first_slip_is_located() {
    let (friction, height) = (0.3, 0.4);
    let load = |turned: f64| 0.5 * (STIFFNESS - 1.0) * turned.sin() / (height * turned.cos() + 0.5 * turned.sin());
    let slack = |turned: f64| {
        let normal = 0.5 * (1.0 - STIFFNESS * turned.sin());
        friction * normal - 0.5 * load(turned) - 0.5 * STIFFNESS * (1.0 - turned.cos())
    };
    let (mut low, mut high) = (0.0, 1.0 / STIFFNESS);
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if slack(middle) > 0.0 { low = middle } else { high = middle }
    }
    let answer = followed(&block(friction, pushed_at(height)), None);
    let slips = answer.events.iter().find(|event| event.contact == 0).expect("the left corner slips");
    assert_eq!(slips.what, ContactEvent::SlipsBackward);
    assert_close(slips.factor, load(low), 1e-9);
}

/// With small displacements and facets both solvers give the same answer, whatever the strategy.
#[test]
fn strategies_have_no_influence_with_small_displacements() {
    let problem = block(0.3, pushed_at(0.4));
    let exact = traced(&problem);
    let how = settings(Some(Arc::new(ArcLength { first_step: 0.037, ..ArcLength::default() })));
    let answer = NewtonPath {}.trace(&problem, &how, &mut Unobserved);
    assert_eq!((answer.status, answer.factor), (exact.status, exact.factor));
    assert_eq!(answer.events, exact.events);
}

/// Cohesion c adds c A of both points: λ = μ W + c A, also with finite displacements.
#[test]
fn cohesion_adds_to_friction_with_finite_displacements() {
    let problem = block_on(&[0.0, 1.0], &coulomb(0.3, 0.05, 0.0), live(pushed_at(0.1)));
    let answer = followed(&problem, None);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 0.4, 1e-9);
}

/// A second stage continues from the first: pushed by λ₁, the block slides at λ₂ = μ W − λ₁.
#[test]
fn stages_of_the_same_load_add_up_with_finite_displacements() {
    let mut problem = block(0.3, pushed_at(0.1));
    problem.load_steps[1].end = LoadStepEnd::Factor(0.2);
    problem.load_steps.push(stage(2, pushed_at(0.1), LoadStepEnd::Collapse(f64::INFINITY)));
    let answer = followed(&problem, None);
    assert_eq!((answer.status, answer.load_step), (Status::Collapse, 2), "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 0.1, 1e-9);
}

/// A stage with a target above its limit point ends there, and later stages are not computed.
#[test]
fn stages_after_a_limit_point_are_not_computed() {
    let mut problem = block(0.9, pushed_at(0.8));
    problem.load_steps[1].end = LoadStepEnd::Factor(2.0);
    problem.load_steps.push(stage(2, pushed_at(0.8), LoadStepEnd::Factor(0.1)));
    let answer = followed(&problem, None);
    assert_eq!((answer.status, answer.load_step), (Status::LimitPoint, 1), "{:?}", answer.notes);
    assert_eq!(answer.limit_point_end, Some(LimitPointEnd::Target));
}

/// An observer that returns false ends the path.
#[test]
fn an_observer_stops_the_path() {
    let answer = NewtonPath {}.trace(&block(0.3, pushed_at(0.1)), &finite(None), &mut Impatient);
    assert_eq!(answer.status, Status::Stalled, "{:?}", answer.notes);
}

/// The solver refuses a scene without loads, a scene that does not deform, and a monitor of an absent joint.
#[test]
fn what_the_solver_refuses() {
    let problem = block(0.3, pushed_at(0.1));
    assert_eq!(NewtonPath {}.refuses(&problem, &finite(None)), None);
    let idle = scene(problem.bodies.clone(), problem.contacts.clone(), Vec::new());
    assert!(NewtonPath {}.refuses(&idle, &finite(None)).is_some());
    let mut stiff = problem.clone();
    stiff.contacts.iter_mut().for_each(|contact| contact.compliance = [0.0; 2]);
    assert!(NewtonPath {}.refuses(&stiff, &finite(None)).is_some());
    let [present, absent] = [0, 7].map(|joint| finite(Some(Arc::new(CrackOpening::of(joint)))));
    assert_eq!(NewtonPath {}.refuses(&problem, &present), None);
    assert!(NewtonPath {}.refuses(&problem, &absent).expect("a reason").contains("joint 7"));
}
