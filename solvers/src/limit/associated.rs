//! Associated flow as the first answer where laws flow otherwise: an upper bound.

use super::chain::LimitChain;
use super::conic::LimitConic;
use voussoir_core::limit::{LimitAnswer, LimitProblem, LimitQuestion, LimitSolver, NonAssociated, Status};

/// The answer with associated flow, by the cheapest engine.
pub fn associated(problem: &LimitProblem, question: LimitQuestion) -> LimitAnswer {
    let chain = LimitChain {};
    let answered = (chain.refuses(problem).is_none()).then(|| chain.solve(problem, question));
    match answered {
        Some(answer) if answer.status != Status::Stalled => answer,
        _ => LimitConic {}.solve(problem, question),
    }
}

/// Whether the question is answered by associated flow already: nothing to collapse, nothing that
/// flows otherwise.
pub fn settled_by_association(problem: &LimitProblem, question: LimitQuestion, answer: &LimitAnswer) -> bool {
    let searched = matches!(question, LimitQuestion::Collapse { .. })
        && matches!(answer.status, Status::Collapse | Status::Stands | Status::Unbounded);
    !searched || !problem.non_associated || problem.magnitude(&problem.varying) == 0.0
}

/// What an associated answer says of flow by the laws themselves.
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
