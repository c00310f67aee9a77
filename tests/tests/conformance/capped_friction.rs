//! `capped_friction`: associated friction with a crushing strength.

use serde::{Deserialize, Serialize};
use voussoir_core::law::{Facet, InterfaceLaw};
use voussoir_core::plugin::{Capability, Card, KnownPath, Parameter, PluginKind, Property, Quantity, Range, Sample};

/// Associated friction with a crushing strength.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CappedFriction {
    /// μ.
    pub friction: f64,
    /// f_c \[Pa\].
    pub compressive_strength: f64,
    /// k \[Pa/m\], the same against closing and slip; without it the joint itself is stiff.
    pub stiffness: Option<f64>,
}

#[typetag::serde(name = "capped_friction")]
impl InterfaceLaw for CappedFriction {
    fn facets(&self) -> Option<Vec<Facet>> {
        let [left, right] = Facet::friction(self.friction, 0.0, self.friction);
        Some(vec![Facet::opening(0.0), left, right, Facet::crushing(self.compressive_strength)])
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        self.stiffness.map(|k| [k, k])
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "capped_friction",
        summary: "associated friction that crushes",
        parameters: &[
            Parameter::number("friction", Quantity::Ratio, Range::NON_NEGATIVE, "coefficient of friction μ"),
            Parameter::number("compressive_strength", Quantity::Stress, Range::POSITIVE, "crushing strength f_c"),
            Parameter::number("stiffness", Quantity::Stiffness, Range::POSITIVE, "stiffness k of the joint itself")
                .optional("the joint itself is stiff"),
        ],
        provides: &[Capability::FACETS, Capability::RESPONSE],
        claims: &[Property::ASSOCIATED, Property::DISSIPATIVE],
        samples: &[Sample::new("friction = 0.6\ncompressive_strength = 5e6\nstiffness = 1e10", 1e-3, &["elastic", "sliding"])],
        known_paths: &[KnownPath {
            table: "friction = 0.6\ncompressive_strength = 5e6\nstiffness = 1e10",
            source: "by hand: crushed at f_c, then back with k",
            steps: &[(&[-1e-3, 0.0], &[5e6, 0.0]), (&[-8e-4, 0.0], &[3e6, 0.0])],
            tolerance: 1e-12,
        }],
        sources: &["where the equations come from"],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `capped_friction`\n\nPurpose, equations, regimes, state, validity, sources.\n",
        ..Card::BLANK
    }
}
