//! Plane strain and plane stress for any law in space.
//!
//! A strain in the plane is (ε_xx, ε_yy, γ_xy). Plane strain sets ε_zz = 0. Plane stress finds the ε_zz with σ_zz = 0
//! by a bracketed Newton iteration on the law. Its tangent is the tangent at the end of the iteration; with a, b in the
//! plane and z out of the plane:
//!
//! ```text
//! 0 = C_zb dε_b + C_zz dε_zz    →    C̄_ab = C_ab − C_az C_zb / C_zz
//! ```
//!
//! This is static condensation (de Souza Neto, Perić & Owen 2008, section 9.2). The out-of-plane shear strains are
//! zero, because the plane is a plane of symmetry of the material. The last number of the state is ε_zz at the end of a
//! step, where the next step starts.

use super::branch::UpdateBranch;
use super::elasticity::Elasticity;
use super::stress::{StressPoint, StressUpdate, Voigt};
use super::update::{BatchFailure, UpdateContext, UpdateFailure};
use nalgebra::{Matrix3, Vector3};
use std::sync::Arc;

/// Stress state of deformable bodies: plane strain or plane stress.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Plane {
    /// ε_z = 0.
    Strain,
    /// σ_z = 0.
    Stress,
}

/// Voigt indices of the components in the plane.
const IN_PLANE: [usize; 3] = [0, 1, 3];
const ACROSS: usize = 2;
/// Number of points that are passed to the law in one call.
const CHUNK: usize = 16;
/// Greatest number of evaluations of the law in one plane-stress update.
const EVALUATIONS: usize = 200;

/// Result of an update in the plane at one point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlanarPoint {
    /// σ_xx, σ_yy, σ_xy \[Pa\].
    pub stress: [f64; 3],
    /// σ_zz \[Pa\]; zero but for rounding in plane stress.
    pub stress_across: f64,
    /// ε_zz; 0 in plane strain.
    pub strain_across: f64,
    /// ∂(σ_xx, σ_yy, σ_xy)/∂(ε_xx, ε_yy, γ_xy) \[Pa\].
    pub tangent: [[f64; 3]; 3],
    /// ∂σ_zz/∂(ε_xx, ε_yy, γ_xy) \[Pa\]; 0 in plane stress.
    pub tangent_across: [f64; 3],
    /// The branch of the law.
    pub branch: UpdateBranch,
    /// Energy stored per volume at the end of the step \[J/m³\].
    pub stored: f64,
    /// Energy dissipated per volume in the step \[J/m³\].
    pub dissipated: f64,
}

impl PlanarPoint {
    /// Zero stress and zero stiffness, as initial value of a buffer.
    pub const ZERO: PlanarPoint = PlanarPoint {
        stress: [0.0; 3],
        stress_across: 0.0,
        strain_across: 0.0,
        tangent: [[0.0; 3]; 3],
        tangent_across: [0.0; 3],
        branch: UpdateBranch::ELASTIC,
        stored: 0.0,
        dissipated: 0.0,
    };
}

impl PlanarPoint {
    /// Returns σ_xx, σ_yy, σ_zz, σ_xy \[Pa\].
    pub fn stress_in_space(&self) -> [f64; 4] {
        [self.stress[0], self.stress[1], self.stress_across, self.stress[2]]
    }

    /// Returns ε_xx, ε_yy, ε_zz, γ_xy at a strain in the plane.
    pub fn strain_in_space(&self, strain: &[f64; 3]) -> [f64; 4] {
        [strain[0], strain[1], self.strain_across, strain[2]]
    }
}

/// A law in space that is used in a plane.
#[derive(Debug, Clone)]
pub struct PlanarUpdate {
    law: Arc<dyn StressUpdate>,
    plane: Plane,
    /// C_zz of the undeformed material \[Pa\].
    stiffness: f64,
}

impl PlanarUpdate {
    /// Creates the law in this plane.
    ///
    /// # Errors
    /// The law's failure at zero strain.
    pub fn new(law: Arc<dyn StressUpdate>, plane: Plane) -> Result<Self, UpdateFailure> {
        let mut old = vec![0.0; law.state_size()];
        law.initial_state(&mut old);
        let mut new = old.clone();
        let length = if law.largest_length().is_finite() { law.largest_length() / 2.0 } else { 1.0 };
        let stiffness =
            law.update_point(&[0.0; 6], &UpdateContext::of_length(length), &old, &mut new)?.tangent[ACROSS][ACROSS];
        Ok(PlanarUpdate { law, plane, stiffness })
    }

    /// Returns the law in space.
    pub fn law(&self) -> &Arc<dyn StressUpdate> {
        &self.law
    }

    /// Returns the plane.
    pub fn plane(&self) -> Plane {
        self.plane
    }

    /// Returns the number of state variables of a point: those of the law, and ε_zz in plane stress.
    pub fn state_size(&self) -> usize {
        self.law.state_size() + usize::from(self.plane == Plane::Stress)
    }

    /// Writes the state of the undeformed material.
    pub fn initial_state(&self, state: &mut [f64]) {
        let own = self.law.state_size();
        self.law.initial_state(&mut state[..own]);
        state[own..].fill(0.0);
    }

    /// Returns the inelastic strain (xx, yy, zz, xy) that the law defines; see [`StressUpdate::inelastic_strain`].
    pub fn inelastic_strain(&self, [xx, yy, zz, xy]: [f64; 4], memory: &[f64]) -> Option<[f64; 4]> {
        self.law.inelastic_strain(&[xx, yy, zz, xy, 0.0, 0.0], memory).map(|strain| [0, 1, 2, 3].map(|i| strain[i]))
    }

    /// Writes the outputs of the law at a strain, for a state that this strain does not change; see
    /// [`StressUpdate::outputs`].
    ///
    /// # Errors
    /// The law's failure.
    pub fn outputs(
        &self,
        strain: &[f64; 3],
        context: &UpdateContext,
        state: &[f64],
        values: &mut [f64],
    ) -> Result<(), UpdateFailure> {
        let (own, mut new) = (self.law.state_size(), state.to_vec());
        let across = self.update_point(strain, context, state, &mut new)?.strain_across;
        let strain = in_space(strain, across);
        let point = self.law.update_point(&strain, context, &state[..own], &mut new[..own])?;
        self.law.outputs(&strain, context, &new[..own], &point, values);
        Ok(())
    }

    /// Updates one point; see [`StressUpdate::update_point`].
    ///
    /// # Errors
    /// The law's failure.
    pub fn update_point(
        &self,
        strain: &[f64; 3],
        context: &UpdateContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<PlanarPoint, UpdateFailure> {
        match self.plane {
            Plane::Strain => {
                let strain = in_space(strain, 0.0);
                Ok(planar(&self.law.update_point(&strain, context, old, new)?, 0.0, None))
            }
            Plane::Stress => self.zero_stress(strain, context, old, new),
        }
    }

    /// Updates a group of points; see [`StressUpdate::update`].
    ///
    /// # Errors
    /// The index of the first point without result, with the reason.
    pub fn update(
        &self,
        strains: &[[f64; 3]],
        contexts: &[UpdateContext],
        old: &[f64],
        new: &mut [f64],
        points: &mut [PlanarPoint],
    ) -> Result<(), BatchFailure> {
        let (size, count) = (self.state_size(), strains.len());
        if contexts.len() != count || points.len() != count || old.len() != count * size || new.len() != count * size {
            return Err(BatchFailure { point: 0, failure: UpdateFailure::WrongSize });
        }
        if self.plane == Plane::Stress {
            for (index, (strain, point)) in strains.iter().zip(points).enumerate() {
                let place = index * size..(index + 1) * size;
                *point = self
                    .zero_stress(strain, &contexts[index], &old[place.clone()], &mut new[place])
                    .map_err(|failure| BatchFailure { point: index, failure })?;
            }
            return Ok(());
        }
        let mut space = [[0.0; 6]; CHUNK];
        let mut found = [StressPoint::ZERO; CHUNK];
        for start in (0..count).step_by(CHUNK) {
            let end = count.min(start + CHUNK);
            let here = end - start;
            for (out, strain) in space.iter_mut().zip(&strains[start..end]) {
                *out = in_space(strain, 0.0);
            }
            let place = start * size..end * size;
            self.law
                .update(&space[..here], &contexts[start..end], &old[place.clone()], &mut new[place], &mut found[..here])
                .map_err(|wrong| BatchFailure { point: start + wrong.point, ..wrong })?;
            for (point, found) in points[start..end].iter_mut().zip(&found) {
                *point = planar(found, 0.0, None);
            }
        }
        Ok(())
    }

    /// Finds ε_zz with σ_zz = 0. If the material is stable, σ_zz increases with ε_zz, so a bracket that is found by
    /// growing steps contains a root. A Newton step that leaves the bracket is replaced by bisection.
    fn zero_stress(
        &self,
        strain: &[f64; 3],
        context: &UpdateContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<PlanarPoint, UpdateFailure> {
        let own = self.law.state_size();
        let (old_own, across) = (&old[..own], old[own]);
        let size = strain.iter().fold(across.abs(), |a, b| a.max(b.abs()));
        if !size.is_finite() {
            return Err(UpdateFailure::NotFinite);
        }
        let (mut low, mut high): (Option<f64>, Option<f64>) = (None, None);
        let (mut z, mut reach) = (across, size.max(f64::MIN_POSITIVE));
        for _ in 0..EVALUATIONS {
            let full = in_space(strain, z);
            let point = self.law.update_point(&full, context, old_own, &mut new[..own])?;
            let stress = point.stress[ACROSS];
            let largest = IN_PLANE.iter().fold(0.0_f64, |a, &i| a.max(point.stress[i].abs()));
            let noise = 4.0 * f64::EPSILON * self.stiffness * size.max(z.abs());
            let closed =
                matches!((low, high), (Some(l), Some(h)) if !(l < z && z < h) || h - l <= 4.0 * f64::EPSILON * z.abs());
            if stress.abs() <= 1e-13 * largest + noise || (closed && stress.abs() <= 1e-9 * largest + noise) {
                new[own] = z;
                return Ok(planar(&point, z, Some(self.stiffness)));
            }
            if closed {
                return Err(UpdateFailure::NoConvergence);
            }
            if stress > 0.0 {
                high = Some(z)
            } else {
                low = Some(z)
            }
            let slope = point.tangent[ACROSS][ACROSS];
            let newton = z - stress / slope;
            z = match (low, high) {
                (Some(l), Some(h)) if slope > 0.0 && l < newton && newton < h => newton,
                (Some(l), Some(h)) => 0.5 * (l + h),
                _ => {
                    // Without a bracket a Newton step is limited to twice the distance tried before.
                    let step = if slope > 0.0 && newton.is_finite() { newton - z } else { -stress.signum() * reach };
                    reach *= 2.0;
                    z + step.clamp(-reach, reach)
                }
            };
        }
        Err(UpdateFailure::NoConvergence)
    }
}

/// Returns the rows and columns of the plane, condensed over zz if the point is free to strain in z.
fn in_plane(c: &[Voigt; 6], free: bool) -> [[f64; 3]; 3] {
    IN_PLANE
        .map(|i| IN_PLANE.map(|j| c[i][j] - if free { c[i][ACROSS] * c[ACROSS][j] / c[ACROSS][ACROSS] } else { 0.0 }))
}

/// The elastic operator of a plane problem, relative to the modulus of the material.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlaneElasticity {
    /// D: (σ_xx, σ_yy, σ_xy) from (ε_xx, ε_yy, γ_xy).
    pub stiffness: Matrix3<f64>,
    /// σ_zz from (σ_xx, σ_yy, σ_xy).
    across: Vector3<f64>,
}

impl PlaneElasticity {
    /// Creates the operator in the plane from an operator in space. The plane must be a plane of symmetry of the
    /// material.
    pub fn new(elasticity: &Elasticity, plane: Plane) -> Self {
        let c = &elasticity.relative;
        let rows = in_plane(c, plane == Plane::Stress);
        let stiffness = Matrix3::from_fn(|i, j| rows[i][j]);
        let row = Vector3::from(IN_PLANE.map(|j| if plane == Plane::Stress { 0.0 } else { c[ACROSS][j] }));
        let mut plane = PlaneElasticity { stiffness, across: row };
        plane.across = plane.compliance() * row;
        plane
    }

    /// D⁻¹.
    pub fn compliance(&self) -> Matrix3<f64> {
        self.stiffness.try_inverse().unwrap_or(Matrix3::repeat(f64::NAN))
    }

    /// Returns (σ_xx, σ_yy, σ_zz, σ_xy) of an elastic stress in the plane.
    pub fn with_across(&self, [xx, yy, xy]: [f64; 3]) -> [f64; 4] {
        [xx, yy, self.across.dot(&Vector3::new(xx, yy, xy)), xy]
    }

    /// Returns the smaller of the relative moduli along x and y.
    pub fn softest(&self) -> f64 {
        let compliance = self.compliance();
        1.0 / compliance.m11.max(compliance.m22)
    }
}

fn in_space(strain: &[f64; 3], across: f64) -> Voigt {
    [strain[0], strain[1], across, strain[2], 0.0, 0.0]
}

/// Returns the components in the plane. They are condensed over zz if C_zz of the undeformed material is given.
fn planar(point: &StressPoint, strain_across: f64, condense: Option<f64>) -> PlanarPoint {
    let c = &point.tangent;
    // Without stiffness in z, for example at the apex of a cone, the condensation is left out.
    let free = condense.is_some_and(|stiffness| c[ACROSS][ACROSS].abs() > 1e-14 * stiffness);
    let tangent = in_plane(c, free);
    PlanarPoint {
        stress: IN_PLANE.map(|i| point.stress[i]),
        stress_across: point.stress[ACROSS],
        strain_across,
        tangent,
        tangent_across: if condense.is_some() { [0.0; 3] } else { IN_PLANE.map(|j| c[ACROSS][j]) },
        branch: point.branch,
        stored: point.stored,
        dissipated: point.dissipated,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The operator of an isotropic material in the plane is Hooke's law with Lamé's constants, and its compliance is
    /// its inverse.
    #[test]
    fn compliance_inverts_hooke() {
        let nu = 0.35;
        for plane in [Plane::Strain, Plane::Stress] {
            let lambda = match plane {
                Plane::Strain => nu / ((1.0 + nu) * (1.0 - 2.0 * nu)),
                Plane::Stress => nu / (1.0 - nu * nu),
            };
            let mu = 0.5 / (1.0 + nu);
            let (strain, pressure) = (Vector3::new(0.3, -0.7, 0.6), lambda * (0.3 - 0.7));
            let stress = Vector3::new(pressure + 2.0 * mu * 0.3, pressure - 2.0 * mu * 0.7, mu * 0.6);
            let operator = PlaneElasticity::new(&Elasticity::isotropic(5e9, nu), plane);
            assert!((operator.stiffness * strain - stress).norm() < 1e-14);
            assert!((operator.compliance() * stress - strain).norm() < 1e-15);
        }
    }
}
