//! The solver `limit_conic`.

use super::engine::ConicEngine;
use super::envelope::EnvelopeEngine;
use crate::limit::settlement::settle;
use crate::space::{settle_in_space, solve_by_clarabel};
use voussoir_core::law::FlowRule;
use voussoir_core::limit::{
    Engine, LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, SettlementAnswer, answer_by,
};
use voussoir_core::model::Wrenches;
use voussoir_core::plugin::{Capability, Card, Keys, PluginKind};
use voussoir_core::space::{SpaceAnswer, SpaceField, SpaceProblem, SpaceSettled};

/// Limit analysis of any scene.
#[derive(Debug, Clone, Default, Keys)]
pub struct LimitConic {}

#[typetag::serde(name = "limit_conic")]
impl LimitSolver for LimitConic {
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
        answer_by(problem, question, engine(problem).as_mut())
    }

    fn settle(&self, problem: &LimitProblem, loads: &Wrenches, openings: &[[f64; 3]]) -> SettlementAnswer {
        settle(problem, loads, openings, FlowRule::Associated)
    }

    fn solve_space(&self, problem: &SpaceProblem, question: LimitQuestion) -> Option<SpaceAnswer> {
        Some(solve_by_clarabel(problem, question))
    }

    fn settle_space(&self, problem: &SpaceProblem, openings: &SpaceField) -> SpaceSettled {
        settle_in_space(problem, openings)
    }

    fn refuses(&self, _: &LimitProblem) -> Option<String> {
        None
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LimitSolver,
        tag: "limit_conic",
        summary: "limit analysis of any scene by sparse conic programming, polished to rounding",
        requires: &[&[Capability::FACETS], &[Capability::RIGID_LIMIT]],
        provides: &[Capability::SPACE],
        cost: Some(30),
        sources: &["Goulart & Chen 2024, Clarabel", "Stellato et al. 2020, OSQP (polishing)"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("limit_conic.md"),
        ..Card::of::<LimitConic>()
    }
}

/// Creates the engine for a problem.
pub fn engine(problem: &LimitProblem) -> Box<dyn Engine + '_> {
    if problem.has_envelopes() { Box::new(EnvelopeEngine::new(problem)) } else { Box::new(ConicEngine::new(problem)) }
}
