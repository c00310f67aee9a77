//! `mohr_coulomb_solid`: Mohr–Coulomb strength of a block, with a tension cut-off.
#![doc = include_str!("mohr_coulomb_solid.md")]

use crate::principal::{PrincipalFacet, PrincipalUpdate};
use crate::rankine::{TENSION, TENSION_CORNER, TENSION_EDGE, cut_offs};
use crate::shared::MaterialKeys;
use std::sync::Arc;
use voussoir_core::law::{BulkMaterial, Effect, Elasticity, StressUpdate, UpdateBranch};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// Cohesion and friction in space, perfectly plastic.
#[derive(Debug, Clone, Keys)]
#[keys(check = MohrCoulombSolid::validate)]
pub struct MohrCoulombSolid {
    /// E \[Pa\].
    #[key(like = MaterialKeys)]
    pub young_modulus: f64,
    /// ν.
    #[key(like = MaterialKeys)]
    pub poisson_ratio: f64,
    /// ρ \[kg/m³\].
    #[key(like = MaterialKeys)]
    pub density: f64,
    /// c, shear strength without normal stress
    #[key(unit = "Pa", range = "> 0")]
    pub cohesion: f64,
    /// angle of internal friction φ
    #[key(unit = "deg", range = "> 0, < 90")]
    pub friction_angle: f64,
    /// angle of dilatancy ψ of the flow, at most φ
    #[key(unit = "deg", range = ">= 0, < 90", default = 0.0)]
    pub dilatancy_angle: f64,
    /// f_t, which no principal stress exceeds; at most c / tan φ
    #[key(unit = "Pa", range = "> 0")]
    pub tensile_strength: f64,
}

impl MohrCoulombSolid {
    /// Returns the mistakes in the combination of parameters.
    pub fn validate(&self) -> Vec<(String, String)> {
        let mut wrong = Vec::new();
        if self.dilatancy_angle > self.friction_angle {
            let message = format!(
                "{} deg is more than the angle of friction, {} deg: flow would create energy",
                self.dilatancy_angle, self.friction_angle
            );
            wrong.push(("dilatancy_angle".into(), message));
        }
        let apex = self.cohesion / self.friction_angle.to_radians().tan();
        if self.tensile_strength > apex {
            let message = format!(
                "{} Pa is never reached: cohesion and friction end at c / tan φ = {apex:.6e} Pa of tension from all sides",
                self.tensile_strength
            );
            wrong.push(("tensile_strength".into(), message));
        }
        wrong
    }
}

/// One shear facet is active.
const SHEAR: UpdateBranch = UpdateBranch::new("shear", Effect::Yielding);
/// Two shear facets are active: two principal stresses are equal.
const SHEAR_EDGE: UpdateBranch = UpdateBranch::new("shear_edge", Effect::Yielding);
/// Shear and tension facets are active.
const SHEAR_TENSION: UpdateBranch = UpdateBranch::new("shear_tension", Effect::Yielding);

fn branch(shear: usize, tension: usize) -> UpdateBranch {
    match (shear, tension) {
        (1, 0) => SHEAR,
        (_, 0) => SHEAR_EDGE,
        (0, 1) => TENSION,
        (0, 2) => TENSION_EDGE,
        (0, _) => TENSION_CORNER,
        _ => SHEAR_TENSION,
    }
}

#[typetag::serde(name = "mohr_coulomb_solid")]
impl BulkMaterial for MohrCoulombSolid {
    fn density(&self) -> f64 {
        self.density
    }

    fn elasticity(&self) -> Option<Elasticity> {
        Some(Elasticity::isotropic(self.young_modulus, self.poisson_ratio))
    }

    fn inelastic(&self) -> Option<Arc<dyn StressUpdate>> {
        let (sine, cosine) = self.friction_angle.to_radians().sin_cos();
        let dilates = self.dilatancy_angle.to_radians().sin();
        // σ_i (1 + sin φ) − σ_j (1 − sin φ) ≤ 2 c cos φ; for sorted stresses these three facets are sufficient.
        let shear = [(0, 2), (0, 1), (1, 2)].map(|(major, minor)| {
            let of = |s: f64| {
                let mut v = [0.0; 3];
                (v[major], v[minor]) = (0.5 * (1.0 + s), -0.5 * (1.0 - s));
                v
            };
            PrincipalFacet { normal: of(sine), bound: self.cohesion * cosine, flow: of(dilates), tension: false }
        });
        let facets = shear.into_iter().chain(cut_offs(self.tensile_strength)).collect();
        Some(Arc::new(PrincipalUpdate::new(self.young_modulus, self.poisson_ratio, facets, branch)))
    }
}

/// φ = ψ = 30°, c = 1 MPa, E = 4 GPa, ν = 0: 0.75 σ_1 − 0.25 σ_3 ≤ c cos φ.
const KNOWN_PATHS: &[KnownPath] = &[
    KnownPath {
        table: TABLE,
        source: "by hand: squeezed along x with σ_y = σ_z held at no stress by ε^p (ν = 0, ψ = 30°): f_c = 2 c cos φ / (1 − sin φ) = 2 √3 MPa; γ = 1e-3 on each of the two facets of the edge; then back with E",
        steps: &[
            (&[EDGE_X, EDGE_Y, EDGE_Y, 0.0, 0.0, 0.0], &[-FC, 0.0, 0.0, 0.0, 0.0, 0.0]),
            (&[EDGE_X + 2e-4, EDGE_Y, EDGE_Y, 0.0, 0.0, 0.0], &[-FC + 8e5, 0.0, 0.0, 0.0, 0.0, 0.0]),
        ],
        tolerance: 1e-9,
    },
    KnownPath {
        table: TABLE,
        source: "by hand: pure shear γ_xy = 2e-3, σ̂ = ±4 MPa; one facet, γ = (4 MPa − c cos φ) / (E (0.75² + 0.25²)); then back by 0.4 MPa",
        steps: &[
            (&[0.0, 0.0, 0.0, 2e-3, 0.0, 0.0], &[SHEAR_N, SHEAR_N, 0.0, SHEAR_T, 0.0, 0.0]),
            (&[0.0, 0.0, 0.0, 1.8e-3, 0.0, 0.0], &[SHEAR_N, SHEAR_N, 0.0, SHEAR_T - 4e5, 0.0, 0.0]),
        ],
        tolerance: 1e-9,
    },
];

/// Numbers of the known paths: strains, f_c and stresses \[Pa\].
const EDGE_X: f64 = -0.0013660254037844387;
const EDGE_Y: f64 = 0.00075;
const FC: f64 = 3464101.615137755;
const SHEAR_N: f64 = -1253589.8384862244;
const SHEAR_T: f64 = 1492820.3230275512;
const TABLE: &str = "young_modulus = 4e9\npoisson_ratio = 0.0\ndensity = 2200.0\ncohesion = 1e6\nfriction_angle = 30.0\ndilatancy_angle = 30.0\ntensile_strength = 5e5";

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::BulkMaterial,
        tag: "mohr_coulomb_solid",
        summary: "cohesion and friction of a block in space with a tension cut-off, perfectly plastic",
        provides: &[Capability::STRESS_UPDATE, Capability::RIGID_LIMIT],
        claims: &[Property::DISSIPATIVE, Property::ISOTROPIC],
        samples: &[
            Sample::new("young_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0\ncohesion = 3e6\nfriction_angle = 30.0\ndilatancy_angle = 10.0\ntensile_strength = 2e6", 1e-3, &["elastic", "shear", "shear_tension"]),
            Sample::new("young_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0\ncohesion = 3e6\nfriction_angle = 35.0\ntensile_strength = 2e6", 1e-3, &["elastic", "shear", "shear_tension"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &[
            "Coulomb 1776; Mohr 1900",
            "Clausen, Damkilde & Andersen 2006, Comput. Struct. 84 (return in principal stresses)",
            "Paul 1961, J. Appl. Mech. 28 (tension cut-off)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("mohr_coulomb_solid.md"),
        ..Card::of::<MohrCoulombSolid>()
    }
}
