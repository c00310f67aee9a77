//! `keyed`: a dry joint with shear keys.
#![doc = include_str!("keyed.md")]

use serde::{Deserialize, Serialize};
use voussoir_core::law::{Facet, InterfaceLaw};
use voussoir_core::plugin::{Capability, Card, KnownPath, Parameter, PluginKind, Property, Quantity, Range, Sample};

/// Friction and keys; no tension.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Keyed {
    /// μ.
    pub friction: f64,
    /// c \[Pa\].
    pub key_strength: f64,
    /// k_n \[Pa/m\].
    pub normal_stiffness: Option<f64>,
    /// k_t \[Pa/m\].
    pub shear_stiffness: Option<f64>,
}

#[typetag::serde(name = "keyed")]
impl InterfaceLaw for Keyed {
    fn facets(&self) -> Option<Vec<Facet>> {
        let [left, right] = Facet::friction(self.friction, self.key_strength, 0.0);
        Some(vec![Facet::opening(0.0), left, right])
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        Some([self.normal_stiffness?, self.shear_stiffness?])
    }
}

/// Pressed to 1 MPa, slipped at c + μ t_n, back within stick.
const KNOWN_PATHS: &[KnownPath] = &[KnownPath {
    table: "friction = 0.5\nkey_strength = 2e5\nnormal_stiffness = 1e10\nshear_stiffness = 5e9",
    source: "by hand: stick with k_t, slip at c + μ t_n at constant volume",
    steps: &[
        (&[-1e-4, 0.0], &[1e6, 0.0]),
        (&[-1e-4, 4e-4], &[1e6, -7e5]),
        (&[-1e-4, 3e-4], &[1e6, -2e5]),
    ],
    tolerance: 1e-12,
}];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "keyed",
        summary: "no tension, friction and shear keys",
        parameters: &[
            Parameter::number("friction", Quantity::Ratio, Range::NON_NEGATIVE, "coefficient of friction μ"),
            Parameter::number("key_strength", Quantity::Stress, Range::NON_NEGATIVE, "shear strength c of the keys, over the whole joint"),
            Parameter::number("normal_stiffness", Quantity::Stiffness, Range::POSITIVE, "stiffness of the joint itself against closing").optional("the joint itself is stiff"),
            Parameter::number("shear_stiffness", Quantity::Stiffness, Range::POSITIVE, "stiffness of the joint itself against slip").optional("the joint itself is stiff"),
        ],
        provides: &[Capability::FACETS, Capability::RESPONSE],
        claims: &[Property::DISSIPATIVE],
        samples: &[Sample::new("friction = 0.5\nkey_strength = 2e5\nnormal_stiffness = 1e10\nshear_stiffness = 5e9", 2e-4, &["elastic", "sliding"])],
        known_paths: KNOWN_PATHS,
        sources: &["where the equations come from: author, year, equation"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("keyed.md"),
        ..Card::BLANK
    }
}
