//! The solver `limit_cones`.

use super::settlement::settle;
use super::solve::solve;
use voussoir_core::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver};
use voussoir_core::plugin::{Capability, Card, Keys, PluginKind};
use voussoir_core::space::{SpaceAnswer, SpaceField, SpaceProblem, SpaceSettled};

/// Limit analysis of scenes in space.
#[derive(Debug, Clone, Default, Keys)]
pub struct LimitCones {}

/// The reason why it solves no plane scene.
const IN_SPACE: &str = "it solves scenes in space only";

#[typetag::serde(name = "limit_cones")]
impl LimitSolver for LimitCones {
    fn solve(&self, _: &LimitProblem, _: LimitQuestion) -> LimitAnswer {
        LimitAnswer::stalled(IN_SPACE)
    }

    fn refuses(&self, _: &LimitProblem) -> Option<String> {
        Some(IN_SPACE.into())
    }

    fn solve_space(&self, problem: &SpaceProblem, question: LimitQuestion) -> Option<SpaceAnswer> {
        Some(solve(problem, question))
    }

    fn settle_space(&self, problem: &SpaceProblem, openings: &SpaceField) -> SpaceSettled {
        settle(problem, openings)
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LimitSolver,
        tag: "limit_cones",
        summary: "limit analysis of blocks in space by an interior-point method on friction cones, with repaired proofs",
        provides: &[Capability::SPACE],
        requires: &[&[Capability::CONE]],
        cost: Some(25),
        sources: &[
            "Nesterov & Todd 1997, Math. Oper. Res. 22 (scaling)",
            "Andersen, Roos & Terlaky 2003, Math. Program. 95 (second-order cones)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("limit_cones.md"),
        ..Card::of::<LimitCones>()
    }
}
