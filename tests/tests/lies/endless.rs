//! Solvers that do not end. One never returns: code in the same process cannot stop it, so `conform` gives up after a
//! time. The other one reports the same state 20,000 times.

use serde::{Deserialize, Serialize};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;
use voussoir::conformance::lies::{LIMIT_SCENES, PATH_SCENES, answered_within};
use voussoir::core::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, Status};
use voussoir::core::path::{PathAnswer, PathObserver, PathProblem, PathSettings, PathSolver, PathState};
use voussoir::core::plugin::{Capability, Card, PluginKind};
use voussoir::core::{inventory, typetag};
use voussoir::solvers::limit::conic::LimitConic;
use voussoir::solvers::path::event::EventPath;

/// Stops the endless solver at the end of its test.
static ENDED: AtomicBool = AtomicBool::new(false);

#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct Endless {}

#[typetag::serde(name = "endless")]
impl LimitSolver for Endless {
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
        while !ENDED.load(Ordering::Relaxed) {
            std::thread::sleep(Duration::from_millis(5));
        }
        LimitConic {}.solve(problem, question)
    }

    fn refuses(&self, _: &LimitProblem) -> Option<String> {
        None
    }
}

/// Reports the first state of the path until the observer stops it.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SameState {}

/// Stores the states.
#[derive(Default)]
struct Kept(Vec<PathState>);

impl PathObserver for Kept {
    fn state(&mut self, _: &PathProblem, state: &PathState) -> bool {
        self.0.push(state.clone());
        true
    }
}

/// Greatest number of reports of the state.
const TIMES: usize = 20_000;

#[typetag::serde(name = "same_state")]
impl PathSolver for SameState {
    fn trace(&self, problem: &PathProblem, settings: &PathSettings, observer: &mut dyn PathObserver) -> PathAnswer {
        let mut kept = Kept::default();
        let mut answer = EventPath {}.trace(problem, settings, &mut kept);
        for state in &kept.0[..4] {
            observer.state(problem, state);
        }
        for _ in 0..TIMES {
            if !observer.state(problem, &kept.0[3]) {
                break;
            }
        }
        (answer.status, answer.factor, answer.state) = (Status::Stands, None, kept.0[3].clone());
        answer
    }

    fn refuses(&self, _: &PathProblem, _: &PathSettings) -> Option<String> {
        None
    }
}

const LIAR: Card = Card { summary: "a lie", file: file!(), page: "# A lie\n\nNever ends.\n", ..Card::BLANK };

inventory::submit! {
    Card {
        kind: PluginKind::LimitSolver,
        tag: "endless",
        requires: &[&[Capability::FACETS], &[Capability::RIGID_LIMIT]],
        ..LIAR
    }
}

inventory::submit! {
    Card { kind: PluginKind::PathSolver, tag: "same_state", requires: &[&[Capability::FACETS]], ..LIAR }
}

#[test]
fn a_solver_that_never_returns_is_given_up() {
    let case = LIMIT_SCENES[0].case("solver = \"endless\"").expect("a case");
    assert!(answered_within(Duration::from_millis(300), case).is_none());
    ENDED.store(true, Ordering::Relaxed);
}

#[test]
fn a_state_that_is_shown_again_and_again_proves_nothing() {
    let scene = &PATH_SCENES[1];
    let case = scene.case("solver = \"same_state\"").expect("a case");
    let result = answered_within(Duration::from_secs(60), case).expect("an answer");
    let wrong = scene.truth.contradictions(&result, None);
    assert!(wrong.is_empty(), "{}", wrong.join("; "));
}
