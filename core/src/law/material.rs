//! Bulk materials: what blocks are made of.
//!
//! Stresses and strains at a point are 6-vectors in the order xx, yy, zz, xy, yz, zx, tension positive;
//! shear strains are engineering strains (γ = 2 ε), so that stress · strain is work per volume.
//! A material is parameters plus a pure function; state belongs to whoever solves. Plane strain and
//! plane stress are made from the law in space by [`PlanarUpdate`](super::PlanarUpdate).

use std::fmt::{self, Debug};
use std::sync::Arc;

/// How a material deforms.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Deformability {
    /// Not at all.
    Rigid,
    /// Linearly, isotropically.
    LinearElastic {
        /// E \[Pa\].
        young_modulus: f64,
        /// ν.
        poisson_ratio: f64,
    },
    /// Linearly, isotropically up to a yield surface; beyond it by
    /// [`stress_update`](BulkMaterial::stress_update).
    Inelastic {
        /// E \[Pa\] of unloading.
        young_modulus: f64,
        /// ν of unloading.
        poisson_ratio: f64,
    },
}

/// The material of a block.
#[typetag::serde(tag = "law")]
pub trait BulkMaterial: Debug + Send + Sync {
    /// ρ \[kg/m³\].
    fn density(&self) -> f64;

    /// How it deforms.
    fn deformability(&self) -> Deformability;

    /// Stress from strain at a point; `None` where the material does not deform.
    fn stress_update(&self) -> Option<Arc<dyn StressUpdate>> {
        None
    }
}

/// Stress or strain at a point: xx, yy, zz, xy, yz, zx.
pub type Voigt = [f64; 6];

/// Where a stress lies at the end of an update, which names the equations that were solved.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Region {
    /// Inside the elastic domain, or back in it.
    Elastic,
    /// On a surface that fails in shear.
    Shear,
    /// On the surface between shear failure and cap.
    Transition,
    /// On a cap: compaction, crushing.
    Cap,
    /// At the tip of a cone in tension.
    Apex,
}

impl Region {
    /// Its name in result files.
    pub fn name(self) -> &'static str {
        match self {
            Region::Elastic => "elastic",
            Region::Shear => "shear",
            Region::Transition => "transition",
            Region::Cap => "cap",
            Region::Apex => "apex",
        }
    }
}

/// What an update gives for one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StressPoint {
    /// σ \[Pa\].
    pub stress: Voigt,
    /// ∂σ/∂ε of the update itself \[Pa\], row by row; not symmetric where flow is not associated.
    pub tangent: [Voigt; 6],
    /// Where σ lies.
    pub region: Region,
    /// Plastic work of the step per volume, σ · Δε^p with σ at its end \[J/m³\].
    pub dissipation: f64,
}

impl StressPoint {
    /// No stress and no stiffness: something to be overwritten.
    pub const ZERO: StressPoint =
        StressPoint { stress: [0.0; 6], tangent: [[0.0; 6]; 6], region: Region::Elastic, dissipation: 0.0 };
}

/// Why an update has no result.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum UpdateFailure {
    /// The strain or the state holds a number that is not finite.
    NotFinite,
    /// The iteration did not meet its tolerance.
    NoConvergence,
    /// The point's characteristic length is too large for the fracture energy: the softening branch
    /// would snap back inside the point.
    LengthTooLarge,
    /// A slice is not as long as the number of points and the law's state size demand.
    WrongSize,
}

impl fmt::Display for UpdateFailure {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.write_str(match self {
            UpdateFailure::NotFinite => "the strain or the state is not finite",
            UpdateFailure::NoConvergence => "the stress update did not meet its tolerance",
            UpdateFailure::LengthTooLarge => "the characteristic length is too large for the fracture energy",
            UpdateFailure::WrongSize => "the arrays do not fit the number of points",
        })
    }
}

/// The first point of a batch whose update failed.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct BatchFailure {
    /// Index of the point in the batch.
    pub point: usize,
    /// Why.
    pub failure: UpdateFailure,
}

impl fmt::Display for BatchFailure {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "point {}: {}", self.point, self.failure)
    }
}

/// Stress from strain: a pure function of the total strain and the state at the start of the step.
///
/// Nothing is allocated. Call [`update`](StressUpdate::update) once per group of points: it is the
/// one dynamic call, the loop inside is compiled for the law.
pub trait StressUpdate: Debug + Send + Sync {
    /// Numbers in the state of a point.
    fn state_size(&self) -> usize;

    /// Writes the state of the undeformed material into a slice of [`state_size`](Self::state_size).
    fn initial_state(&self, state: &mut [f64]);

    /// What each number of the state is, with its unit, such as `"plastic_strain_xx [-]"`.
    fn state_names(&self) -> &'static [&'static str];

    /// The update of one point. `length` is its characteristic length \[m\] (the width over which
    /// an element localises); only softening laws read it. `old` and `new` are as long as the state.
    fn update_point(
        &self,
        strain: &Voigt,
        length: f64,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<StressPoint, UpdateFailure>;

    /// The greatest characteristic length \[m\] this material can have: beyond it the softening
    /// branch of a point would snap back, and elements are an input error.
    fn largest_length(&self) -> f64 {
        f64::INFINITY
    }

    /// Updates a group of points; one strain, length and result each, states one after the other.
    fn update(
        &self,
        strains: &[Voigt],
        lengths: &[f64],
        old: &[f64],
        new: &mut [f64],
        points: &mut [StressPoint],
    ) -> Result<(), BatchFailure> {
        let (size, count) = (self.state_size(), strains.len());
        if lengths.len() != count || points.len() != count || old.len() != count * size || new.len() != count * size {
            return Err(BatchFailure { point: 0, failure: UpdateFailure::WrongSize });
        }
        for (index, (strain, point)) in strains.iter().zip(points).enumerate() {
            let place = index * size..(index + 1) * size;
            *point = self
                .update_point(strain, lengths[index], &old[place.clone()], &mut new[place])
                .map_err(|failure| BatchFailure { point: index, failure })?;
        }
        Ok(())
    }
}

/// Linear isotropic elasticity, which every inelastic law starts from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Isotropic {
    /// K = E / (3(1 − 2ν)) \[Pa\].
    pub bulk: f64,
    /// G = E / (2(1 + ν)) \[Pa\].
    pub shear: f64,
}

impl Isotropic {
    /// From E \[Pa\] and ν.
    pub fn new(young_modulus: f64, poisson_ratio: f64) -> Self {
        Isotropic {
            bulk: young_modulus / (3.0 * (1.0 - 2.0 * poisson_ratio)),
            shear: young_modulus / (2.0 * (1.0 + poisson_ratio)),
        }
    }

    /// Deviator 2 G e as a stress vector, and pressure p = −K tr ε (compression positive) \[Pa\].
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

    /// 2 `deviatoric` dev + `volumetric` 1⊗1 in engineering shears: the elastic stiffness for
    /// (G, K) \[Pa\].
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

    /// The elastic stiffness \[Pa\].
    pub fn tangent(&self) -> [Voigt; 6] {
        Isotropic::stiffness(self.shear, self.bulk)
    }
}

/// q = √(3/2 s:s) of a deviator \[Pa\], without overflow.
pub fn von_mises(deviator: &Voigt) -> f64 {
    let largest = deviator.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    if largest == 0.0 {
        return 0.0;
    }
    let square = |i: usize| (deviator[i] / largest).powi(2);
    largest * (1.5 * (square(0) + square(1) + square(2)) + 3.0 * (square(3) + square(4) + square(5))).sqrt()
}
