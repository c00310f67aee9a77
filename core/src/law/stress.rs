//! Stress updates at a point of a material.
//!
//! Stresses and strains are 6-vectors in the order xx, yy, zz, xy, yz, zx, positive in tension. Shear strains are
//! engineering strains (γ = 2 ε), so that stress · strain is work per volume.

use super::branch::UpdateBranch;
use super::update::{BatchFailure, UpdateContext, UpdateFailure};
use std::fmt::Debug;

/// Stress or strain at a point: xx, yy, zz, xy, yz, zx.
pub type Voigt = [f64; 6];

/// Result of an update at one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StressPoint {
    /// σ \[Pa\].
    pub stress: Voigt,
    /// Consistent tangent ∂σ/∂ε of the update \[Pa\], row by row; not symmetric if the flow is not associated.
    pub tangent: [Voigt; 6],
    /// The branch of the law: the set of equations that was solved.
    pub branch: UpdateBranch,
    /// Energy stored per volume at the end of the step \[J/m³\].
    pub stored: f64,
    /// Energy dissipated per volume in the step \[J/m³\]. For plastic flow it is σ · Δε^p with σ at the end of the step.
    pub dissipated: f64,
}

impl StressPoint {
    /// Zero stress and zero stiffness, as initial value of a buffer.
    pub const ZERO: StressPoint = StressPoint {
        stress: [0.0; 6],
        tangent: [[0.0; 6]; 6],
        branch: UpdateBranch::ELASTIC,
        stored: 0.0,
        dissipated: 0.0,
    };
}

/// A law that computes the stress from the strain: a pure function of the total strain and the state at the start of
/// the step.
///
/// An update allocates no memory. Call [`update`](StressUpdate::update) once per group of points: this is one dynamic
/// call, and the loop inside is compiled for the law.
pub trait StressUpdate: Debug + Send + Sync {
    /// Returns the number of state variables of a point.
    fn state_size(&self) -> usize;

    /// Writes the state of the undeformed material into a slice of length [`state_size`](Self::state_size).
    fn initial_state(&self, state: &mut [f64]);

    /// Returns the name of each state variable with its unit, such as `"plastic_strain_xx [-]"`.
    fn state_names(&self) -> &'static [&'static str];

    /// Updates one point. `old` and `new` have the length of the state.
    ///
    /// # Errors
    /// The reason why the step has no result.
    fn update_point(
        &self,
        strain: &Voigt,
        context: &UpdateContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<StressPoint, UpdateFailure>;

    /// Returns the greatest characteristic length \[m\] for which the softening branch of a point does not snap back.
    /// Larger elements are an input error.
    fn largest_length(&self) -> f64 {
        f64::INFINITY
    }

    /// Returns the part of the strain at the end of a step that is not elastic, for results. By default it is ε − C⁻¹ σ with the
    /// elasticity of the undamaged material; a law whose stiffness changes defines it here.
    fn inelastic_strain(&self, strain: &Voigt, state: &[f64]) -> Option<Voigt> {
        let _ = (strain, state);
        None
    }

    /// Writes the outputs of points that the card of the material declares, in their order. They belong to the end of a step:
    /// its strain, its context, the state and the result of the update there. A pure function, like the update.
    fn outputs(&self, strain: &Voigt, context: &UpdateContext, state: &[f64], point: &StressPoint, values: &mut [f64]) {
        let _ = (strain, context, state, point, values);
    }

    /// Updates a group of points: one strain, context and result per point; the states of the points follow one
    /// another.
    ///
    /// # Errors
    /// The index of the first point without result, with the reason; `WrongSize` if the lengths of the slices do not match.
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
