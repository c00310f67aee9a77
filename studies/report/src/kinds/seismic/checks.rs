//! The comparisons of capacity and demand.

use super::request::{Above, Request};
use voussoir_study::results::{CheckedQuantity, DisplacementCapacity, Oscillator, SeismicCheck};

/// The clause with the checks of local mechanisms.
const MECHANISMS: &str = "Circolare 617/2009, C8A.4.2.3";

/// The same clause, with the clause of the spectrum.
const SPECTRUM: &str = "Circolare 617/2009, C8A.4.2.3; EN 1998-1, 3.2.2.2";

/// The clause with the accelerations of elements in a building.
const ELEMENTS: &str = "EN 1998-1, 4.3.5.2";

/// The quantity of a check, with its capacity.
type Capacity = (CheckedQuantity, f64);

fn check((unit, capacity): Capacity, rule: &str, source: &str, demand: f64) -> SeismicCheck {
    let ratio = capacity / demand;
    SeismicCheck { rule: rule.into(), source: source.into(), unit, capacity, demand, ratio, met: ratio >= 1.0 }
}

/// Returns the checks of accelerations: a₀* against the acceleration at the support of the mechanism over q.
pub(super) fn accelerations(request: &Request, own: &Oscillator, gravity: f64) -> Vec<SeismicCheck> {
    let (spectrum, q) = (request.spectrum(), request.behaviour_factor);
    let capacity = (CheckedQuantity::Acceleration, own.activation_acceleration);
    let mut checks = vec![check(capacity, "a0* ≥ ag S/q", MECHANISMS, spectrum.ground / q)];
    if let Some(above) = &request.above {
        let demand = spectrum.acceleration(above.period) * above.shape() * above.participation() / q;
        checks.push(check(capacity, "a0* ≥ Se(T1) ψ γ/q", SPECTRUM, demand));
        let demand = above.element_coefficient(spectrum.ground / gravity) * gravity / q;
        checks.push(check(capacity, "a0* ≥ Sa g/qa", ELEMENTS, demand));
    }
    // A mechanism at the level of the foundation has no demand by the first mode.
    checks.retain(|check| check.demand > 0.0);
    checks
}

/// Returns the checks of displacements: d_u* against the displacement of an oscillator with the secant period.
pub(super) fn displacements(request: &Request, own: &DisplacementCapacity) -> Vec<SeismicCheck> {
    let (spectrum, period) = (request.spectrum(), own.secant_period);
    let capacity = (CheckedQuantity::Displacement, own.ultimate_displacement);
    let mut checks = vec![check(capacity, "du* ≥ SDe(Ts)", SPECTRUM, spectrum.displacement(period))];
    if let Some(above) = &request.above {
        let floor = spectrum.displacement(above.period) * above.shape() * above.participation();
        let demand = floor * above.amplification(period);
        checks.push(check(capacity, "du* ≥ SDe(T1) ψ γ A(Ts/T1)", SPECTRUM, demand));
    }
    checks.retain(|check| check.demand > 0.0);
    checks
}

impl Above {
    /// Returns ψ(Z) = Z/H, the first mode at the height of the support.
    fn shape(&self) -> f64 {
        self.height / self.building
    }

    /// Returns γ = 3N/(2N + 1), the participation of the first mode.
    fn participation(&self) -> f64 {
        let storeys = self.storeys as f64;
        3.0 * storeys / (2.0 * storeys + 1.0)
    }

    /// Returns (T/T₁)²/√((1 − T/T₁)² + 0.02 T/T₁), the response of the mechanism to the motion of the building.
    fn amplification(&self, period: f64) -> f64 {
        let ratio = period / self.period;
        ratio * ratio / ((1.0 - ratio).powi(2) + 0.02 * ratio).sqrt()
    }

    /// Returns S_a = α S (3 (1 + z/H)/(1 + (1 − T_a/T₁)²) − 0.5), at least α S (EN 1998-1, (4.25)).
    fn element_coefficient(&self, ground: f64) -> f64 {
        let tuned = 1.0 + (1.0 - self.element_period / self.period).powi(2);
        ground * (3.0 * (1.0 + self.shape()) / tuned - 0.5).max(1.0)
    }
}

#[cfg(test)]
mod tests {
    use super::Above;

    fn near(a: f64, b: f64) {
        assert!((a - b).abs() <= 1e-12 * b.abs(), "{a} {b}");
    }

    /// Values by hand at half the height of a building of two storeys with T₁ = 0.4 s.
    #[test]
    fn a_place_above_the_ground_by_hand() {
        let own = Above { height: 4.0, building: 8.0, period: 0.4, storeys: 2, element_period: 0.0 };
        near(own.shape(), 0.5);
        near(own.participation(), 1.2);
        // T = 2 T₁: 4/√(1 + 0.04); T = T₁: 1/√0.02.
        near(own.amplification(0.8), 4.0 / 1.04f64.sqrt());
        near(own.amplification(0.4), 1.0 / 0.02f64.sqrt());
        near(own.element_coefficient(0.2), 0.2 * (3.0 * 1.5 / 2.0 - 0.5));
        near(Above { height: 0.0, ..own }.element_coefficient(0.2), 0.2);
    }
}
