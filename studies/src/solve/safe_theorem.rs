//! Where an admissible field proves that a structure stands: the safe theorem of limit analysis.

use crate::results::{CaseResult, Proof};
use voussoir_core::law::is_associated;
use voussoir_core::limit::Status;
use voussoir_core::model::{Assembly, Bond};

/// Whether an admissible field proves that a structure stands: associated flow, and nothing softens or yields in blocks.
pub(super) fn safe_theorem_holds(assembly: &Assembly) -> bool {
    let associated = |bond: Bond| match bond {
        Bond::Bonded => true,
        Bond::Law(law) => assembly.catalogue.laws[law].1.facets().is_some_and(|facets| is_associated(&facets)),
    };
    let yields = (0..assembly.bodies.len()).any(|body| !assembly.bodies[body].fixed && assembly.yields(body));
    !yields && assembly.joints.iter().all(|joint| associated(joint.bond))
}

/// What proves that a case stands that limit analysis answers: its field, where that is a proof.
pub(super) fn static_proof(assembly: &Assembly, result: &CaseResult) -> Option<Proof> {
    let stands = result.status == Status::Stands && result.certificate.passed;
    (stands && safe_theorem_holds(assembly)).then_some(Proof::Static)
}
