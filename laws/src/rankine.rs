//! `rankine`: a material that tears if its greatest principal stress reaches the strength.
#![doc = include_str!("rankine.md")]

use crate::principal::{PrincipalFacet, PrincipalUpdate};
use crate::shared::MaterialKeys;
use std::sync::Arc;
use voussoir_core::law::{BulkMaterial, Effect, Elasticity, StressUpdate, UpdateBranch};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// Limit of the greatest principal stress, perfectly plastic.
#[derive(Debug, Clone, Keys)]
pub struct Rankine {
    /// E \[Pa\].
    #[key(like = MaterialKeys)]
    pub young_modulus: f64,
    /// ν.
    #[key(like = MaterialKeys)]
    pub poisson_ratio: f64,
    /// ρ \[kg/m³\].
    #[key(like = MaterialKeys)]
    pub density: f64,
    /// f_t, which no principal stress exceeds
    #[key(unit = "Pa", range = "> 0")]
    pub tensile_strength: f64,
}

/// Returns σ_i ≤ f_t with associated flow, for each principal stress.
pub(crate) fn cut_offs(strength: f64) -> [PrincipalFacet; 3] {
    [0, 1, 2].map(|i| {
        let normal: [f64; 3] = std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 });
        PrincipalFacet { normal, bound: strength, flow: normal, tension: true }
    })
}

/// One principal stress is at the strength.
pub(crate) const TENSION: UpdateBranch = UpdateBranch::new("tension", Effect::Tearing);
/// Two principal stresses are at the strength.
pub(crate) const TENSION_EDGE: UpdateBranch = UpdateBranch::new("tension_edge", Effect::Tearing);
/// All three principal stresses are at the strength.
pub(crate) const TENSION_CORNER: UpdateBranch = UpdateBranch::new("tension_corner", Effect::Tearing);

fn branch(_: usize, tension: usize) -> UpdateBranch {
    [TENSION, TENSION_EDGE, TENSION_CORNER][tension.clamp(1, 3) - 1]
}

#[typetag::serde(name = "rankine")]
impl BulkMaterial for Rankine {
    fn density(&self) -> f64 {
        self.density
    }

    fn elasticity(&self) -> Option<Elasticity> {
        Some(Elasticity::isotropic(self.young_modulus, self.poisson_ratio))
    }

    fn inelastic(&self) -> Option<Arc<dyn StressUpdate>> {
        let facets = cut_offs(self.tensile_strength).to_vec();
        Some(Arc::new(PrincipalUpdate::new(self.young_modulus, self.poisson_ratio, facets, branch)))
    }
}

/// E = 4 GPa, ν = 0: the axes are independent. Torn along x, unloaded, compressed; then torn in shear, along its diagonal.
const KNOWN_PATHS: &[KnownPath] = &[
    KnownPath {
        table: "young_modulus = 4e9\npoisson_ratio = 0.0\ndensity = 2200.0\ntensile_strength = 1e6",
        source: "by hand: σ = min(E (ε − ε^p), f_t) along x",
        steps: &[
            (&[1e-3, 0.0, 0.0, 0.0, 0.0, 0.0], &[1e6, 0.0, 0.0, 0.0, 0.0, 0.0]),
            (&[8e-4, 0.0, 0.0, 0.0, 0.0, 0.0], &[2e5, 0.0, 0.0, 0.0, 0.0, 0.0]),
            (&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0], &[-3e6, 0.0, 0.0, 0.0, 0.0, 0.0]),
            (&[2e-3, 2e-3, 2e-3, 0.0, 0.0, 0.0], &[1e6, 1e6, 1e6, 0.0, 0.0, 0.0]),
            (&[2e-3, 1.9e-3, 1.8e-3, 0.0, 0.0, 0.0], &[1e6, 6e5, 2e5, 0.0, 0.0, 0.0]),
        ],
        tolerance: 1e-12,
    },
    KnownPath {
        table: "young_modulus = 4e9\npoisson_ratio = 0.0\ndensity = 2200.0\ntensile_strength = 1e6",
        source: "by hand: σ̂ = ±2 MPa along the diagonals, of which the tensile one is cut to 1 MPa: σ_xx = σ_yy = −0.5, σ_xy = 1.5 MPa; then back by 0.4 MPa of shear",
        steps: &[
            (&[0.0, 0.0, 0.0, 1e-3, 0.0, 0.0], &[-5e5, -5e5, 0.0, 1.5e6, 0.0, 0.0]),
            (&[0.0, 0.0, 0.0, 8e-4, 0.0, 0.0], &[-5e5, -5e5, 0.0, 1.1e6, 0.0, 0.0]),
        ],
        tolerance: 1e-12,
    },
];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::BulkMaterial,
        tag: "rankine",
        summary: "cracks where its greatest principal stress reaches the tensile strength, perfectly plastic",
        provides: &[Capability::STRESS_UPDATE, Capability::RIGID_LIMIT],
        claims: &[Property::ASSOCIATED, Property::DISSIPATIVE, Property::ISOTROPIC, Property::SYMMETRIC_TANGENT],
        samples: &[
            Sample::new("young_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0\ntensile_strength = 2e6", 1e-3, &["elastic", "tension", "tension_edge"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &[
            "Rankine 1858, Manual of Applied Mechanics (greatest principal stress)",
            "Clausen, Damkilde & Andersen 2006, Comput. Struct. 84 (return to a polyhedron of principal stresses)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("rankine.md"),
        ..Card::of::<Rankine>()
    }
}
