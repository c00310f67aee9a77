//! Measures of rates for the rule that chooses: size of the step, second-order energy, stability under control.

use super::problem::{Rate, RateProblem};
use crate::contact::mode::ContactMode;
use crate::settings::SETTINGS;

impl RateProblem<'_> {
    /// Length of a rate. If supports move it is the length of the settlement, which does not depend on the axes in which blocks
    /// move. Otherwise it is measured by the motions of the structure, or the Euclidean norm of the gap rates in the units of the points.
    pub fn step(&self, rate: &Rate) -> f64 {
        if self.settles && rate.factor != 0.0 {
            return rate.factor.abs();
        }
        if let Some(metric) = &self.metric {
            let all = rate.gaps.iter().flatten().copied().chain([rate.factor]);
            let v = nalgebra::DVector::from_iterator(metric.nrows(), all);
            return v.dot(&(metric * &v)).max(0.0).sqrt();
        }
        let size = |(k, gap): (usize, &[f64; 2])| self.points[k].stiffness * (gap[0] * gap[0] + gap[1] * gap[1]);
        rate.gaps.iter().enumerate().map(size).sum::<f64>().sqrt()
    }

    /// Second-order energy ½ ġ·S ġ at a held load, per unit step squared. It is zero if it is rounding: a mechanism.
    pub fn second_order_energy(&self, rate: &Rate) -> f64 {
        let gaps = nalgebra::DVector::from_iterator(self.s.nrows(), rate.gaps.iter().flatten().copied());
        let energy = gaps.dot(&(&self.s * &gaps));
        if energy.abs() <= SETTINGS.admissible * self.s.amax() * gaps.norm_squared() {
            return 0.0;
        }
        0.5 * energy / self.step(rate).powi(2).max(1e-300)
    }

    /// True if modes are stable under a constant load.
    pub fn stable_under_load(&self, modes: &[ContactMode]) -> bool {
        self.negative_eigenvalues(modes) == Some(0)
    }

    /// True if a rate is stable while the load point or the settlement is held.
    pub fn stable_under_control(&self, rate: &Rate) -> bool {
        match self.negative_eigenvalues(&rate.modes) {
            Some(0) => true,
            // The load point moves on while the load falls.
            Some(1) => {
                let moves = self.load_flexibility * rate.factor + self.power(&rate.gaps);
                !self.settles && rate.factor <= 0.0 && moves > 0.0
            }
            _ => false,
        }
    }

    /// True if the modes of a rate determine it up to its size: their equations are regular, or the load does not rise and they
    /// leave only one motion free. Otherwise other rates lie as near to it as one likes, and no piece starts with it.
    pub fn is_isolated(&self, rate: &Rate) -> bool {
        let matrix = self.mode_matrix(&rate.modes);
        if matrix.is_empty() {
            return true;
        }
        let values = matrix.singular_values();
        let free = values.iter().filter(|v| **v <= SETTINGS.admissible * values.max()).count();
        free <= usize::from(rate.factor <= 0.0)
    }

    /// Number of negative real eigenvalues of AᵀSD over some modes.
    fn negative_eigenvalues(&self, modes: &[ContactMode]) -> Option<usize> {
        let matrix = self.mode_matrix(modes);
        if matrix.is_empty() || (&matrix + matrix.transpose()).cholesky().is_some() {
            return Some(0);
        }
        let least = -SETTINGS.admissible * matrix.amax();
        let schur = nalgebra::linalg::Schur::try_new(matrix, 1e-14, 10_000)?;
        let values = schur.complex_eigenvalues();
        Some(values.iter().filter(|v| v.re < least && v.im.abs() <= 1e-9 * v.re.abs()).count())
    }
}
