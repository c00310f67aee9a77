//! Where an admissible field proves that a structure stands: the safe theorem of limit analysis.

use crate::results::{CaseResult, Proof};
use voussoir_core::law::{Facet, is_associated};
use voussoir_core::limit::Status;
use voussoir_core::model::{Assembly, Bond};

/// Whether joints and blocks keep their strengths: joints of facets, and no block that yields.
pub(super) fn is_without_softening(assembly: &Assembly) -> bool {
    let yields = (0..assembly.bodies.len()).any(|body| !assembly.bodies[body].fixed && assembly.yields(body));
    !yields && facets_of_joints(assembly).all(|facets| facets.is_some())
}

/// Whether an admissible field proves that a structure stands: associated flow, and nothing softens or yields in blocks.
pub(crate) fn safe_theorem_holds(assembly: &Assembly) -> bool {
    is_without_softening(assembly) && facets_of_joints(assembly).flatten().all(|facets| is_associated(&facets))
}

/// Facets of all joints that are not bonded; `None` for a law that has none.
fn facets_of_joints(assembly: &Assembly) -> impl Iterator<Item = Option<Vec<Facet>>> {
    assembly.joints.iter().filter_map(|joint| match joint.bond {
        Bond::Bonded => None,
        Bond::Law(law) => Some(assembly.catalogue.laws[law].1.facets()),
    })
}

/// What proves that a case stands that limit analysis answers: its field, where that is a proof.
pub(super) fn static_proof(assembly: &Assembly, result: &CaseResult) -> Option<Proof> {
    let stands = result.status == Status::Stands && result.certificate.passed;
    (stands && safe_theorem_holds(assembly)).then_some(Proof::Static)
}
