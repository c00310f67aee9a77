//! The cone of a joint law for contacts in space: it agrees with the facets of the law in a plane through its axis.

use super::findings::Recorder;
use voussoir_core::law::{Facet, FacetMode, FrictionCone};
use voussoir_core::plugin::{Capability, Card};

/// Checks a cone, and that the facets of the law are its section.
pub(super) fn check(recorder: &mut Recorder, card: &Card, facets: Option<&[Facet]>, cone: Option<FrictionCone>) {
    recorder.hold("cone", cone.is_some() || !card.offers(Capability::CONE), || {
        "the card offers a cone of isotropic friction, but the law gives none".into()
    });
    let Some(cone) = cone else { return };
    let FrictionCone { friction, dilatancy, cohesion, tensile_strength, compressive_strength } = cone;
    let finite = [friction, dilatancy, cohesion, tensile_strength].iter().all(|x| x.is_finite() && *x >= 0.0);
    recorder.hold("cone", finite && compressive_strength > 0.0 && dilatancy <= friction, || {
        format!("{cone:?} is no cone: numbers must not be negative, and the dilatancy is at most the friction")
    });
    let Some(facets) = facets else { return };
    let wrong = facets.iter().find(|facet| !is_section(facet, &cone));
    recorder.hold("cone", wrong.is_none(), || {
        format!("the facet {:?} is not a section of {cone:?}", wrong.expect("it is wrong"))
    });
    let slides = facets.iter().filter(|facet| facet.mode == FacetMode::Sliding).count();
    recorder.hold("cone", slides == 2, || format!("the cone bounds sliding in both senses, but {slides} facets do"));
    let crushes = facets.iter().any(|facet| facet.mode == FacetMode::Crushing);
    recorder.hold("cone", crushes == compressive_strength.is_finite(), || {
        "either the facets or the cone bound compression".into()
    });
}

/// Returns true if a facet, with its flow, is a section of the cone.
fn is_section(facet: &Facet, cone: &FrictionCone) -> bool {
    let expected = match facet.mode {
        FacetMode::Opening => vec![Facet::opening(cone.tensile_strength)],
        FacetMode::Crushing => vec![Facet::crushing(cone.compressive_strength)],
        FacetMode::Sliding => Facet::friction(cone.friction, cone.cohesion, cone.dilatancy).to_vec(),
    };
    expected.contains(facet)
}
