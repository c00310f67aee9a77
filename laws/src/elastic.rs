//! `elastic`: linear isotropic elasticity.
//!
//! **Purpose.** Stone that does not crush. **Equations.** Hooke's law, σ = λ_L tr ε I + 2 G ε with
//! G = E / (2(1 + ν)), λ_L = E ν / ((1 + ν)(1 − 2ν)). **State.** None. **Validity.** Small strains.
//! Limit loads do not depend on E and ν: limit analysis reads such blocks as rigid.

use crate::meridian::Trial;
use crate::rigid::DENSITY;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use voussoir_core::law::{BulkMaterial, Deformability, Isotropic, StressPoint, StressUpdate, UpdateFailure, Voigt};
use voussoir_core::plugin::{Capability, Card, Parameter, PluginKind, Property, Quantity, Range, Sample};

/// A linear elastic material.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Elastic {
    /// E \[Pa\].
    pub young_modulus: f64,
    /// ν.
    pub poisson_ratio: f64,
    /// ρ \[kg/m³\].
    pub density: f64,
}

#[typetag::serde(name = "elastic")]
impl BulkMaterial for Elastic {
    fn density(&self) -> f64 {
        self.density
    }

    fn deformability(&self) -> Deformability {
        Deformability::LinearElastic { young_modulus: self.young_modulus, poisson_ratio: self.poisson_ratio }
    }

    fn stress_update(&self) -> Option<Arc<dyn StressUpdate>> {
        Some(Arc::new(ElasticUpdate(Isotropic::new(self.young_modulus, self.poisson_ratio))))
    }
}

/// Hooke's law at a point; no state.
#[derive(Debug, Clone)]
pub struct ElasticUpdate(pub Isotropic);

impl StressUpdate for ElasticUpdate {
    fn state_size(&self) -> usize {
        0
    }

    fn initial_state(&self, _: &mut [f64]) {}

    fn state_names(&self) -> &'static [&'static str] {
        &[]
    }

    fn update_point(&self, strain: &Voigt, _: f64, old: &[f64], _: &mut [f64]) -> Result<StressPoint, UpdateFailure> {
        Ok(Trial::new(&self.0, strain, old)?.elastic(&self.0))
    }
}

/// E, which every material that deforms has.
pub(crate) const YOUNG_MODULUS: Parameter =
    Parameter::number("young_modulus", Quantity::Stress, Range::POSITIVE, "Young's modulus E");

/// ν, which every material that deforms has.
pub(crate) const POISSON_RATIO: Parameter =
    Parameter::number("poisson_ratio", Quantity::Ratio, Range::new(-1.0, true, 0.5, true), "Poisson's ratio ν");

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::BulkMaterial,
        tag: "elastic",
        summary: "linear isotropic elasticity",
        parameters: &[
            YOUNG_MODULUS,
            POISSON_RATIO,
            DENSITY,
        ],
        provides: &[Capability::RIGID_LIMIT, Capability::LINEAR, Capability::STRESS_UPDATE],
        claims: &[Property::DISSIPATIVE, Property::ISOTROPIC, Property::SYMMETRIC_TANGENT],
        samples: &[
            Sample::new("young_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0", 1e-3, &["elastic"]),
        ],
        sources: &["Hooke's law; Timoshenko & Goodier, Theory of Elasticity"],
        file: file!(),
        page: "# `elastic`\n\nHooke's law with E and ν. Limit loads do not depend on them: limit analysis reads such blocks as rigid.\n",
        ..Card::BLANK
    }
}
