//! `limit_sequential`: a non-associated load by sequential linear programming.

use super::sequence::{Sequence, sequence};
use crate::limit::associated::{NO_ENVELOPES, associated, associated_bound, settled_by_association};
use crate::limit::settlement::settle;
use crate::space::{settle_in_space, solve, solve_with_own_flow};
use voussoir_core::law::FlowRule;
use voussoir_core::limit::{
    LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, LowerProof, LowerProofKind, SettlementAnswer, Status,
    combined,
};
use voussoir_core::model::Wrenches;
use voussoir_core::plugin::{Capability, Card, Keys, PluginKind};
use voussoir_core::space::{SpaceAnswer, SpaceField, SpaceProblem, SpaceSettled};

/// Sequential linear programming.
#[derive(Debug, Clone, Default, Keys)]
pub struct LimitSequential {}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::LimitSolver,
        tag: "limit_sequential",
        summary: "a load factor with the flow rules of the laws, by sequential linear programs with fictitious cohesion",
        provides: &[Capability::SPACE],
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
        let Sequence { state, open } = sequence(problem, &base, &from, &mut answer.counters);
        let converged = open.is_none();
        answer.notes.extend(open);
        match state {
            Some(state) if start + state.factor <= max => {
                // With a lower end at the start, which proves nothing, the result is open and the state is its upper end.
                if let Some(own) = answer.non_associated.as_mut().filter(|_| !converged) {
                    own.proved_lower = Some(start);
                    own.lower_proof = Some(LowerProof::by(LowerProofKind::Start));
                }
                answer.status = Status::Collapse;
                answer.factor = Some(start + state.factor);
                answer.field_factor = start + state.factor;
                answer.field = Some(state.field);
                answer.motion = Some(state.motion);
                answer.unique = None;
                answer.ray = None;
            }
            Some(_) => {}
            None => {
                answer.notes.push(admissible_up_to(&answer));
                answer.status = Status::Stalled;
                answer.factor = None;
            }
        }
        answer
    }

    fn settle(&self, problem: &LimitProblem, loads: &Wrenches, openings: &[[f64; 3]]) -> SettlementAnswer {
        settle(problem, loads, openings, FlowRule::NonAssociated)
    }

    fn solve_space(&self, problem: &SpaceProblem, question: LimitQuestion) -> Option<SpaceAnswer> {
        Some(solve_with_own_flow(problem, question, solve))
    }

    fn settle_space(&self, problem: &SpaceProblem, openings: &SpaceField) -> SpaceSettled {
        settle_in_space(problem, openings)
    }

    fn refuses(&self, problem: &LimitProblem) -> Option<String> {
        problem.has_envelopes().then(|| NO_ENVELOPES.into())
    }
}

/// Returns up to which factor an associated answer has an admissible field.
fn admissible_up_to(answer: &LimitAnswer) -> String {
    let at = answer.field_factor;
    if answer.factor.is_some() {
        format!("an admissible field is known up to the associated load factor {at:.9}: no collapse load lies above")
    } else {
        format!("an admissible field is known at the factor {at:.9}")
    }
}
