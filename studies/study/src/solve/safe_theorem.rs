//! The safe theorem of limit analysis: conditions under which an admissible field proves that a structure stands.

use crate::results::{CaseResult, Proof};
use voussoir_core::law::{Facet, is_associated};
use voussoir_core::limit::Status;
use voussoir_core::model::{Assembly, Bond};

/// Returns true if joints and blocks keep their strengths: joints have facets, and no block yields.
pub(super) fn is_without_softening(assembly: &Assembly) -> bool {
    let yields = (0..assembly.bodies.len()).any(|body| !assembly.bodies[body].fixed && assembly.yields(body));
    !yields && facets_of_joints(assembly).all(|facets| facets.is_some())
}

/// Returns true if an admissible field proves that a structure stands: flow is associated, and no joint softens and no block
/// yields.
pub(crate) fn safe_theorem_holds(assembly: &Assembly) -> bool {
    is_without_softening(assembly) && facets_of_joints(assembly).flatten().all(|facets| is_associated(&facets))
}

/// Returns the facets of all joints that are not bonded; `None` for a law without facets.
fn facets_of_joints(assembly: &Assembly) -> impl Iterator<Item = Option<Vec<Facet>>> {
    assembly.joints.iter().filter_map(|joint| match joint.bond {
        Bond::Bonded => None,
        Bond::Law(law) => Some(assembly.catalogue.laws[law].1.facets()),
    })
}

/// Returns the proof that a case solved by limit analysis stands: its field, if a field is a proof.
pub(super) fn static_proof(assembly: &Assembly, result: &CaseResult) -> Option<Proof> {
    let stands = result.status == Status::Stands && result.certificate.passed;
    (stands && safe_theorem_holds(assembly)).then_some(Proof::Static)
}
