//! Claims of a status in an answer.

use crate::path::outcome::Outcome;
use crate::path::two_blocks::{block, pushed_at, traced};
use voussoir_core::limit::Status;
use voussoir_core::path::PathAnswer;

/// An answer has its claim from the outcome and all other data from the record.
#[test]
fn an_answer_joins_outcome_and_record() {
    let motion = vec![[0.0; 3], [1.0, 0.0, 0.0]];
    let record = PathAnswer { load_step: 3, notes: vec!["a note".into()], ..PathAnswer::default() };
    let answer = Outcome::at(Status::Collapse, Some(0.3)).moving(Some(motion.clone())).unconfirmed(record);
    assert_eq!((answer.status, answer.factor, answer.load_step), (Status::Collapse, Some(0.3), 3));
    assert_eq!((answer.motion, answer.ray), (Some(motion), None));
    assert_eq!(answer.notes, ["a note"]);
}

/// A ray is a claim like a mechanism.
#[test]
fn a_ray_is_carried_into_the_answer() {
    let ray = vec![[0.5, 0.0]; 2];
    let answer = Outcome::at(Status::Unbounded, None).carried_by(Some(ray.clone())).unconfirmed(PathAnswer::default());
    assert_eq!((answer.ray, answer.motion), (Some(ray), None));
}

/// A stall claims no factor, and its note gives the reason.
#[test]
fn a_stall_claims_nothing() {
    let answer = PathAnswer::stalled("because");
    assert_eq!((answer.status, answer.factor), (Status::Stalled, None));
    assert!(answer.motion.is_none() && answer.ray.is_none() && answer.events.is_empty());
    assert_eq!(answer.notes, ["because"]);
}

/// An outcome that is checked again keeps a claim that holds.
#[test]
fn a_claim_that_holds_is_kept() {
    let problem = block(0.3, pushed_at(0.1));
    let honest = traced(&problem);
    let record = PathAnswer { load_step: honest.load_step, state: honest.state, ..PathAnswer::default() };
    let answer = Outcome::at(Status::Collapse, honest.factor).moving(honest.motion).answer(&problem, false, record);
    assert_eq!((answer.status, answer.factor), (Status::Collapse, honest.factor), "{:?}", answer.notes);
}
