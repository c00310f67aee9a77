//! Strengths of the composite joint over its two internal variables: loss of bond and crushing.

/// Shares of the compressive strength: at the start of yielding, at the change from the parabola to the exponential, and the
/// residual share (Lourenço 1996).
const INITIAL: f64 = 1.0 / 3.0;
const MIDDLE: f64 = 1.0 / 2.0;
const RESIDUAL: f64 = 1.0 / 7.0;

/// Area beyond the peak and above the residual strength of a fall from 1 over a width of 1: 5/6 − 1/7 under the parabola and
/// (1/2 − 1/7)² under the exponential.
const FALL_AREA: f64 = 5.0 / 6.0 - RESIDUAL + (MIDDLE - RESIDUAL) * (MIDDLE - RESIDUAL);

/// The strength σ̄ of the cap over its equivalent plastic closing κ.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cap {
    /// f_m \[Pa\].
    pub strength: f64,
    /// κ_p at the peak \[m\].
    pub peak: f64,
    /// κ_m at half the strength beyond the peak \[m\].
    pub middle: f64,
}

impl Cap {
    /// Creates the cap from strength \[Pa\], κ_p \[m\] and G_fc \[J/m²\].
    pub fn new(strength: f64, peak: f64, energy: f64) -> Self {
        Cap { strength, peak, middle: peak + energy / (FALL_AREA * strength) }
    }

    /// Returns the greatest fall −dσ̄/dκ \[Pa/m\], at κ_m.
    pub fn steepest(&self) -> f64 {
        2.0 * (1.0 - MIDDLE) * self.strength / (self.middle - self.peak)
    }

    /// Returns σ̄(κ) and dσ̄/dκ.
    pub fn at(&self, crushing: f64) -> [f64; 2] {
        let width = self.middle - self.peak;
        let [share, slope] = if crushing <= self.peak {
            let x = crushing / self.peak;
            let root = (2.0 * x - x * x).max(0.0).sqrt();
            [INITIAL + (1.0 - INITIAL) * root, (1.0 - INITIAL) * (1.0 - x) / (root * self.peak)]
        } else if crushing <= self.middle {
            let x = (crushing - self.peak) / width;
            [1.0 - (1.0 - MIDDLE) * x * x, -2.0 * (1.0 - MIDDLE) * x / width]
        } else {
            let left = (MIDDLE - RESIDUAL) * (-self.decay() * (crushing - self.middle)).exp();
            [RESIDUAL + left, -self.decay() * left]
        };
        [self.strength * share, self.strength * slope]
    }

    /// Returns ∫σ̄ dκ from 0 \[J/m²\].
    pub fn energy(&self, crushing: f64) -> f64 {
        let rising = |x: f64| {
            let root = (2.0 * x - x * x).max(0.0).sqrt();
            let area = 0.5 * ((x - 1.0) * root + (x - 1.0).asin() + std::f64::consts::FRAC_PI_2);
            self.peak * (INITIAL * x + (1.0 - INITIAL) * area)
        };
        let falling = |x: f64| (self.middle - self.peak) * (x - (1.0 - MIDDLE) * x * x * x / 3.0);
        let shares = if crushing <= self.peak {
            rising(crushing / self.peak)
        } else if crushing <= self.middle {
            rising(1.0) + falling((crushing - self.peak) / (self.middle - self.peak))
        } else {
            let beyond = crushing - self.middle;
            let tail = -(MIDDLE - RESIDUAL) / self.decay() * (-self.decay() * beyond).exp_m1();
            rising(1.0) + falling(1.0) + RESIDUAL * beyond + tail
        };
        self.strength * shares
    }

    /// Returns the rate of the exponential \[1/m\], which continues the slope of the parabola.
    fn decay(&self) -> f64 {
        2.0 * (1.0 - MIDDLE) / (MIDDLE - RESIDUAL) / (self.middle - self.peak)
    }
}

/// Parameters of the return map: stiffnesses, strengths and their softening.
#[derive(Debug, Clone, Copy)]
pub(super) struct Surface {
    /// \[k_n, k_t\] \[Pa/m\].
    pub stiffness: [f64; 2],
    /// f_t \[Pa\].
    pub tension: f64,
    /// c \[Pa\].
    pub cohesion: f64,
    /// μ_0 and μ_r.
    pub friction: [f64; 2],
    /// tan ψ.
    pub dilatancy: f64,
    /// Loss of bond per plastic opening, f_t / G_I, and per plastic slip, c / G_II \[1/m\].
    pub loss: [f64; 2],
    /// Weight C_ss of shear in the cap.
    pub cap_shear: f64,
    /// Strength σ̄ of the cap.
    pub cap: Cap,
}

impl Surface {
    /// Returns μ if a share b of the bond remains.
    pub fn friction_at(&self, bond: f64) -> f64 {
        self.friction[1] + (self.friction[0] - self.friction[1]) * bond
    }

    /// Returns the greatest fall of the shear strength with slip at constant pressure \[Pa/m\], over all pressures that the cap
    /// carries at its peak, with the bond b at this fall: (c / G_II) b (c + p (μ_0 − μ_r)).
    pub fn steepest_shear(&self) -> f64 {
        let [fresh, residual] = self.friction;
        let (squared, strength) = (self.cap_shear, self.cap.strength);
        let at = |bond: f64| {
            // c b + μ p = √((f_m² − p²) / C_ss).
            let (cohesion, friction) = (self.cohesion * bond, self.friction_at(bond));
            let (a, half_b) = (1.0 + squared * friction * friction, squared * cohesion * friction);
            let rest = strength * strength - squared * cohesion * cohesion;
            let pressure = if rest <= 0.0 { 0.0 } else { rest / (half_b + (half_b * half_b + a * rest).sqrt()) };
            self.loss[1] * bond * (self.cohesion + pressure * (fresh - residual))
        };
        (1..=64).map(|step| at(f64::from(step) / 64.0)).fold(0.0, f64::max)
    }

    /// Returns the least k of the joint along the normal of the cap \[Pa/m\]. It must exceed the [`steepest`](Cap::steepest) fall:
    /// (k_n σ² + k_t C² τ²) / (σ̄ √(σ² + C² τ²)) over the ellipse.
    pub fn least_stiffness_at_the_cap(&self) -> f64 {
        let [k_n, k_t] = self.stiffness;
        let c = self.cap_shear;
        // With x = C τ² / σ̄² it is (k_n (1 − x) + k_t C x) / √(1 − x + C x).
        let at = |x: f64| (k_n * (1.0 - x) + k_t * c * x) / (1.0 - x + c * x).sqrt();
        (0..=64).map(|step| at(f64::from(step) / 64.0)).fold(f64::INFINITY, f64::min)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CAP: Cap = Cap { strength: 10.5, peak: 0.09, middle: 0.68 };

    /// Value and slope are continuous at κ_p and κ_m. The energy is the integral, and its part beyond the peak and above the
    /// residual strength is G_fc.
    #[test]
    fn the_cap_hardens_and_softens_smoothly_over_its_energy() {
        for at in [CAP.peak, CAP.middle] {
            let (before, after) = (CAP.at(at * (1.0 - 1e-9)), CAP.at(at * (1.0 + 1e-9)));
            assert!((before[0] - after[0]).abs() < 1e-6 && (before[1] - after[1]).abs() < 1e-4, "{before:?} {after:?}");
        }
        let (steps, end) = (400_000, 12.0);
        let width = end / f64::from(steps);
        let sum: f64 = (0..steps).map(|i| CAP.at((f64::from(i) + 0.5) * width)[0] * width).sum();
        assert!((sum - CAP.energy(end)).abs() < 1e-6 * sum, "{sum} {}", CAP.energy(end));
        let cap = Cap::new(10.5, 0.09, 5.0);
        let beyond = cap.energy(1e3) - cap.energy(cap.peak) - 10.5 / 7.0 * (1e3 - cap.peak);
        assert!((beyond - 5.0).abs() < 1e-9, "{beyond}");
        assert!((cap.at(cap.middle)[1] + cap.steepest()).abs() < 1e-12);
    }
}
