//! Linear elasticity in space: the 6 × 6 operator of a material, its axes, and the stress update at a point.

use super::branch::UpdateBranch;
use super::stress::{StressPoint, StressUpdate, Voigt};
use super::update::{UpdateContext, UpdateFailure};
use nalgebra::Matrix6;

/// Greatest asymmetry of an operator, relative to its greatest entry.
const SYMMETRIC: f64 = 1e-12;

/// A linear elastic operator C, σ = C ε, in the axes of the block: x is parallel to its first edge (the intrados of a
/// voussoir of an arch), y points inwards. Shear strains are engineering strains.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elasticity {
    /// Reference modulus \[Pa\]: E if the material is isotropic.
    pub modulus: f64,
    /// C / `modulus`, dimensionless.
    pub relative: [Voigt; 6],
}

impl Elasticity {
    /// Creates the isotropic operator from E \[Pa\] and ν.
    pub fn isotropic(young_modulus: f64, poisson_ratio: f64) -> Self {
        let nu = poisson_ratio;
        let (lambda, mu) = (nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), 0.5 / (1.0 + nu));
        let direct = |i: usize, j: usize| if i == j { lambda + 2.0 * mu } else { lambda };
        let entry = |i: usize, j: usize| match (i < 3, j < 3) {
            (true, true) => direct(i, j),
            (false, false) if i == j => mu,
            _ => 0.0,
        };
        Elasticity {
            modulus: young_modulus,
            relative: [0, 1, 2, 3, 4, 5].map(|i| [0, 1, 2, 3, 4, 5].map(|j| entry(i, j))),
        }
    }

    /// Creates the operator from C⁻¹ × `modulus`. Returns `None` if the matrix has no inverse.
    pub fn from_compliance(modulus: f64, compliance: &[Voigt; 6]) -> Option<Self> {
        let inverse = matrix(compliance).try_inverse()?;
        let symmetric = (inverse + inverse.transpose()) * 0.5;
        Some(Elasticity { modulus, relative: rows(&symmetric) })
    }

    /// C \[Pa\].
    pub fn stiffness(&self) -> [Voigt; 6] {
        self.relative.map(|row| row.map(|entry| entry * self.modulus))
    }

    /// C⁻¹ × `modulus`, dimensionless.
    pub fn compliance(&self) -> [Voigt; 6] {
        rows(&matrix(&self.relative).try_inverse().unwrap_or(Matrix6::repeat(f64::NAN)))
    }

    /// The same operator in other axes; `axes` are the unit vectors of the material's own axes.
    pub fn turned(&self, axes: &[[f64; 3]; 3]) -> Self {
        let turn = stress_turn(axes);
        Elasticity { relative: rows(&(turn * matrix(&self.relative) * turn.transpose())), ..*self }
    }

    /// Checks that the operator is finite, symmetric and positive definite, and that the plane of the scene is a plane
    /// of symmetry, so that strains in the plane cause no shear out of it. An error gives the reason.
    pub fn check(&self) -> Result<(), String> {
        let c = matrix(&self.relative);
        let symmetric = (c - c.transpose()).amax() <= SYMMETRIC * c.amax();
        let sound = self.modulus.is_finite() && self.modulus > 0.0 && c.iter().all(|entry| entry.is_finite());
        if !(sound && symmetric && c.cholesky().is_some()) {
            return Err(format!(
                "no elastic material has the stiffness {:?} Pa: it is not positive definite",
                self.stiffness()
            ));
        }
        let across = (0..4).flat_map(|i| [c[(i, 4)], c[(i, 5)]]).fold(0.0, |a: f64, entry| a.max(entry.abs()));
        if across > SYMMETRIC * c.amax() {
            return Err(
                "a material with shear across the plane needs a scene in space: turn its axes in the plane".into()
            );
        }
        Ok(())
    }
}

fn matrix(rows: &[Voigt; 6]) -> Matrix6<f64> {
    Matrix6::from_fn(|i, j| rows[i][j])
}

fn rows(matrix: &Matrix6<f64>) -> [Voigt; 6] {
    [0, 1, 2, 3, 4, 5].map(|i| [0, 1, 2, 3, 4, 5].map(|j| matrix[(i, j)]))
}

/// T: a stress vector σ in axes with these unit vectors becomes T σ; an operator C becomes T C Tᵀ.
fn stress_turn(axes: &[[f64; 3]; 3]) -> Matrix6<f64> {
    const PLACES: [(usize, usize); 6] = [(0, 0), (1, 1), (2, 2), (0, 1), (1, 2), (2, 0)];
    Matrix6::from_fn(|row, column| {
        let ((i, j), (k, l)) = (PLACES[row], PLACES[column]);
        let once = axes[k][i] * axes[l][j];
        if k == l { once } else { once + axes[l][i] * axes[k][j] }
    })
}

/// Hooke's law at a point, without state.
#[derive(Debug, Clone)]
pub struct LinearUpdate(pub Elasticity);

impl StressUpdate for LinearUpdate {
    fn state_size(&self) -> usize {
        0
    }

    fn initial_state(&self, _: &mut [f64]) {}

    fn state_names(&self) -> &'static [&'static str] {
        &[]
    }

    fn update_point(
        &self,
        strain: &Voigt,
        context: &UpdateContext,
        _: &[f64],
        _: &mut [f64],
    ) -> Result<StressPoint, UpdateFailure> {
        if !strain.iter().all(|x| x.is_finite()) {
            return Err(UpdateFailure::NotFinite);
        }
        let tangent = context.axes.map_or(self.0, |axes| self.0.turned(axes)).stiffness();
        let product = |row: &Voigt| row.iter().zip(strain).map(|(c, e)| c * e).sum::<f64>();
        let stress: Voigt = std::array::from_fn(|i| product(&tangent[i]));
        let stored = 0.5 * stress.iter().zip(strain).map(|(s, e)| s * e).sum::<f64>();
        Ok(StressPoint { stress, tangent, branch: UpdateBranch::ELASTIC, stored, dissipated: 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// An operator that is rotated and rotated back is unchanged, and an isotropic operator is the same in all axes.
    #[test]
    fn operators_turn_with_their_axes() {
        let (sine, cosine) = 0.7f64.sin_cos();
        let there = [[cosine, sine, 0.0], [-sine, cosine, 0.0], [0.0, 0.0, 1.0]];
        let back = [[cosine, -sine, 0.0], [sine, cosine, 0.0], [0.0, 0.0, 1.0]];
        let near = |a: &Elasticity, b: &Elasticity| (matrix(&a.relative) - matrix(&b.relative)).amax() < 1e-14;
        let isotropic = Elasticity::isotropic(5e9, 0.3);
        assert!(near(&isotropic.turned(&there), &isotropic));
        let mut compliance = isotropic.compliance();
        compliance[1][1] = 3.0;
        let other = Elasticity::from_compliance(5e9, &compliance).unwrap();
        assert!(!near(&other.turned(&there), &other));
        assert!(near(&other.turned(&there).turned(&back), &other));
        assert_eq!(other.turned(&there).check(), Ok(()));
    }

    #[test]
    fn what_is_no_material_is_refused() {
        assert!(Elasticity::isotropic(5e9, 0.5).check().unwrap_err().starts_with("no elastic material has"));
        let tilted = [[1.0, 0.0, 0.0], [0.0, 0.8, 0.6], [0.0, -0.6, 0.8]];
        let turned = [[0.8, 0.6, 0.0], [-0.6, 0.8, 0.0], [0.0, 0.0, 1.0]];
        let mut compliance = Elasticity::isotropic(5e9, 0.2).compliance();
        compliance[0][0] = 3.0;
        let other = Elasticity::from_compliance(5e9, &compliance).unwrap().turned(&turned);
        assert_eq!(other.check(), Ok(()));
        assert!(other.turned(&tilted).check().unwrap_err().starts_with("a material with shear across the plane"));
    }
}
