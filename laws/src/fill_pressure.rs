//! `fill_pressure`: mobilised shares of Rankine's pressures.
#![doc = include_str!("fill_pressure.md")]

use voussoir_core::law::{FillResistance, FillState};
use voussoir_core::plugin::{Card, Keys, PluginKind};

/// The least pressure of the fill.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Keys)]
pub enum LeastPressure {
    /// No pressure.
    Zero,
    /// Active pressure: the fill follows a ring that moves away.
    Active,
    /// Pressure at rest.
    AtRest,
}

/// Shares of Rankine's passive pressure.
#[derive(Debug, Clone, Keys)]
pub struct FillPressure {
    /// m_p, share of the passive pressure by friction that is mobilised; 0 switches it off
    #[key(unit = "-", range = ">= 0", default = 0.33)]
    pub passive_factor: f64,
    /// m_c, share of the passive pressure by cohesion that is mobilised; 0 switches it off
    #[key(unit = "-", range = ">= 0", default = 0.05)]
    pub cohesion_factor: f64,
    /// least pressure of the fill: zero, the active pressure, or the pressure at rest
    #[key(default = "zero")]
    pub lower: LeastPressure,
    /// pressure by displacement into the fill before it yields; limit loads do not depend on it
    #[key(unit = "Pa/m", range = "> 0", optional = "the fill is rigid until it yields")]
    pub stiffness: Option<f64>,
}

/// Returns K_p = (1 + sin φ)/(1 − sin φ).
fn passive_coefficient(friction_angle: f64) -> f64 {
    let sine = friction_angle.sin();
    (1.0 + sine) / (1.0 - sine)
}

#[typetag::serde(name = "fill_pressure")]
impl FillResistance for FillPressure {
    fn pressures(&self, state: &FillState) -> [f64; 2] {
        let FillState { vertical_stress, friction_angle, cohesion } = *state;
        let k_p = passive_coefficient(friction_angle);
        let by_cohesion = 2.0 * k_p.sqrt() * cohesion;
        let greatest = self.passive_factor * k_p * vertical_stress + self.cohesion_factor * by_cohesion;
        let least = match self.lower {
            LeastPressure::Zero => 0.0,
            // K_a = 1/K_p; cohesion reduces the pressure by 2 √K_a c.
            LeastPressure::Active => ((vertical_stress - by_cohesion) / k_p).max(0.0),
            LeastPressure::AtRest => (1.0 - friction_angle.sin()) * vertical_stress,
        };
        [least.min(greatest), greatest]
    }

    fn stiffness(&self) -> Option<f64> {
        self.stiffness
    }
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::FillResistance,
        tag: "fill_pressure",
        summary: "a share of Rankine's passive pressure; the least pressure is zero, active or at rest",
        sources: &[
            "Rankine 1857, Phil. Trans. R. Soc. 147",
            "Jaky 1944 (pressure at rest)",
            "Burroughs, Hughes, Hee & Davies 2002, Proc. ICE Struct. Build. 152 (shares of passive pressure)",
            "Gilbert 2007, ARCH'07 (fill elements beside the ring)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("fill_pressure.md"),
        ..Card::of::<FillPressure>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn law(lower: LeastPressure, passive_factor: f64) -> FillPressure {
        FillPressure { passive_factor, cohesion_factor: 1.0, lower, stiffness: None }
    }

    fn state(degrees: f64, cohesion: f64) -> FillState {
        FillState { vertical_stress: 1000.0, friction_angle: f64::to_radians(degrees), cohesion }
    }

    /// K_p for 0°, 30° and 45°, and the part of the cohesion.
    #[test]
    fn passive_pressures_are_rankines() {
        for (degrees, k_p) in [(0.0, 1.0), (30.0, 3.0), (45.0, 3.0 + 2.0 * 2f64.sqrt())] {
            let [least, greatest] = law(LeastPressure::Zero, 1.0).pressures(&state(degrees, 100.0));
            assert!((greatest - (k_p * 1000.0 + 200.0 * k_p.sqrt())).abs() < 1e-9, "{degrees}");
            assert_eq!(least, 0.0);
        }
    }

    /// Coulomb's wedge: the passive force on a height h is the least force, over wedges that rise at θ, that pushes a wedge of
    /// weight γ h² cot θ / 2 with cohesion c h / sin θ up its plane. Its minimum is K_p γ h²/2 + 2 c √K_p h.
    #[test]
    fn coulombs_wedge_gives_the_same_force() {
        let (unit_weight, height) = (19000.0, 1.7);
        for (degrees, cohesion) in [(30.0, 0.0), (37.0, 4000.0), (0.0, 12000.0)] {
            let phi = f64::to_radians(degrees);
            let wedge = |theta: f64| {
                let weight = unit_weight * height * height / 2.0 / theta.tan();
                let held = cohesion * height / theta.sin();
                (weight * (theta + phi).sin() + held * phi.cos()) / (theta + phi).cos()
            };
            let least = (1..90000)
                .map(|i| wedge((90.0 - degrees) * f64::from(i) / 90000.0 * 1f64.to_radians()))
                .fold(f64::INFINITY, f64::min);
            let mean = FillState { vertical_stress: unit_weight * height / 2.0, friction_angle: phi, cohesion };
            let [_, pressure] = law(LeastPressure::Zero, 1.0).pressures(&mean);
            assert!((pressure * height / least - 1.0).abs() < 1e-8, "{degrees}: {} {least}", pressure * height);
        }
    }

    /// The least pressure has its documented value, and never exceeds the greatest.
    #[test]
    fn least_pressures() {
        let least = |lower, cohesion| law(lower, 1.0).pressures(&state(30.0, cohesion))[0];
        assert!((least(LeastPressure::Active, 0.0) - 1000.0 / 3.0).abs() < 1e-9);
        assert!((least(LeastPressure::Active, 100.0) - (1000.0 / 3.0 - 200.0 / 3f64.sqrt())).abs() < 1e-9);
        assert_eq!(least(LeastPressure::Active, 1000.0), 0.0);
        assert!((least(LeastPressure::AtRest, 0.0) - 500.0).abs() < 1e-9);
        let [low, high] = law(LeastPressure::AtRest, 0.1).pressures(&state(30.0, 0.0));
        assert_eq!(low, high);
    }
}
