//! Bodies with yielding material: their linearisation within a step, and their history.

use std::rc::Rc;
use std::sync::Arc;
use voussoir_core::elastic::{InelasticState, Linearisation};
use voussoir_core::path::{PathProblem, Yielded};

/// A body with yielding material within a step.
#[derive(Debug, Clone)]
pub struct YieldingBlock {
    /// Linearisation at the present displacements of its nodes.
    pub linear: Rc<Linearisation>,
    /// History at the start of the step.
    pub base: Arc<InelasticState>,
}

/// Returns all bodies that may yield, undeformed.
pub fn undeformed(problem: &PathProblem) -> Result<Vec<Option<YieldingBlock>>, String> {
    if !problem.yields() {
        return Ok(Vec::new());
    }
    let body = |body: &voussoir_core::path::PathBody| {
        let Some(inelastic) = &body.inelastic else { return Ok(None) };
        let base = Arc::new(inelastic.initial());
        let linear = Rc::new(inelastic.linearise(vec![0.0; 2 * inelastic.nodes()], &base)?);
        Ok(Some(YieldingBlock { linear, base }))
    };
    problem.bodies.iter().map(body).collect()
}

/// Returns the states of the bodies that have yielded, for results.
pub fn yielded(blocks: &[Option<YieldingBlock>]) -> Vec<Option<Yielded>> {
    let record = |inner: &YieldingBlock| {
        let (displacement, state) = (inner.linear.displacement.clone(), inner.linear.end.clone());
        state.yielded.then_some(Yielded { displacement, state })
    };
    blocks.iter().map(|inner| inner.as_ref().and_then(record)).collect()
}
