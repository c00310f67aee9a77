//! `coulomb_associated`: Coulomb friction whose slip dilates by the angle of friction.
#![doc = include_str!("coulomb_associated.md")]

use crate::shared::*;
use voussoir_core::law::{Facet, FrictionCone, InterfaceLaw};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// Dry friction with associated flow.
#[derive(Debug, Clone, Keys)]
#[keys(check = CoulombAssociated::validate)]
pub struct CoulombAssociated {
    /// μ.
    #[key(like = JointKeys)]
    pub friction: Option<f64>,
    /// atan μ \[deg\].
    #[key(like = JointKeys)]
    pub friction_angle: Option<f64>,
    /// k_n \[Pa/m\].
    #[key(like = JointKeys)]
    pub normal_stiffness: Option<f64>,
    /// k_t \[Pa/m\].
    #[key(like = JointKeys)]
    pub shear_stiffness: Option<f64>,
}

impl CoulombAssociated {
    fn validate(&self) -> Vec<(String, String)> {
        validate_friction(self.friction, self.friction_angle, None)
    }
}

#[typetag::serde(name = "coulomb_associated")]
impl InterfaceLaw for CoulombAssociated {
    fn facets(&self) -> Option<Vec<Facet>> {
        let mu = friction(self.friction, self.friction_angle);
        let [left, right] = Facet::friction(mu, 0.0, mu);
        Some(vec![Facet::opening(0.0), left, right])
    }

    fn cone(&self) -> Option<FrictionCone> {
        let mu = friction(self.friction, self.friction_angle);
        Some(FrictionCone::dry(mu, mu))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        stiffness(self.normal_stiffness, self.shear_stiffness)
    }
}

/// Slip opens the joint against its stiffness: γ = 1.4 MPa / (μ² k_n + k_t). Then the joint moves back within stick.
const KNOWN_PATHS: &[KnownPath] = &[KnownPath {
    table: "friction = 0.6\nnormal_stiffness = 1e10\nshear_stiffness = 5e9",
    source: "by hand: one facet reached, γ = 1.4e6 / (0.36e10 + 5e9)",
    steps: &[
        (&[-1e-4, 4e-4], &[1_976_744.186_046_512, -1_186_046.511_627_907]),
        (&[-1e-4, 3e-4], &[1_976_744.186_046_512, -686_046.511_627_907]),
    ],
    tolerance: 1e-12,
}];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "coulomb_associated",
        summary: "no tension, Coulomb friction with associated flow: slip opens the joint, as linear programs assume",
        provides: &[Capability::FACETS, Capability::RESPONSE, Capability::CONE],
        claims: &[Property::ASSOCIATED, Property::DISSIPATIVE, Property::SYMMETRIC_TANGENT],
        samples: &[
            Sample::new("friction = 0.6\nnormal_stiffness = 1e10\nshear_stiffness = 5e9", 1e-4, &["elastic", "sliding"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &["Livesley 1978, Int. J. Numer. Meth. Engng 12", "Drucker 1954, J. Appl. Mech. 21"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("coulomb_associated.md"),
        ..Card::of::<CoulombAssociated>()
    }
}
