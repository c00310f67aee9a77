//! `coulomb`: unilateral contact with Coulomb friction. Slip does not dilate by default.
#![doc = include_str!("coulomb.md")]

use crate::shared::*;
use voussoir_core::law::{Facet, FrictionCone, InterfaceLaw};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// Dry friction, non-associated by default.
#[derive(Debug, Clone, Keys)]
#[keys(check = Coulomb::validate)]
pub struct Coulomb {
    /// μ.
    #[key(like = JointKeys)]
    pub friction: Option<f64>,
    /// atan μ \[deg\].
    #[key(like = JointKeys)]
    pub friction_angle: Option<f64>,
    /// ψ \[deg\].
    #[key(like = JointKeys, default = 0.0)]
    pub dilatancy_angle: f64,
    /// k_n \[Pa/m\].
    #[key(like = JointKeys)]
    pub normal_stiffness: Option<f64>,
    /// k_t \[Pa/m\].
    #[key(like = JointKeys)]
    pub shear_stiffness: Option<f64>,
}

impl Coulomb {
    fn validate(&self) -> Vec<(String, String)> {
        validate_friction(self.friction, self.friction_angle, Some(self.dilatancy_angle))
    }
}

#[typetag::serde(name = "coulomb")]
impl InterfaceLaw for Coulomb {
    fn facets(&self) -> Option<Vec<Facet>> {
        let mu = friction(self.friction, self.friction_angle);
        let [left, right] = Facet::friction(mu, 0.0, tangent(self.dilatancy_angle).min(mu));
        Some(vec![Facet::opening(0.0), left, right])
    }

    fn cone(&self) -> Option<FrictionCone> {
        let mu = friction(self.friction, self.friction_angle);
        Some(FrictionCone::dry(mu, tangent(self.dilatancy_angle).min(mu)))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        stiffness(self.normal_stiffness, self.shear_stiffness)
    }
}

/// Closed, slipped, moved back within stick, slipped in the other direction, opened.
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
        summary: "no tension, Coulomb friction; slip does not dilate (non-associated) unless dilatancy_angle is given",
        provides: &[Capability::FACETS, Capability::RESPONSE, Capability::CONE],
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
        ..Card::of::<Coulomb>()
    }
}
