//! Associated flow as the first answer for laws with non-associated flow: an upper bound.

use super::chain::LimitChain;
use super::conic::LimitConic;
use voussoir_core::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, NonAssociated, Status};

/// Reason of solvers that read one sliding facet in each sense.
pub const NO_ENVELOPES: &str =
    "several facets of a joint law bound sliding in one sense: limit_conic supports this with associated flow";

/// Returns the answer with associated flow, from the cheapest engine.
pub fn associated(problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
    let chain = LimitChain {};
    let answered = (chain.refuses(problem).is_none()).then(|| chain.solve(problem, question));
    match answered {
        Some(answer) if answer.status != Status::Stalled => answer,
        _ => LimitConic {}.solve(problem, question),
    }
}

/// Returns true if associated flow already answers the question: no collapse load exists, or all flow is associated.
pub fn settled_by_association(problem: &LimitProblem, question: LimitQuestion, answer: &LimitAnswer) -> bool {
    let searched = matches!(question, LimitQuestion::Collapse { .. })
        && matches!(answer.status, Status::Collapse | Status::Stands | Status::Unbounded);
    !searched || !problem.non_associated || problem.magnitude(&problem.varying) == 0.0
}

/// Returns the part of an associated answer that holds for the flow of the laws themselves.
pub fn associated_bound(answer: &LimitAnswer) -> NonAssociated {
    let collapse = answer.status == Status::Collapse;
    NonAssociated {
        proved_lower: None,
        lower_proof: None,
        bracket: Vec::new(),
        associated_factor: answer.factor.filter(|_| collapse),
        associated_motion: answer.motion.clone().filter(|_| collapse),
        associated_field: answer.field.clone().filter(|_| collapse),
    }
}
