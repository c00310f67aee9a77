//! Facets with one fault each.

use super::every_fault_is_found;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use voussoir::core::law::{Facet, FacetMode, FacetResponse, InterfaceLaw, InterfaceResponse};
use voussoir::core::plugin::{
    Capability, Card, KnownPath, Need, Parameter, PluginKind, Property, Quantity, Range, Sample, Shape,
};

/// Associated friction with cohesion and crushing.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MutantFacets {
    fault: String,
    friction: f64,
    cohesion: f64,
    compressive_strength: f64,
    normal_stiffness: f64,
    shear_stiffness: f64,
}

impl MutantFacets {
    fn sound(&self) -> Vec<Facet> {
        let [left, right] = Facet::friction(self.friction, self.cohesion, self.friction);
        vec![Facet::opening(0.25 * self.cohesion), left, right, Facet::crushing(self.compressive_strength)]
    }
}

#[typetag::serde(name = "mutant_facets")]
impl InterfaceLaw for MutantFacets {
    fn facets(&self) -> Option<Vec<Facet>> {
        let mut facets = self.sound();
        match self.fault.as_str() {
            "friction_of_the_wrong_sign" => facets[1..3].iter_mut().for_each(|facet| {
                facet.normal[0] *= -1.0;
                facet.flow[0] *= -1.0;
            }),
            "normal_flipped" => (facets[0].normal, facets[0].flow) = ([1.0, 0.0], [1.0, 0.0]),
            "crushing_flipped" => (facets[3].normal, facets[3].flow) = ([-1.0, 0.0], [-1.0, 0.0]),
            "no_bound_of_tension" => drop(facets.drain(..3)),
            "associated_claimed_and_untrue" => facets[1..3].iter_mut().for_each(|facet| facet.flow[0] = 0.0),
            "dilates_more_than_friction_takes" => facets[1..3].iter_mut().for_each(|facet| facet.flow[0] *= 3.0),
            "inadmissible_origin" => facets[0].bound = -1e5,
            "called_what_it_is_not" => facets[0].mode = FacetMode::Crushing,
            "not_a_number" => facets[1].bound = f64::NAN,
            "panics" => panic!("on purpose"),
            _ => {}
        }
        Some(facets)
    }

    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        let (mut facets, mut stiffness) = (self.sound(), [self.normal_stiffness, self.shear_stiffness]);
        match self.fault.as_str() {
            "response_of_another_strength" => facets[1].bound *= 1.5,
            "response_of_another_flow" => facets[1..3].iter_mut().for_each(|facet| facet.flow[0] *= 0.5),
            "stiffness_of_another_joint" => stiffness[1] *= 2.0,
            _ => {}
        }
        Some(Arc::new(FacetResponse::new(facets, stiffness)?))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        (self.fault != "no_stiffness").then_some([self.normal_stiffness, self.shear_stiffness])
    }
}

const CARD: Card = Card {
    kind: PluginKind::InterfaceLaw,
    tag: "mutant_facets",
    summary: "for this test",
    parameters: &[
        Parameter { name: "fault", doc: "which", shape: Shape::Text, need: Need::Required },
        Parameter::number("friction", Quantity::Ratio, Range::NON_NEGATIVE, "μ"),
        Parameter::number("cohesion", Quantity::Stress, Range::POSITIVE, "c"),
        Parameter::number("compressive_strength", Quantity::Stress, Range::POSITIVE, "f_c"),
        Parameter::number("normal_stiffness", Quantity::Stiffness, Range::POSITIVE, "k_n"),
        Parameter::number("shear_stiffness", Quantity::Stiffness, Range::POSITIVE, "k_t"),
    ],
    provides: &[Capability::FACETS, Capability::RESPONSE],
    claims: &[Property::ASSOCIATED, Property::DISSIPATIVE],
    known_paths: &[KnownPath {
        table: TABLE,
        source: "by hand",
        steps: &[(&[-1e-3, 0.0], &[5e6, 0.0]), (&[-8e-4, 0.0], &[3e6, 0.0])],
        tolerance: 1e-12,
    }],
    sources: &["this test"],
    file: file!(),
    page: "for this test",
    ..Card::BLANK
};

const TABLE: &str =
    "friction = 0.6\ncohesion = 4e5\ncompressive_strength = 5e6\nnormal_stiffness = 1e10\nshear_stiffness = 5e9";

#[test]
fn facets_with_a_fault_are_found() {
    let sample = Sample::new("", 2e-4, &["elastic", "sliding"]);
    let faults: [(&str, &[&str]); 14] = [
        ("friction_of_the_wrong_sign", &["friction"]),
        ("normal_flipped", &["normal"]),
        ("crushing_flipped", &["normal"]),
        ("no_bound_of_tension", &["normal"]),
        ("associated_claimed_and_untrue", &["associated", "facets_and_response"]),
        ("dilates_more_than_friction_takes", &["dissipation"]),
        ("inadmissible_origin", &["facets"]),
        ("called_what_it_is_not", &["normal"]),
        ("not_a_number", &["facets"]),
        ("panics", &["panic"]),
        ("response_of_another_strength", &["facets_and_response"]),
        ("response_of_another_flow", &["facets_and_response"]),
        ("stiffness_of_another_joint", &["stiffness"]),
        ("no_stiffness", &["stiffness"]),
    ];
    every_fault_is_found(&CARD, TABLE, sample, &faults);
}
