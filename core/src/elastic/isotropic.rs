//! Isotropic linear elasticity of a body, as condensation reads it.

use crate::law::{BulkMaterial, Deformability};

/// An isotropic, linear elastic material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IsotropicElastic {
    /// E \[Pa\].
    pub young_modulus: f64,
    /// ν.
    pub poisson_ratio: f64,
    /// ρ \[kg/m³\].
    pub density: f64,
}

impl IsotropicElastic {
    /// Of a material, before it yields; `None` where it is rigid.
    pub fn of(material: &dyn BulkMaterial) -> Option<Self> {
        match material.deformability() {
            Deformability::LinearElastic { young_modulus, poisson_ratio }
            | Deformability::Inelastic { young_modulus, poisson_ratio } => {
                Some(IsotropicElastic { young_modulus, poisson_ratio, density: material.density() })
            }
            Deformability::Rigid => None,
        }
    }

    /// Whether there is such a material, or why not.
    pub(super) fn check(&self) -> Result<(), String> {
        let IsotropicElastic { young_modulus: e, poisson_ratio: nu, density } = *self;
        let sound = e.is_finite() && e > 0.0 && nu > -1.0 && nu < 0.5 && density.is_finite() && density >= 0.0;
        sound.then_some(()).ok_or(format!("no elastic material has E = {e} Pa, ν = {nu}, ρ = {density} kg/m³"))
    }
}
