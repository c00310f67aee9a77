//! `unilateral`: contact without tension; in the tangential direction free or stuck.
#![doc = include_str!("unilateral.md")]

use crate::shared::*;
use voussoir_core::law::{Facet, FrictionCone, InterfaceLaw};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// Tangential behaviour of a closed joint.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum TangentialContact {
    /// The joint never slides.
    Stuck,
    /// The joint slides without resistance.
    Free,
}

/// A joint without tension.
#[derive(Debug, Clone, Keys)]
pub struct Unilateral {
    /// along the joint: "stuck" never slides, "free" slides without resistance
    #[key(default = "stuck")]
    pub tangential: TangentialContact,
    /// k_n \[Pa/m\].
    #[key(like = JointKeys)]
    pub normal_stiffness: Option<f64>,
    /// k_t \[Pa/m\].
    #[key(like = JointKeys)]
    pub shear_stiffness: Option<f64>,
}

#[typetag::serde(name = "unilateral")]
impl InterfaceLaw for Unilateral {
    fn facets(&self) -> Option<Vec<Facet>> {
        let mut facets = vec![Facet::opening(0.0)];
        if self.tangential == TangentialContact::Free {
            facets.extend(Facet::friction(0.0, 0.0, 0.0));
        }
        Some(facets)
    }

    fn cone(&self) -> Option<FrictionCone> {
        (self.tangential == TangentialContact::Free).then(|| FrictionCone::dry(0.0, 0.0))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        stiffness(self.normal_stiffness, self.shear_stiffness)
    }
}

/// Free: slips and closes further. Stuck: carries shear even if it is open.
const KNOWN_PATHS: &[KnownPath] = &[
    KnownPath {
        table: "tangential = \"free\"\nnormal_stiffness = 1e10\nshear_stiffness = 5e9",
        source: "by hand: no shear, k_n in compression",
        steps: &[(&[-1e-4, 2e-4], &[1e6, 0.0]), (&[-2e-4, 2e-4], &[2e6, 0.0]), (&[1e-4, 2e-4], &[0.0, 0.0])],
        tolerance: 1e-12,
    },
    KnownPath {
        table: "tangential = \"stuck\"\nnormal_stiffness = 1e10\nshear_stiffness = 5e9",
        source: "by hand: shear is elastic whatever the normal gap",
        steps: &[(&[-1e-4, 2e-4], &[1e6, -1e6]), (&[1e-4, 2e-4], &[0.0, -1e6])],
        tolerance: 1e-12,
    },
];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "unilateral",
        summary: "no tension; tangentially stuck (Heyman's assumptions) or free (frictionless)",
        provides: &[Capability::FACETS, Capability::RESPONSE],
        claims: &[Property::ASSOCIATED, Property::DISSIPATIVE, Property::SYMMETRIC_TANGENT],
        samples: &[
            Sample::new("tangential = \"free\"\nnormal_stiffness = 1e10\nshear_stiffness = 5e9", 1e-4, &["sliding"]),
            Sample::new("tangential = \"stuck\"\nnormal_stiffness = 1e10\nshear_stiffness = 5e9", 1e-4, &["elastic"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &["Signorini 1933", "Heyman 1966, Int. J. Solids Struct. 2"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("unilateral.md"),
        ..Card::of::<Unilateral>()
    }
}
