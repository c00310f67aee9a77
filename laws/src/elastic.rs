//! `elastic`: linear isotropic elasticity.
//!
//! **Purpose.** Stone that does not crush. **Equations.** Hooke's law, σ = λ_L tr ε I + 2 G ε with
//! G = E / (2(1 + ν)), λ_L = E ν / ((1 + ν)(1 − 2ν)). **State.** None. **Validity.** Small strains.
//! Limit loads do not depend on E and ν: limit analysis reads such blocks as rigid.

use crate::shared::MaterialKeys;
use voussoir_core::law::{BulkMaterial, Elasticity};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// A linear elastic material.
#[derive(Debug, Clone, Keys)]
pub struct Elastic {
    /// E \[Pa\].
    #[key(like = MaterialKeys)]
    pub young_modulus: f64,
    /// ν.
    #[key(like = MaterialKeys)]
    pub poisson_ratio: f64,
    /// ρ \[kg/m³\].
    #[key(like = MaterialKeys)]
    pub density: f64,
}

#[typetag::serde(name = "elastic")]
impl BulkMaterial for Elastic {
    fn density(&self) -> f64 {
        self.density
    }

    fn elasticity(&self) -> Option<Elasticity> {
        Some(Elasticity::isotropic(self.young_modulus, self.poisson_ratio))
    }
}

/// Stretched along x, and sheared.
const KNOWN_PATHS: &[KnownPath] = &[KnownPath {
    table: "young_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0",
    source: "by hand: λ = E ν / ((1 + ν)(1 − 2ν)) = 25/18 GPa, G = E / (2 (1 + ν)) = 25/12 GPa",
    steps: &[
        (&[1e-3, 0.0, 0.0, 0.0, 0.0, 0.0], &[5e8 / 90.0, 1.25e8 / 90.0, 1.25e8 / 90.0, 0.0, 0.0, 0.0]),
        (&[0.0, 0.0, 0.0, 1e-3, 0.0, 0.0], &[0.0, 0.0, 0.0, 2.5e7 / 12.0, 0.0, 0.0]),
    ],
    tolerance: 1e-12,
}];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::BulkMaterial,
        tag: "elastic",
        summary: "linear isotropic elasticity",
        provides: &[Capability::RIGID_LIMIT, Capability::LINEAR, Capability::STRESS_UPDATE],
        claims: &[Property::DISSIPATIVE, Property::ISOTROPIC, Property::SYMMETRIC_TANGENT],
        samples: &[
            Sample::new("young_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0", 1e-3, &["elastic"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &["Hooke's law; Timoshenko & Goodier, Theory of Elasticity"],
        file: file!(),
        package: voussoir_core::package!(),
        page: "# `elastic`\n\nHooke's law with E and ν. Limit loads do not depend on them, because limit analysis \
               treats such blocks as rigid.\n",
        ..Card::of::<Elastic>()
    }
}
