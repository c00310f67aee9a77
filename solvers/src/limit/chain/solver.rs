//! The solver `limit_chain`.

use super::engine::ChainEngine;
use super::layout::trees;
use crate::limit::conic::LimitConic;
use crate::limit::settlement::settle;
use voussoir_core::law::FlowRule;
use voussoir_core::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, SettlementAnswer, answer_by};
use voussoir_core::model::Wrenches;
use voussoir_core::plugin::{Capability, Card, Keys, PluginKind};

/// Limit analysis in few redundants.
#[derive(Debug, Clone, Default, Keys)]
pub struct LimitChain {}

#[typetag::serde(name = "limit_chain")]
impl LimitSolver for LimitChain {
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
        match ChainEngine::new(problem) {
            Some(mut engine) => answer_by(problem, question, &mut engine),
            None => LimitConic {}.solve(problem, question),
        }
    }

    fn settle(&self, problem: &LimitProblem, loads: &Wrenches, openings: &[[f64; 3]]) -> SettlementAnswer {
        settle(problem, loads, openings, FlowRule::Associated)
    }

    fn refuses(&self, problem: &LimitProblem) -> Option<String> {
        trees(problem).is_none().then(|| {
            "more than a few joints close its bodies to rings, fill resists, or several facets bound sliding in one sense; \
             limit_conic takes any scene"
                .into()
        })
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LimitSolver,
        tag: "limit_chain",
        summary: "limit analysis of arches, viaducts and other scenes with few closed rings, by simplex in the redundant forces and λ, exact to rounding",
        requires: &[&[Capability::FACETS], &[Capability::RIGID_LIMIT]],
        cost: Some(20),
        sources: &["Livesley 1978, Int. J. Numer. Meth. Engng 12", "Dantzig 1963, Linear Programming and Extensions"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("limit_chain.md"),
        ..Card::of::<LimitChain>()
    }
}
