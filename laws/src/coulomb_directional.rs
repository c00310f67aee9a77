//! `coulomb_directional`: friction that differs with the direction of slip.
#![doc = include_str!("coulomb_directional.md")]

use crate::shared::*;
use voussoir_core::law::{Facet, FacetMode, InterfaceLaw};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// Dry friction of a surface with a grain.
#[derive(Debug, Clone, Keys)]
#[keys(check = CoulombDirectional::validate)]
pub struct CoulombDirectional {
    /// coefficient μ₊ against slip of the plus body along +t (t is the joint's normal from minus to plus,
    /// turned by +90°)
    #[key(unit = "-", range = ">= 0")]
    pub friction_forward: f64,
    /// coefficient μ₋ against slip along −t
    #[key(unit = "-", range = ">= 0")]
    pub friction_backward: f64,
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

impl CoulombDirectional {
    /// Returns the mistakes in the combination of parameters.
    pub fn validate(&self) -> Vec<(String, String)> {
        let least = self.friction_forward.min(self.friction_backward);
        validate_friction(Some(least), None, Some(self.dilatancy_angle))
    }
}

#[typetag::serde(name = "coulomb_directional")]
impl InterfaceLaw for CoulombDirectional {
    fn facets(&self) -> Option<Vec<Facet>> {
        let dilatancy = tangent(self.dilatancy_angle);
        // Slip along +t is resisted by t_t < 0: its facet has the normal −1, because ġ = −γ d.
        let sliding = |sense: f64, friction: f64| Facet {
            mode: FacetMode::Sliding,
            normal: [-friction, sense],
            bound: 0.0,
            flow: [-dilatancy.min(friction), sense],
        };
        Some(vec![Facet::opening(0.0), sliding(-1.0, self.friction_forward), sliding(1.0, self.friction_backward)])
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        stiffness(self.normal_stiffness, self.shear_stiffness)
    }
}

/// Slipped along +t against μ₊, moved back within stick, and slipped along −t against μ₋.
const KNOWN_PATHS: &[KnownPath] = &[KnownPath {
    table: "friction_forward = 0.6\nfriction_backward = 0.3\nnormal_stiffness = 1e10\nshear_stiffness = 5e9",
    source: "by hand: stick with k_t, slip at μ₊ t_n along +t and at μ₋ t_n along −t",
    steps: &[
        (&[-1e-4, 0.0], &[1e6, 0.0]),
        (&[-1e-4, 4e-4], &[1e6, -6e5]),
        (&[-1e-4, 3e-4], &[1e6, -1e5]),
        (&[-1e-4, 0.0], &[1e6, 3e5]),
        (&[-1e-4, 1e-5], &[1e6, 2.5e5]),
    ],
    tolerance: 1e-12,
}];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "coulomb_directional",
        summary: "no tension, Coulomb friction that differs with the sense of slip, as of tooled or bedded faces",
        provides: &[Capability::FACETS, Capability::RESPONSE],
        claims: &[Property::DISSIPATIVE],
        samples: &[
            Sample::new("friction_forward = 0.7\nfriction_backward = 0.3\nnormal_stiffness = 1e10\nshear_stiffness = 5e9", 1e-4, &["elastic", "sliding"]),
            Sample::new("friction_forward = 0.4\nfriction_backward = 0.6\ndilatancy_angle = 10.0\nnormal_stiffness = 1e10\nshear_stiffness = 5e9", 1e-4, &["elastic", "sliding"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &[
            "Michałowski & Mróz 1978, Arch. Mech. 30 (anisotropic friction, sliding rules)",
            "Zmitrowicz 1981, Int. J. Solids Struct. 17 (friction that depends on the sense of slip)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("coulomb_directional.md"),
        ..Card::of::<CoulombDirectional>()
    }
}
