//! Bulk and shear modulus, for laws that are written in pressure and deviator.

use super::stress::Voigt;

/// Linear isotropic elasticity, the elastic part of inelastic laws.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isotropic {
    /// K = E / (3(1 − 2ν)) \[Pa\].
    pub bulk: f64,
    /// G = E / (2(1 + ν)) \[Pa\].
    pub shear: f64,
}

impl Isotropic {
    /// Creates the moduli from E \[Pa\] and ν.
    pub fn new(young_modulus: f64, poisson_ratio: f64) -> Self {
        Isotropic {
            bulk: young_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio)),
            shear: young_modulus / (2.0 * (1.0 + poisson_ratio)),
        }
    }

    /// Returns the deviator 2 G e as a stress vector and the pressure p = −K tr ε \[Pa\], positive in compression.
    pub fn split(&self, strain: &Voigt) -> (Voigt, f64) {
        let trace = strain[0] + strain[1] + strain[2];
        let mean = trace / 3.0;
        let two_g = 2.0 * self.shear;
        let deviator = [
            two_g * (strain[0] - mean),
            two_g * (strain[1] - mean),
            two_g * (strain[2] - mean),
            self.shear * strain[3],
            self.shear * strain[4],
            self.shear * strain[5],
        ];
        (deviator, -self.bulk * trace)
    }

    /// Returns 2 `deviatoric` dev + `volumetric` 1⊗1 \[Pa\] for engineering shear strains: the elastic stiffness if the
    /// arguments are G and K.
    pub fn stiffness(deviatoric: f64, volumetric: f64) -> [Voigt; 6] {
        let mut tangent = [[0.0; 6]; 6];
        for (i, row) in tangent.iter_mut().enumerate() {
            for entry in &mut row[..3] {
                *entry = if i < 3 { volumetric - 2.0 * deviatoric / 3.0 } else { 0.0 };
            }
            row[i] += if i < 3 { 2.0 * deviatoric } else { deviatoric };
        }
        tangent
    }

    /// Returns the elastic stiffness \[Pa\].
    pub fn tangent(&self) -> [Voigt; 6] {
        Isotropic::stiffness(self.shear, self.bulk)
    }
}

/// Returns q = √(3/2 s:s) of a deviator s \[Pa\], without overflow.
pub fn von_mises(deviator: &Voigt) -> f64 {
    let largest = deviator.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    let square = |i: usize| (deviator[i] / largest).powi(2);
    largest * (1.5 * (square(0) + square(1) + square(2)) + 3.0 * (square(3) + square(4) + square(5))).sqrt()
}
