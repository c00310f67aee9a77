//! False claims about the end of a path: each is refused, and the answer then claims nothing.

use crate::path::self_check::confirmed;
use crate::path::two_blocks::{STIFFNESS, block, dead, followed, force, pushed_at, traced, v};
use voussoir_core::limit::Status;
use voussoir_core::path::{LoadStepEnd, PathAnswer, PathProblem};

/// The block pushed to a factor below or above its friction of 0.3.
fn pushed(target: f64) -> PathProblem {
    let mut problem = block(0.3, pushed_at(0.1));
    problem.load_steps[1].end = LoadStepEnd::Factor(target);
    problem
}

/// Fails unless the answer is refused with a note that contains `why`.
#[track_caller]
fn refused(problem: &PathProblem, finite: bool, answer: PathAnswer, why: &str) {
    let found = confirmed(problem, finite, answer);
    assert_eq!(found.status, Status::Stalled);
    assert!(found.factor.is_none() && found.motion.is_none() && found.ray.is_none());
    assert!(found.notes.last().is_some_and(|note| note.contains(why)), "{:?}", found.notes);
}

/// The state at λ = 0.2 < μ W is no plateau: the block does not slide there.
#[test]
fn a_state_below_the_friction_is_no_plateau() {
    let mut answer = traced(&pushed(0.2));
    answer.status = Status::Collapse;
    answer.motion = Some(vec![[0.0; 3], [1.0, 0.0, 0.0]]);
    refused(&pushed(0.2), false, answer, "path_flow");
}

/// A plateau is no plateau in the other direction: the load would do negative work.
#[test]
fn a_plateau_in_the_other_direction_is_refused() {
    let mut answer = traced(&block(0.3, pushed_at(0.1)));
    answer.motion = Some(vec![[0.0; 3], [-1.0, 0.0, 0.0]]);
    refused(&block(0.3, pushed_at(0.1)), false, answer, "path_flow");
}

/// Forces in equilibrium with λ = 0.32 and with their springs violate friction: t = 0.16 > μ n = 0.15.
#[test]
fn a_state_beyond_the_friction_does_not_stand() {
    let mut problem = block(0.3, pushed_at(0.0));
    problem.load_steps[1].end = LoadStepEnd::Factor(0.25);
    let mut answer = traced(&problem);
    (answer.state.factor, answer.factor) = (0.32, Some(0.32));
    answer.state.force.iter_mut().for_each(|r| r[1] = 0.16);
    answer.state.motion[1][0] = 0.16 / STIFFNESS;
    refused(&problem, false, answer, "path_strength");
}

/// A state that stands at λ = 0.25 does not stand at λ = 0.26.
#[test]
fn a_state_of_another_load_does_not_stand() {
    let mut answer = traced(&pushed(0.25));
    (answer.state.factor, answer.factor) = (0.26, Some(0.26));
    refused(&pushed(0.26), false, answer, "path_equilibrium");
}

/// A lifted block in equilibrium with n = −0.5 at both corners does not stand without tensile strength.
#[test]
fn tension_without_strength_does_not_stand() {
    let mut problem = block(0.3, force(v(0.5, 0.5), v(0.0, 1.0)));
    problem.load_steps[1].end = LoadStepEnd::Factor(0.5);
    let mut answer = traced(&problem);
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    (answer.state.factor, answer.factor) = (2.0, Some(2.0));
    answer.state.force.iter_mut().for_each(|r| *r = [-0.5, 0.0]);
    answer.state.motion[1] = [0.0, 0.5 / STIFFNESS, 0.0];
    refused(&problem, false, answer, "path_strength");
}

/// A sideways push has no ray: half of it at each corner lies beyond friction without normal force.
#[test]
fn a_sideways_push_has_no_ray() {
    let problem = block(0.3, pushed_at(0.0));
    let mut answer = traced(&problem);
    answer.status = Status::Unbounded;
    (answer.motion, answer.factor) = (None, None);
    answer.ray = Some(vec![[0.0, 0.5]; 2]);
    refused(&problem, false, answer, "path_ray");
}

/// A dead load that is carried to half of its weight only is no equilibrium if a mechanism shows it.
#[test]
fn no_equilibrium_without_a_mechanism_is_refused() {
    let mut problem = block(0.3, pushed_at(0.1));
    problem.load_steps = vec![dead(force(v(0.5, 0.5), v(0.0, -1.0)))];
    let mut answer = traced(&problem);
    assert_eq!(answer.status, Status::Stands, "{:?}", answer.notes);
    answer.status = Status::NoEquilibrium;
    refused(&problem, false, answer, "no mechanism");
}

/// Gaps that do not belong to the motion are refused, also with finite displacements.
#[test]
fn gaps_of_another_motion_are_refused() {
    let mut answer = followed(&pushed(0.2), None);
    assert_eq!(confirmed(&pushed(0.2), true, answer.clone()).status, Status::Stands);
    answer.state.gap[0][1] += 1e-6;
    refused(&pushed(0.2), true, answer, "path_kinematics");
}

/// After a refused claim the answer shows the last state of the path.
#[test]
fn a_refused_claim_shows_the_last_state() {
    let mut answer = traced(&pushed(0.25));
    answer.last = Some(answer.state.clone());
    answer.state.force[0][0] *= 2.0;
    let last = answer.state.factor;
    let found = confirmed(&pushed(0.25), false, answer);
    assert_eq!((found.status, found.last.is_none()), (Status::Stalled, true));
    assert_eq!(found.state.factor, last);
    assert!((found.state.force[0][0] - 0.5).abs() < 0.1, "{:?}", found.state.force);
}
