//! Ends of exact paths: targets, requests, rays, stops, and refusals.

use crate::path::continuation::load_control::LoadControl;
use crate::path::event::EventPath;
use crate::path::two_blocks::{assert_close, block, finite, force, pushed_at, settings, stage, traced, turning, v};
use std::sync::Arc;
use voussoir_core::limit::Status;
use voussoir_core::path::{
    LoadStepEnd, PathObserver, PathProblem, PathSettings, PathSolver, PathState, StageSettings, Unobserved,
};

/// Lets a path continue for some states.
struct Patient(usize);

impl PathObserver for Patient {
    fn state(&mut self, _problem: &PathProblem, _state: &PathState) -> bool {
        self.0 -= 1;
        self.0 > 0
    }
}

/// A target below μ W stands at exactly that factor.
#[test]
fn a_target_below_the_limit_stands() {
    for end in [LoadStepEnd::Factor(0.2), LoadStepEnd::Collapse(0.2)] {
        let mut problem = block(0.3, pushed_at(0.1));
        problem.load_steps[1].end = end;
        let answer = traced(&problem);
        assert_eq!((answer.status, answer.factor), (Status::Stands, Some(0.2)), "{:?}", answer.notes);
    }
}

/// A target above μ W ends in the mechanism at μ W.
#[test]
fn a_target_above_the_limit_ends_in_the_mechanism() {
    let mut problem = block(0.3, pushed_at(0.1));
    problem.load_steps[1].end = LoadStepEnd::Factor(0.4);
    let answer = traced(&problem);
    assert_eq!(answer.status, Status::Collapse, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 0.3, 1e-12);
}

/// Later stages are not computed after a collapse.
#[test]
fn stages_after_a_collapse_are_not_computed() {
    let mut problem = block(0.3, pushed_at(0.1));
    problem.load_steps.push(stage(2, pushed_at(0.1), LoadStepEnd::Factor(0.1)));
    let answer = traced(&problem);
    assert_eq!((answer.status, answer.load_step), (Status::Collapse, 1), "{:?}", answer.notes);
}

/// A load that presses the block down is carried without limit, half of it at each corner.
#[test]
fn a_pressing_load_has_a_ray() {
    let answer = traced(&block(0.3, force(v(0.5, 1.0), v(0.0, -1.0))));
    assert_eq!((answer.status, answer.factor), (Status::Unbounded, None), "{:?}", answer.notes);
    answer.ray.expect("a ray").iter().for_each(|r| {
        assert_close(r[0], 0.5, 1e-12);
        assert_close(r[1], 0.0, 1e-12);
    });
}

/// The path of the two-degree example turns back at λ = 1.25. It ends there if its first limit point is requested.
#[test]
fn a_path_ends_at_its_first_limit_point_on_request() {
    let first = StageSettings { first_limit_point: true, ..StageSettings::default() };
    let how = PathSettings { stages: vec![first], ..settings(None) };
    let answer = EventPath {}.trace(&turning(), &how, &mut Unobserved);
    assert_eq!(answer.status, Status::LimitPoint, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 1.25, 1e-12);
    assert_close(answer.state.factor, 1.25, 1e-12);
}

/// A stop below the limit point gives the limit point as the result and the falling state as the last one.
#[test]
fn a_stop_factor_ends_a_falling_branch() {
    let how = PathSettings { stop_factor: Some(1.1), ..settings(None) };
    let answer = EventPath {}.trace(&turning(), &how, &mut Unobserved);
    assert_eq!(answer.status, Status::LimitPoint, "{:?}", answer.notes);
    assert_close(answer.factor.expect("a factor"), 1.25, 1e-12);
    assert!(answer.last.expect("a last state").factor <= 1.1);
}

/// A stop at a factor that the falling branch does not reach changes nothing: λ falls to 1 only.
#[test]
fn a_stop_factor_that_is_not_reached_does_not_matter() {
    let how = PathSettings { stop_factor: Some(0.9), ..settings(None) };
    let answer = EventPath {}.trace(&turning(), &how, &mut Unobserved);
    assert_eq!(answer.status, traced(&turning()).status, "{:?}", answer.notes);
}

/// An observer that returns false ends the path at the observed state.
#[test]
fn an_observer_stops_the_path() {
    let mut seen = Patient(2);
    let answer = EventPath {}.trace(&block(0.3, pushed_at(0.4)), &settings(None), &mut seen);
    assert_eq!((answer.status, seen.0), (Status::Stalled, 0));
    assert!(answer.factor.is_none() && answer.motion.is_none());
}

/// A block that sticks is stable under its loads.
#[test]
fn a_block_that_sticks_is_stable() {
    let mut problem = block(0.3, pushed_at(0.1));
    problem.load_steps[1].end = LoadStepEnd::Factor(0.1);
    let stability = traced(&problem).stability;
    assert_eq!(stability.iter().map(|s| s.stage).collect::<Vec<_>>(), [0, 1]);
    for found in stability {
        assert_eq!((found.under_load, found.sufficient_only), (Some(true), false), "{found:?}");
    }
}

/// The solver refuses a strategy, finite displacements, and a scene that does not deform.
#[test]
fn what_the_solver_refuses() {
    let problem = block(0.3, pushed_at(0.1));
    assert_eq!(EventPath {}.refuses(&problem, &settings(None)), None);
    assert!(EventPath {}.refuses(&problem, &finite(None)).is_some());
    assert!(EventPath {}.refuses(&problem, &settings(Some(Arc::new(LoadControl::default())))).is_some());
    let mut stiff = problem;
    stiff.contacts.iter_mut().for_each(|contact| contact.compliance = [0.0; 2]);
    assert!(EventPath {}.refuses(&stiff, &settings(None)).is_some());
}

/// Compliance has no influence on the collapse load: ten times softer points slide at the same λ = μ W.
#[test]
fn compliance_does_not_change_the_collapse_load() {
    let mut problem = block(0.3, pushed_at(0.4));
    problem.contacts[0].compliance = [1e-3, 3e-3];
    assert_close(traced(&problem).factor.expect("a factor"), 0.3, 1e-12);
}
