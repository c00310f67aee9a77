//! `coulomb`: unilateral contact with Coulomb friction, slip not dilating unless asked.
#![doc = include_str!("coulomb.md")]

use crate::parameters::*;
use serde::{Deserialize, Serialize};
use voussoir_core::law::{Facet, InterfaceLaw};
use voussoir_core::plugin::{Capability, Card, KnownPath, Parameter, PluginKind, Property, Sample, check_as};

/// Dry friction, non-associated by default.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Coulomb {
    /// μ.
    pub friction: Option<f64>,
    /// atan μ \[deg\].
    pub friction_angle: Option<f64>,
    /// ψ \[deg\].
    #[serde(default)]
    pub dilatancy_angle: f64,
    /// k_n \[Pa/m\].
    pub normal_stiffness: Option<f64>,
    /// k_t \[Pa/m\].
    pub shear_stiffness: Option<f64>,
}

#[typetag::serde(name = "coulomb")]
impl InterfaceLaw for Coulomb {
    fn facets(&self) -> Option<Vec<Facet>> {
        let mu = friction(self.friction, self.friction_angle);
        let [left, right] = Facet::friction(mu, 0.0, tangent(self.dilatancy_angle).min(mu));
        Some(vec![Facet::opening(0.0), left, right])
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        stiffness(self.normal_stiffness, self.shear_stiffness)
    }
}

const PARAMETERS: &[Parameter] =
    &[FRICTION, FRICTION_ANGLE, DILATANCY_ANGLE.default("0.0"), NORMAL_STIFFNESS, SHEAR_STIFFNESS];

/// Closed, slipped, back within stick, slipped the other way, opened.
const KNOWN_PATHS: &[KnownPath] = &[KnownPath {
    table: "friction = 0.6\nnormal_stiffness = 1e10\nshear_stiffness = 5e9",
    source: "by hand: stick with k_t, slip at μ t_n at constant volume",
    steps: &[
        (&[-1e-4, 0.0], &[1e6, 0.0]),
        (&[-1e-4, 4e-4], &[1e6, -6e5]),
        (&[-1e-4, 3e-4], &[1e6, -1e5]),
        (&[-1e-4, 0.0], &[1e6, 6e5]),
        (&[1e-4, 0.0], &[0.0, 0.0]),
    ],
    tolerance: 1e-12,
}];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "coulomb",
        summary: "no tension, Coulomb friction; slip does not dilate (non-associated) unless dilatancy_angle says so",
        parameters: PARAMETERS,
        provides: &[Capability::FACETS, Capability::RESPONSE],
        claims: &[Property::DISSIPATIVE],
        samples: &[
            Sample::new("friction = 0.6\nnormal_stiffness = 1e10\nshear_stiffness = 5e9", 1e-4, &["elastic", "sliding"]),
            Sample::new("friction_angle = 30.0\ndilatancy_angle = 10.0\nnormal_stiffness = 1e10\nshear_stiffness = 5e9", 1e-4, &["elastic", "sliding"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &["Coulomb 1776", "Drucker 1954, J. Appl. Mech. 21"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("coulomb.md"),
        check: |value| check_as::<Coulomb>(value, |law| {
            validate_friction(law.friction, law.friction_angle, Some(law.dilatancy_angle))
        }),
        ..Card::BLANK
    }
}
