//! Stability of a state of equilibrium: its second-order work, from the flexibility of its bodies.
//!
//! With the modes of all contact points held, rates satisfy K q̇ = λ̇ p + f for any small wrenches f on the bodies,
//! contact forces condensed out. The factorisation of a solver gives the flexibility S = K⁻¹ column by column. By
//! Sylvester's law S has as many negative eigenvalues as K, and ½(S + Sᵀ) as many as ½(K + Kᵀ), since
//! ½(S + Sᵀ) = S ½(K + Kᵀ) Sᵀ. Motions that the modes exclude are eigenvectors of S with eigenvalue zero, and do not count.
//!
//! ```text
//! loads held           second-order work q̇ᵀ K q̇ > 0 for all q̇: no negative eigenvalue
//! load point held      for all q̇ with p·q̇ = 0: one fewer if pᵀ S p < 0, its displacement falling with the load
//! ```
//!
//! If slip is not associated, K is not symmetric: positive second-order work is then sufficient for stability, not
//! necessary (Hill 1958, J. Mech. Phys. Solids 6, 236-249); at limit points a real eigenvalue of K itself changes its
//! sign.

use crate::settings::SETTINGS;
use nalgebra::{DMatrix, DVector};
use voussoir_core::path::ProvenPeak;
use voussoir_core::random::Random;

/// Greatest number of motions for which all columns of the flexibility are computed; for more, subspace iteration
/// computes only its greatest eigenvalues.
const ALL: usize = 150;
/// Size of that subspace, and its iterations.
const SUBSPACE: usize = 10;
const ITERATIONS: usize = 16;

/// Returns true if the factor regains the factor of a limit point between two states. If the second state is stable, a
/// structure that snaps under dead load can end there.
pub(super) fn regains_limit_point(limit_points: &[ProvenPeak], load_step: usize, factors: [f64; 2]) -> bool {
    let regains = |peak: &ProvenPeak| {
        let fallen = peak.factor - peak.lowest;
        let [from, to] = factors.map(|factor| (peak.factor - factor) * fallen);
        peak.load_step == load_step && from > 0.0 && to <= 0.0
    };
    limit_points.iter().any(regains)
}

/// The second-order work of a state with loads and settlements held.
#[derive(Debug, Clone)]
pub(super) struct SecondOrderWork {
    /// Number of directions of negative second-order work.
    pub negative: usize,
    /// Number of negative real eigenvalues of K. With the sense of λ, it identifies limit points.
    pub turned: usize,
    /// True if K is symmetric.
    pub symmetric: bool,
    /// The least second-order work of a motion of unit size in the units of the unknowns.
    pub curvature: f64,
    /// Magnitude of the eigenvalue nearest to zero.
    pub nearest: f64,
    /// S, over the columns of a basis if there is one.
    flexibility: DMatrix<f64>,
    /// The greatest negative real eigenvalue of S by magnitude; `None` if `turned` is zero.
    turning: Option<f64>,
    basis: Option<DMatrix<f64>>,
}

/// Returns the second-order work of a state with `motions` unknown motions, from their responses to wrenches.
pub(super) fn work_by_responses(
    motions: usize,
    respond: impl Fn(&DMatrix<f64>) -> Option<DMatrix<f64>>,
) -> Option<SecondOrderWork> {
    if motions <= ALL {
        return SecondOrderWork::of(&respond(&DMatrix::identity(motions, motions))?, SETTINGS.distinct());
    }
    let mut random = Random::from_state(11);
    let mut basis = DMatrix::from_fn(motions, SUBSPACE, |_, _| random.signed()).qr().q();
    for _ in 0..ITERATIONS {
        basis = respond(&basis)?.qr().q();
    }
    let found = SecondOrderWork::of(&(basis.transpose() * respond(&basis)?), SETTINGS.distinct())?;
    Some(SecondOrderWork { basis: Some(basis), ..found })
}

/// Decides the stability of a state from the results with all weakly active points free and with all of them held:
/// positive with all free is sufficient, negative with all held is instability.
pub(super) fn over_weak_points(free: Option<bool>, held: Option<bool>) -> Option<bool> {
    match (free, held) {
        (Some(true), _) => Some(true),
        (_, Some(false)) => Some(false),
        _ => None,
    }
}

impl SecondOrderWork {
    /// Computes the work from the flexibility S; eigenvalues of S below `softest` belong to motions that the modes
    /// exclude. `None` if all are excluded or the eigenvalues were not found.
    pub fn of(flexibility: &DMatrix<f64>, softest: f64) -> Option<Self> {
        if flexibility.is_empty() || flexibility.iter().any(|s| !s.is_finite()) {
            return None;
        }
        let size = flexibility.amax();
        let transposed = flexibility.transpose();
        let symmetric = (flexibility - &transposed).amax() <= SETTINGS.same_rate() * size;
        let half = (flexibility + &transposed) * 0.5;
        let eigenvalues = half.symmetric_eigenvalues();
        let nothing = softest.max(SETTINGS.admissible * eigenvalues.amax());
        let negative = eigenvalues.iter().filter(|s| **s < -nothing).count();
        // The real parts of eigenvalues are at least the least eigenvalue of the symmetric part (Bendixson 1902).
        let turned: Vec<f64> = if symmetric || negative == 0 {
            eigenvalues.iter().copied().filter(|s| *s < -nothing).collect()
        } else {
            let schur = nalgebra::linalg::Schur::try_new(flexibility.clone(), 1e-14, 10_000)?;
            let values = schur.complex_eigenvalues();
            values.iter().filter(|s| s.re < -nothing && s.im.abs() <= 1e-9 * s.re.abs()).map(|s| s.re).collect()
        };
        // 1/s is least for the negative s nearest to zero; without a negative s, for the greatest s.
        let relevant = eigenvalues.iter().filter(|s| s.abs() > nothing);
        let curvature = relevant.map(|s| 1.0 / s).min_by(f64::total_cmp)?;
        let nearest = 1.0 / eigenvalues.amax();
        let turning = turned.iter().copied().min_by(f64::total_cmp);
        let (turned, flexibility) = (turned.len(), flexibility.clone());
        Some(SecondOrderWork { negative, turned, symmetric, curvature, nearest, flexibility, turning, basis: None })
    }

    /// Returns a motion of unit size in the units of the unknowns. If K is not symmetric and has negative real
    /// eigenvalues, it is the eigenvector of the one nearest to zero; otherwise it has the least second-order work.
    pub fn critical_mode(&self) -> Option<Vec<f64>> {
        let mode: DVector<f64> = match self.turning.filter(|_| !self.symmetric) {
            Some(turning) => right_eigenvector(&self.flexibility, turning)?,
            None => {
                let eigen = ((&self.flexibility + self.flexibility.transpose()) * 0.5).symmetric_eigen();
                let off = |i: &usize| (1.0 / eigen.eigenvalues[*i] - self.curvature).abs();
                let least = (0..eigen.eigenvalues.len()).min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or(0);
                eigen.eigenvectors.column(least).into()
            }
        };
        Some(self.basis.as_ref().map_or_else(|| mode.clone(), |basis| basis * &mode).as_slice().to_vec())
    }

    /// Returns true if second-order work is positive with the load point held. `yields`: its displacement per unit of
    /// the load with the modes held.
    pub fn stable_under_control(&self, yields: f64) -> bool {
        self.negative == usize::from(yields < 0.0)
    }
}

/// Returns the right eigenvector of a real eigenvalue, by inverse iteration.
fn right_eigenvector(matrix: &DMatrix<f64>, eigenvalue: f64) -> Option<DVector<f64>> {
    let size = matrix.nrows();
    let shifted = matrix - DMatrix::identity(size, size) * (eigenvalue * (1.0 + SETTINGS.rounding));
    let (lu, mut random) = (shifted.full_piv_lu(), Random::from_state(7));
    let mut vector = DVector::from_fn(size, |_, _| random.signed());
    for _ in 0..3 {
        vector = lu.solve(&vector)?.try_normalize(0.0)?;
    }
    Some(vector)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// K of two springs of stiffnesses −1 and 2 turned by 30°; a third motion is excluded.
    #[test]
    fn a_negative_spring_is_counted_and_an_excluded_motion_is_not() {
        let (c, s) = (0.75f64.sqrt(), 0.5);
        let turn = DMatrix::from_row_slice(3, 3, &[c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0]);
        let flexibility =
            &turn * DMatrix::from_diagonal(&DVector::from_vec(vec![-1.0, 0.5, -1e-18])) * turn.transpose();
        let found = SecondOrderWork::of(&flexibility, 1e-12).expect("eigenvalues");
        assert_eq!((found.negative, found.turned, found.symmetric), (1, 1, true));
        assert!(
            (found.curvature + 1.0).abs() < 1e-12
                && (found.critical_mode().expect("a mode")[0].abs() - c).abs() < 1e-12
        );
        // With a held load point, the structure is stable if the load softens it at that point, and unstable if not.
        assert!(found.stable_under_control(-1.0) && !found.stable_under_control(1.0));
    }

    /// A follower-like coupling: eigenvalues of K are ±i, second-order work is zero, no real eigenvalue turns.
    #[test]
    fn eigenvalues_that_are_not_real_turn_no_path() {
        let flexibility = DMatrix::from_row_slice(2, 2, &[1.0, 5.0, -5.0, 1.0]);
        let found = SecondOrderWork::of(&flexibility, 1e-12).expect("eigenvalues");
        assert_eq!((found.negative, found.turned, found.symmetric), (0, 0, false));
    }
}
