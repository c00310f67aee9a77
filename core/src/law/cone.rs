//! Isotropic friction: the form of a joint law for contacts in space.

/// Admissible tractions (t_n, t_s, t_t) \[Pa\] of a contact in space:
/// |(t_s, t_t)| ≤ `cohesion` + `friction` t_n, t_n ≥ −`tensile_strength`, t_n ≤ `compressive_strength`.
/// Slip opens the contact by `dilatancy` per unit of slip; flow is associated if `dilatancy` equals `friction`.
/// Source: Coulomb 1776; the cone of isotropic friction as in Moreau 1988.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionCone {
    /// μ, the coefficient of friction.
    pub friction: f64,
    /// Tangent of the dilatancy angle, at most μ.
    pub dilatancy: f64,
    /// c \[Pa\], the shear strength without compression.
    pub cohesion: f64,
    /// f_t \[Pa\].
    pub tensile_strength: f64,
    /// f_c \[Pa\]; ∞ if the joint cannot crush.
    pub compressive_strength: f64,
}

impl FrictionCone {
    /// Creates dry friction: no cohesion, no tension, no crushing.
    pub fn dry(friction: f64, dilatancy: f64) -> Self {
        FrictionCone { friction, dilatancy, cohesion: 0.0, tensile_strength: 0.0, compressive_strength: f64::INFINITY }
    }

    /// Returns true if the cone has its tip at zero traction and no other bound.
    pub fn is_dry(&self) -> bool {
        self.cohesion == 0.0 && self.tensile_strength == 0.0 && self.compressive_strength == f64::INFINITY
    }

    /// Returns true if slip opens the contact as much as normality requires, so that the bound theorems hold.
    pub fn is_associated(&self) -> bool {
        self.dilatancy == self.friction
    }
}
