//! Stresses from strains at a point.
//!
//! Stresses and strains are 6-vectors in the order xx, yy, zz, xy, yz, zx, tension positive; shear strains are
//! engineering strains (γ = 2 ε), so that stress · strain is work per volume.

use super::branch::UpdateBranch;
use super::update::{BatchFailure, UpdateContext, UpdateFailure};
use std::fmt::Debug;

/// Stress or strain at a point: xx, yy, zz, xy, yz, zx.
pub type Voigt = [f64; 6];

/// What an update gives for one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StressPoint {
    /// σ \[Pa\].
    pub stress: Voigt,
    /// ∂σ/∂ε of the update itself \[Pa\], row by row; not symmetric where flow is not associated.
    pub tangent: [Voigt; 6],
    /// Where σ lies: the equations that were solved.
    pub branch: UpdateBranch,
    /// Energy stored per volume at the end of the step \[J/m³\].
    pub stored: f64,
    /// Energy dissipated per volume in the step, σ · Δε^p with σ at its end \[J/m³\].
    pub dissipated: f64,
}

impl StressPoint {
    /// No stress and no stiffness: something to be overwritten.
    pub const ZERO: StressPoint = StressPoint {
        stress: [0.0; 6],
        tangent: [[0.0; 6]; 6],
        branch: UpdateBranch::ELASTIC,
        stored: 0.0,
        dissipated: 0.0,
    };
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

    /// The update of one point. `old` and `new` are as long as the state.
    fn update_point(
        &self,
        strain: &Voigt,
        context: &UpdateContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<StressPoint, UpdateFailure>;

    /// The greatest characteristic length \[m\] this material can have: beyond it the softening
    /// branch of a point would snap back, and elements are an input error.
    fn largest_length(&self) -> f64 {
        f64::INFINITY
    }

    /// Updates a group of points; one strain, context and result each, states one after the other.
    fn update(
        &self,
        strains: &[Voigt],
        contexts: &[UpdateContext],
        old: &[f64],
        new: &mut [f64],
        points: &mut [StressPoint],
    ) -> Result<(), BatchFailure> {
        let (size, count) = (self.state_size(), strains.len());
        if contexts.len() != count || points.len() != count || old.len() != count * size || new.len() != count * size {
            return Err(BatchFailure { point: 0, failure: UpdateFailure::WrongSize });
        }
        for (index, (strain, point)) in strains.iter().zip(points).enumerate() {
            let place = index * size..(index + 1) * size;
            match self.update_point(strain, &contexts[index], &old[place.clone()], &mut new[place]) {
                Ok(found) => *point = found,
                Err(failure) => return Err(BatchFailure { point: index, failure }),
            }
        }
        Ok(())
    }
}
