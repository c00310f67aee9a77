//! `limit_sequential`: a non-associated load by sequential linear programming.

use super::sequence::{Sequence, sequence};
use crate::limit::associated::{NO_ENVELOPES, associated, associated_bound, settled_by_association};
use crate::limit::settlement::settle;
use voussoir_core::law::FlowRule;
use voussoir_core::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, SettlementAnswer, Status, combined};
use voussoir_core::model::Wrenches;
use voussoir_core::plugin::{Capability, Card, Keys, PluginKind};

/// Sequential linear programming.
#[derive(Debug, Clone, Default, Keys)]
pub struct LimitSequential {}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LimitSolver,
        tag: "limit_sequential",
        summary: "a load factor with the flow rules of the laws, by sequential linear programs with fictitious cohesion",
        requires: &[&[Capability::FACETS], &[Capability::RIGID_LIMIT]],
        sources: &["Gilbert, Casapulla & Ahmed 2006, Computers & Structures 84"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("limit_sequential.md"),
        ..Card::of::<LimitSequential>()
    }
}

#[typetag::serde(name = "limit_sequential")]
impl LimitSolver for LimitSequential {
    fn solve(&self, problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
        let mut answer = associated(problem, question);
        let own = associated_bound(&answer);
        answer.non_associated = Some(own);
        if settled_by_association(problem, question, &answer) {
            return answer;
        }
        let LimitQuestion::Collapse { start, max } = question else { return answer };
        let base = combined(&problem.fixed, &problem.varying, start);
        let from = answer.field.clone().unwrap_or_default();
        match sequence(problem, &base, &from, &mut answer.counters) {
            Sequence::Converged(state) if start + state.factor <= max => {
                answer.status = Status::Collapse;
                answer.factor = Some(start + state.factor);
                answer.field_factor = start + state.factor;
                answer.field = Some(state.field);
                answer.motion = Some(state.motion);
                answer.unique = None;
                answer.ray = None;
            }
            Sequence::Converged(_) => {}
            Sequence::Open(why) => {
                let admissible = if answer.factor.is_some() {
                    format!(
                        "an admissible field is known up to the associated load factor {:.9}: no collapse load lies above",
                        answer.field_factor
                    )
                } else {
                    format!("an admissible field is known at the factor {:.9}", answer.field_factor)
                };
                answer.status = Status::Stalled;
                answer.factor = None;
                answer.notes.extend([why, admissible]);
            }
        }
        answer
    }

    fn settle(&self, problem: &LimitProblem, loads: &Wrenches, openings: &[[f64; 3]]) -> SettlementAnswer {
        settle(problem, loads, openings, FlowRule::NonAssociated)
    }

    fn refuses(&self, problem: &LimitProblem) -> Option<String> {
        problem.has_envelopes().then(|| NO_ENVELOPES.into())
    }
}
