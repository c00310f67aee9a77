//! Growth of damage in tension, with a fracture energy per area of crack, for the laws with damage.

use crate::principal::{in_space, principal};
use voussoir_core::law::{UpdateContext, UpdateFailure, Voigt};

/// Exponential growth of damage D with the greatest equivalent strain κ. The energy of a crack per area does not depend on the
/// length of the element (crack band of Bažant & Oh 1983).
#[derive(Debug, Clone, Copy)]
pub struct DamageGrowth {
    /// κ₀, at which damage begins.
    pub onset: f64,
    /// f_t = E κ₀ \[Pa\].
    pub strength: f64,
    /// G_f \[J/m²\].
    pub energy: f64,
}

/// The damage of a point in one step.
#[derive(Debug, Clone, Copy)]
pub struct DamageStep {
    /// κ at the end of the step.
    pub kappa: f64,
    /// D at the end of the step.
    pub damage: f64,
    /// Change of D in the step.
    pub growth: f64,
    /// dD/dκ; 0 if damage does not grow.
    pub slope: f64,
    /// True if damage grows.
    pub grows: bool,
}

impl DamageGrowth {
    /// Returns D(κ) and dD/dκ in an element with this length \[m\].
    fn at(&self, kappa: f64, length: f64) -> [f64; 2] {
        if kappa <= self.onset {
            return [0.0, 0.0];
        }
        let tail = self.energy / (length * self.strength) - 0.5 * self.onset;
        let intact = self.onset / kappa * (-(kappa - self.onset) / tail).exp();
        [1.0 - intact, intact * (1.0 / kappa + 1.0 / tail)]
    }

    /// Returns the damage after a step to an equivalent strain; `before` is κ at the start of the step.
    pub fn step(&self, equivalent: f64, before: f64, length: f64) -> DamageStep {
        let grows = equivalent > before.max(self.onset);
        let kappa = if grows { equivalent } else { before };
        let ([damage, slope], [old, _]) = (self.at(kappa, length), self.at(before, length));
        DamageStep { kappa, damage, growth: damage - old, slope: if grows { slope } else { 0.0 }, grows }
    }

    /// Returns the greatest length of an element \[m\]: half of the length at which the stress would drop at once.
    pub fn largest_length(&self) -> f64 {
        self.energy / (self.strength * self.onset)
    }

    /// Checks the input of an update.
    pub fn check(&self, strain: &Voigt, old: &[f64], context: &UpdateContext) -> Result<(), UpdateFailure> {
        if !strain.iter().chain(old).all(|x| x.is_finite()) {
            return Err(UpdateFailure::NotFinite);
        }
        if context.length > self.largest_length() {
            return Err(UpdateFailure::LengthTooLarge);
        }
        Ok(())
    }
}

/// Returns √Σ⟨p_i⟩² of the principal values p_i of a symmetric tensor, and its derivative. In the derivative `shear` multiplies the
/// shears: 1 for a derivative by engineering strains, 2 for a derivative by stresses.
pub fn positive_norm(tensor: &Voigt, shear: f64) -> (f64, Voigt) {
    let (values, axes) = principal(tensor);
    let positive = values.map(|value| value.max(0.0));
    let norm = positive.iter().map(|value| value * value).sum::<f64>().sqrt();
    if norm == 0.0 {
        return (0.0, [0.0; 6]);
    }
    (norm, in_space(&positive.map(|value| value / norm), &axes, shear))
}

/// Returns a strain with tensor shears, which are half of the engineering shears.
pub fn strain_tensor(strain: &Voigt) -> Voigt {
    let [xx, yy, zz, xy, yz, zx] = *strain;
    [xx, yy, zz, 0.5 * xy, 0.5 * yz, 0.5 * zx]
}
