//! The elastic response spectrum of EN 1998-1 (3.2.2.2) and NTC 2018 (3.2.3.2), which have the same form.

use std::f64::consts::PI;

/// An elastic spectrum of a horizontal acceleration.
#[derive(Debug, Clone, Copy)]
pub(super) struct Spectrum {
    /// a_g S: acceleration of the ground \[m/s²\].
    pub ground: f64,
    /// F₀: amplification of the plateau \[-\].
    pub amplification: f64,
    /// η: correction for the damping \[-\].
    pub damping_factor: f64,
    /// T_B, T_C and T_D \[s\].
    pub periods: [f64; 3],
}

impl Spectrum {
    /// Returns η = √(10/(5 + ξ)), at least 0.55, with ξ in per cent (EN 1998-1, (3.6)).
    pub fn damping_factor(damping: f64) -> f64 {
        (10.0 / (5.0 + 100.0 * damping)).sqrt().max(0.55)
    }

    /// Returns the acceleration S_e(T) \[m/s²\] (EN 1998-1, (3.2) to (3.5)).
    pub fn acceleration(&self, period: f64) -> f64 {
        let [b, c, d] = self.periods;
        let plateau = self.ground * self.damping_factor * self.amplification;
        if period < b {
            self.ground + (plateau - self.ground) * period / b
        } else if period < c {
            plateau
        } else if period < d {
            plateau * c / period
        } else {
            plateau * c * d / (period * period)
        }
    }

    /// Returns the displacement S_De(T) = S_e(T) (T/2π)² \[m\] (EN 1998-1, (3.7)).
    pub fn displacement(&self, period: f64) -> f64 {
        self.acceleration(period) * (period / (2.0 * PI)).powi(2)
    }
}

#[cfg(test)]
mod tests {
    use super::Spectrum;

    /// Values by hand: a_g S = 2 m/s², F₀ = 2.5, T_B = 0.15 s, T_C = 0.5 s, T_D = 2 s. The plateau is 5 m/s².
    #[test]
    fn a_spectrum_has_the_values_of_its_equations() {
        let own = Spectrum { ground: 2.0, amplification: 2.5, damping_factor: 1.0, periods: [0.15, 0.5, 2.0] };
        for (period, value) in
            [(0.0, 2.0), (0.075, 3.5), (0.15, 5.0), (0.3, 5.0), (1.0, 2.5), (2.0, 1.25), (4.0, 0.3125)]
        {
            assert!((own.acceleration(period) - value).abs() < 1e-14, "{period}");
        }
        // 2.5/(4 π²), and the constant displacement beyond T_D: 1.25 (2/(2π))².
        assert!((own.displacement(1.0) - 0.063_325_739_776_461_1).abs() < 1e-15);
        assert!((own.displacement(2.0) - 0.126_651_479_552_922_2).abs() < 1e-15);
        assert!((own.displacement(3.0) - own.displacement(2.0)).abs() < 1e-15);
        assert!((Spectrum::damping_factor(0.05) - 1.0).abs() < 1e-15);
        assert!((Spectrum::damping_factor(1.0) - 0.55).abs() < 1e-15);
    }
}
