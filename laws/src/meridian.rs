//! From a return in the meridian plane to stresses in space.
//!
//! Isotropic laws whose yield surface and flow potential depend only on p = −tr σ / 3 (compression positive) and
//! q = √(3/2 s:s) keep the direction of the trial deviator: with the return (P, Q) → (p, q), σ = y s_trial − p 1, y = q / Q.
//! Differentiation with n = s_trial / Q, dQ = 3 G n·dε, dP = −K tr dε gives
//!
//! ```text
//! dσ = 2 G y dev dε + n (dq − y dQ) − 1 dp
//! ```

use voussoir_core::law::{Effect, Isotropic, StressPoint, UpdateBranch, UpdateFailure, Voigt, von_mises};

/// On a surface of shear failure.
pub const SHEAR: UpdateBranch = UpdateBranch::new("shear", Effect::Yielding);
/// At the tip of a cone in tension.
pub const APEX: UpdateBranch = UpdateBranch::new("apex", Effect::Tearing);

const PLASTIC_STRAIN: [&str; 6] = [
    "plastic_strain_xx [-]",
    "plastic_strain_yy [-]",
    "plastic_strain_zz [-]",
    "plastic_strain_xy [-]",
    "plastic_strain_yz [-]",
    "plastic_strain_zx [-]",
];

/// Returns the names of the N numbers of a state: the plastic strain (engineering shears), then the law's own names.
pub const fn state_names<const N: usize>(own: &[&'static str]) -> [&'static str; N] {
    let mut names = [""; N];
    let mut i = 0;
    while i < N {
        names[i] = if i < PLASTIC_STRAIN.len() { PLASTIC_STRAIN[i] } else { own[i - PLASTIC_STRAIN.len()] };
        i += 1;
    }
    names
}

/// Stress before the plastic correction.
#[derive(Debug, Clone, Copy)]
pub struct Trial {
    /// s \[Pa\].
    pub deviator: Voigt,
    /// P \[Pa\], compression positive.
    pub pressure: f64,
    /// Q \[Pa\].
    pub mises: f64,
}

/// A point returned to the yield surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Returned {
    /// p \[Pa\].
    pub pressure: f64,
    /// q / Q; 1 if Q = 0 and the point is elastic.
    pub ratio: f64,
    /// Compaction of the step, −tr Δε^p.
    pub compaction: f64,
    /// ∂(p, q) / ∂(P, Q).
    pub jacobian: [[f64; 2]; 2],
    /// Branch of the update.
    pub branch: UpdateBranch,
}

/// Returns q²/(6 G) + p²/(2 K).
fn stored(elastic: &Isotropic, pressure: f64, mises: f64) -> f64 {
    mises * mises / (6.0 * elastic.shear) + pressure * pressure / (2.0 * elastic.bulk)
}

impl Trial {
    /// Computes the trial from the strain and the plastic strain at the start of the state.
    pub fn new(elastic: &Isotropic, strain: &Voigt, state: &[f64]) -> Result<Self, UpdateFailure> {
        if !strain.iter().chain(state).all(|x| x.is_finite()) {
            return Err(UpdateFailure::NotFinite);
        }
        let mut difference = *strain;
        for (entry, plastic) in difference.iter_mut().zip(state) {
            *entry -= plastic;
        }
        let (deviator, pressure) = elastic.split(&difference);
        let mises = von_mises(&deviator);
        if !(pressure.is_finite() && mises.is_finite()) {
            return Err(UpdateFailure::NotFinite);
        }
        Ok(Trial { deviator, pressure, mises })
    }

    /// Returns the elastic stress and tangent.
    pub fn elastic(&self, elastic: &Isotropic) -> StressPoint {
        let mut stress = self.deviator;
        stress[..3].iter_mut().for_each(|entry| *entry -= self.pressure);
        StressPoint {
            stress,
            tangent: elastic.tangent(),
            branch: UpdateBranch::ELASTIC,
            stored: stored(elastic, self.pressure, self.mises),
            dissipated: 0.0,
        }
    }

    /// Returns stress and tangent for this return; adds the step's plastic strain to the state.
    pub fn returned(&self, elastic: &Isotropic, back: &Returned, state: &mut [f64]) -> StressPoint {
        let Isotropic { bulk, shear } = *elastic;
        let [[p_by_p, p_by_q], [q_by_p, q_by_q]] = back.jacobian;
        let y = back.ratio;
        let mut stress = self.deviator.map(|entry| y * entry);
        let mut tangent = Isotropic::stiffness(y * shear, p_by_p * bulk);
        let direction = if self.mises > 0.0 { self.deviator.map(|entry| entry / self.mises) } else { [0.0; 6] };
        for i in 0..6 {
            let unit = if i < 3 { 1.0 } else { 0.0 };
            for j in 0..6 {
                let trace = if j < 3 { bulk } else { 0.0 };
                let pull = 3.0 * shear * direction[j];
                tangent[i][j] += direction[i] * ((q_by_q - y) * pull - q_by_p * trace) - unit * p_by_q * pull;
            }
            let slip = (1.0 - y) * self.deviator[i] / shear;
            state[i] += if i < 3 { 0.5 * slip - back.compaction / 3.0 } else { slip };
            stress[i] -= unit * back.pressure;
        }
        let q = y * self.mises;
        StressPoint {
            stress,
            tangent,
            branch: back.branch,
            stored: stored(elastic, back.pressure, q),
            dissipated: q * (self.mises - q) / (3.0 * shear) + back.pressure * back.compaction,
        }
    }
}
