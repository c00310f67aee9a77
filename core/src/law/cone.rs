//! Isotropic friction: the form of a joint law for contacts in space.

/// Admissible tractions (t_n, t_s, t_t) \[Pa\] of a contact in space:
/// |(t_s, t_t)| ≤ `cohesion` + `friction` t_n, t_n ≥ −`tensile_strength`, t_n ≤ `compressive_strength`.
/// Slip opens the contact by `dilatancy` per unit of slip; flow is associated if `dilatancy` equals `friction`.
/// Source: Coulomb 1776; the cone of isotropic friction as in Moreau 1988.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrictionCone {
    /// μ, the coefficient of friction.
    pub friction: f64,
    /// Tangent of the dilatancy angle, at most μ.
    pub dilatancy: f64,
    /// c \[Pa\], the shear strength without compression.
    pub cohesion: f64,
    /// f_t \[Pa\].
    pub tensile_strength: f64,
    /// f_c \[Pa\]; ∞ if the joint cannot crush.
    pub compressive_strength: f64,
}

impl FrictionCone {
    /// Creates dry friction: no cohesion, no tension, no crushing.
    pub fn dry(friction: f64, dilatancy: f64) -> Self {
        FrictionCone { friction, dilatancy, cohesion: 0.0, tensile_strength: 0.0, compressive_strength: f64::INFINITY }
    }

    /// Returns f_t, at most the normal traction at which friction and cohesion vanish \[Pa\].
    pub fn tension(&self) -> f64 {
        if self.friction > 0.0 {
            self.tensile_strength.min(self.cohesion / self.friction)
        } else {
            self.tensile_strength
        }
    }

    /// Returns the shear strength at the greatest tension \[Pa\].
    fn shear_in_tension(&self) -> f64 {
        (self.cohesion - self.friction * self.tension()).max(0.0)
    }

    /// Returns true if the set is one cone: it has one tip, and nothing else bounds it.
    pub fn has_one_tip(&self) -> bool {
        let remaining = self.shear_in_tension();
        remaining <= f64::EPSILON * self.cohesion && self.compressive_strength == f64::INFINITY
    }

    /// Returns by how much a force (n, s, t) \[N\] at a point of an area \[m²\] leaves the set; negative inside. Without an area
    /// the set is its cone of recession.
    pub fn violation(&self, [n, s, t]: &[f64; 3], area: f64) -> f64 {
        let share = |strength: f64| if area > 0.0 { strength * area } else { 0.0 };
        let crushed = if self.compressive_strength.is_finite() {
            n - share(self.compressive_strength)
        } else {
            f64::NEG_INFINITY
        };
        (s.hypot(*t) - share(self.cohesion) - self.friction * n).max(-share(self.tension()) - n).max(crushed)
    }

    /// Returns by how much a rate (n, s, t) of a gap leaves the rates that associated flow can have; none if joints crush.
    pub fn violation_of_flow(&self, [n, s, t]: &[f64; 3]) -> f64 {
        if self.compressive_strength.is_finite() {
            return 0.0;
        }
        (self.friction * s.hypot(*t) - n) / 1.0f64.hypot(self.friction)
    }

    /// Returns true if a contact without compression carries nothing, and nothing crushes it.
    pub fn is_dry(&self) -> bool {
        self.cohesion == 0.0 && self.tension() == 0.0 && self.compressive_strength == f64::INFINITY
    }

    /// Returns by how much a rate (n, s, t) of a gap closes it more than slip with the own dilatancy opens it.
    pub fn violation_of_own_flow(&self, [n, s, t]: &[f64; 3]) -> f64 {
        self.dilatancy * s.hypot(*t) - n
    }

    /// Returns the power that a force (n, s, t) of dry friction lacks from its own flow: zero if the contact opens without a
    /// force, sticks, or slips against the greatest friction; otherwise positive.
    pub fn idle_power(&self, force: &[f64; 3], rate: &[f64; 3]) -> f64 {
        let slip = rate[1].hypot(rate[2]);
        let against = self.friction * force[0] * slip + force[1] * rate[1] + force[2] * rate[2];
        force[0] * (rate[0] - self.dilatancy * slip) + against
    }

    /// Returns the greatest work of tractions of the set against a rate (n, s, t) of a gap \[m/s\], per area \[W/m²\]: at one of
    /// the two ends of the normal traction.
    pub fn dissipation(&self, [n, s, t]: &[f64; 3]) -> f64 {
        let (slip, tension, crushing) = (s.hypot(*t), self.tension(), self.compressive_strength);
        let opening = tension * n + self.shear_in_tension() * slip;
        let closing = (self.cohesion + self.friction * crushing) * slip - crushing * n;
        if crushing.is_finite() { opening.max(closing) } else { opening }
    }

    /// Returns true if slip opens the contact as much as normality requires, so that the bound theorems hold.
    pub fn is_associated(&self) -> bool {
        self.dilatancy == self.friction
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const MORTAR: FrictionCone = FrictionCone {
        friction: 0.6,
        dilatancy: 0.6,
        cohesion: 2.0,
        tensile_strength: 0.5,
        compressive_strength: 30.0,
    };

    /// Sticking, opening and slip against friction leave no power; slip along the force, slip below the greatest friction, and
    /// a force in an opening contact do.
    #[test]
    fn own_flow_leaves_no_power() {
        let law = FrictionCone::dry(0.5, 0.2);
        for (force, rate) in
            [([2.0, 0.3, 0.4], [0.0; 3]), ([0.0; 3], [0.7, 0.1, 0.3]), ([2.0, -0.6, -0.8], [0.2 * 5.0, 3.0, 4.0])]
        {
            assert!(law.idle_power(&force, &rate).abs() < 1e-14 && law.violation_of_own_flow(&rate) < 1e-14);
        }
        for (force, rate) in [
            ([2.0, 0.6, 0.8], [1.0, 3.0, 4.0]),
            ([2.0, -0.3, -0.4], [1.0, 3.0, 4.0]),
            ([2.0, 0.0, 0.0], [0.1, 0.0, 0.0]),
        ] {
            assert!(law.idle_power(&force, &rate) > 0.1);
        }
        assert!(law.violation_of_own_flow(&[0.9, 3.0, 4.0]) > 0.0);
    }

    /// The dissipation is the greatest work of a fine grid of admissible tractions.
    #[test]
    fn the_dissipation_is_the_greatest_work() {
        for rate in [[0.3, 0.1, -0.2], [-0.3, 0.5, 0.1], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.1, 0.0, 0.3]] {
            let mut greatest = f64::NEG_INFINITY;
            for step in 0..=400 {
                let n = -0.5 + 30.5 * f64::from(step) / 400.0;
                for turn in 0..360 {
                    let (sin, cos) = f64::from(turn).to_radians().sin_cos();
                    let shear = 2.0 + 0.6 * n;
                    let traction = [n, shear * cos, shear * sin];
                    assert!(MORTAR.violation(&traction, 1.0) < 1e-12);
                    greatest = greatest.max(-traction.iter().zip(&rate).map(|(t, v)| t * v).sum::<f64>());
                }
            }
            let found = MORTAR.dissipation(&rate);
            assert!(greatest <= found + 1e-12 && found - greatest < 1e-3, "{rate:?}: {found} {greatest}");
        }
    }

    /// Each strength bounds a force in proportion to the area; without an area only the cone remains.
    #[test]
    fn forces_are_compared_with_strength_times_area() {
        for (force, area) in [([60.0, 0.0, 0.0], 2.0), ([-1.0, 0.0, 0.0], 2.0), ([10.0, 0.0, 10.0], 2.0)] {
            assert!(MORTAR.violation(&force, area).abs() < 1e-12, "{force:?}");
            assert!(MORTAR.violation(&force, 0.99 * area) > 0.0, "{force:?}");
        }
        let endless = FrictionCone { compressive_strength: f64::INFINITY, ..MORTAR };
        assert_eq!(endless.violation(&[5.0, 3.0, 0.0], 0.0), 0.0);
        assert!(!endless.has_one_tip());
        assert!(FrictionCone { tensile_strength: 9.0, ..endless }.has_one_tip());
    }
}
