//! `mohr_coulomb`: friction with cohesion, tension cut-off and crushing strength.
#![doc = include_str!("mohr_coulomb.md")]

use crate::shared::*;
use voussoir_core::law::{Facet, FrictionCone, InterfaceLaw};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// A joint with strengths.
#[derive(Debug, Clone, Keys)]
#[keys(check = MohrCoulomb::validate)]
pub struct MohrCoulomb {
    /// μ.
    #[key(like = JointKeys)]
    pub friction: Option<f64>,
    /// atan μ \[deg\].
    #[key(like = JointKeys)]
    pub friction_angle: Option<f64>,
    /// shear strength without compression
    #[key(unit = "Pa", range = ">= 0", default = 0.0)]
    pub cohesion: f64,
    /// tension cut-off; cohesion / μ bounds it too
    #[key(unit = "Pa", range = ">= 0", default = 0.0)]
    pub tensile_strength: f64,
    /// crushing strength of the joint
    #[key(unit = "Pa", range = "> 0", optional = "unlimited")]
    pub compressive_strength: Option<f64>,
    /// ψ \[deg\].
    #[key(like = JointKeys, optional = "the angle of friction: associated flow")]
    pub dilatancy_angle: Option<f64>,
    /// k_n \[Pa/m\].
    #[key(like = JointKeys)]
    pub normal_stiffness: Option<f64>,
    /// k_t \[Pa/m\].
    #[key(like = JointKeys)]
    pub shear_stiffness: Option<f64>,
}

impl MohrCoulomb {
    fn validate(&self) -> Vec<(String, String)> {
        validate_friction(self.friction, self.friction_angle, self.dilatancy_angle)
    }
}

#[typetag::serde(name = "mohr_coulomb")]
impl InterfaceLaw for MohrCoulomb {
    fn facets(&self) -> Option<Vec<Facet>> {
        let mu = friction(self.friction, self.friction_angle);
        let dilatancy = self.dilatancy_angle.map_or(mu, |angle| tangent(angle).min(mu));
        let [left, right] = Facet::friction(mu, self.cohesion, dilatancy);
        let mut facets = vec![Facet::opening(self.tensile_strength), left, right];
        facets.extend(self.compressive_strength.filter(|strength| *strength < NO_CRUSHING).map(Facet::crushing));
        Some(facets)
    }

    fn cone(&self) -> Option<FrictionCone> {
        let friction = friction(self.friction, self.friction_angle);
        Some(FrictionCone {
            friction,
            dilatancy: self.dilatancy_angle.map_or(friction, |angle| tangent(angle).min(friction)),
            cohesion: self.cohesion,
            tensile_strength: self.tensile_strength,
            compressive_strength: self.compressive_strength.filter(|f| *f < NO_CRUSHING).unwrap_or(f64::INFINITY),
        })
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        stiffness(self.normal_stiffness, self.shear_stiffness)
    }
}

/// Least f_c \[Pa\] at which a joint is treated as uncrushable: the rounding error of a motion times such a strength would
/// exceed all loads.
const NO_CRUSHING: f64 = 1e15;

const TABLE: &str = "friction = 0.6\ncohesion = 4e5\ntensile_strength = 2e5\ncompressive_strength = 5e6\ndilatancy_angle = 10.0\nnormal_stiffness = 1e10\nshear_stiffness = 5e9";

/// Torn, closed on the torn surface, crushed; and sheared with dilatancy, then moved back.
const KNOWN_PATHS: &[KnownPath] = &[
    KnownPath {
        table: TABLE,
        source: "by hand: t_n = −k_n (g_n − g_p) between −f_t and f_c",
        steps: &[
            (&[1e-4, 0.0], &[-2e5, 0.0]),
            (&[0.0, 0.0], &[8e5, 0.0]),
            (&[-6e-4, 0.0], &[5e6, 0.0]),
            (&[-5e-4, 0.0], &[4e6, 0.0]),
        ],
        tolerance: 1e-12,
    },
    KnownPath {
        table: TABLE,
        source: "by hand: one facet reached, γ = 1e6 / (μ tan ψ k_n + k_t)",
        steps: &[
            (&[-1e-4, 4e-4], &[1_291_066.507_313_081, -1_174_639.904_387_849]),
            (&[-1e-4, 3.5e-4], &[1_291_066.507_313_081, -924_639.904_387_849]),
        ],
        tolerance: 1e-12,
    },
];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "mohr_coulomb",
        summary: "friction with cohesion, tension cut-off and crushing; associated unless dilatancy_angle is given",
        provides: &[Capability::FACETS, Capability::RESPONSE, Capability::CONE],
        claims: &[Property::DISSIPATIVE],
        samples: &[
            Sample::new("friction = 0.6\ncohesion = 4e5\ntensile_strength = 2e5\ncompressive_strength = 5e6\ndilatancy_angle = 10.0\nnormal_stiffness = 1e10\nshear_stiffness = 5e9", 2e-4, &["elastic", "sliding"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &["Livesley 1978, Int. J. Numer. Meth. Engng 12 (rectangular stress block)"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("mohr_coulomb.md"),
        ..Card::of::<MohrCoulomb>()
    }
}
