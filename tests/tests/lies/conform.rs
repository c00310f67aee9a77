//! `conform` and a solver whose own statements are false although no certificate accepts them.

use serde::{Deserialize, Serialize};
use serde_json::json;
use voussoir::conformance::{Options, conform};
use voussoir::core::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, Status};
use voussoir::core::plugin::{Capability, Card, PluginKind, card};
use voussoir::core::{inventory, typetag};

/// Finds every collapse and reports `stands`.
#[derive(Debug, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct CallsItStanding {}

fn honest() -> Box<dyn LimitSolver> {
    serde_json::from_value(json!({ "solver": "limit_conic" })).expect("a solver")
}

#[typetag::serde(name = "calls_it_standing")]
impl LimitSolver for CallsItStanding {
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
        let answer = honest().solve(problem, question);
        match answer.status {
            Status::Collapse => LimitAnswer { status: Status::Stands, motion: None, ..answer },
            _ => answer,
        }
    }

    fn refuses(&self, problem: &LimitProblem) -> Option<String> {
        honest().refuses(problem)
    }
}

inventory::submit! {
    Card {
        kind: PluginKind::LimitSolver,
        tag: "calls_it_standing",
        summary: "calls every collapse standing",
        requires: &[&[Capability::FACETS], &[Capability::RIGID_LIMIT]],
        file: file!(),
        page: "# `calls_it_standing`\n\nA lie.\n",
        ..Card::BLANK
    }
}

#[test]
fn a_solver_that_states_what_is_false_does_not_conform() {
    let report = conform(card(PluginKind::LimitSolver, "calls_it_standing").expect("a card"), &Options::default());
    assert!(report.fails("own_answer") && !report.fails("truth"), "{report}");
}
