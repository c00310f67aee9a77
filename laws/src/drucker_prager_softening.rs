//! `drucker_prager_softening`: a Drucker–Prager cone that shrinks by yielding.
#![doc = include_str!("drucker_prager_softening.md")]

use crate::meridian::{APEX, Returned, SHEAR, Trial, state_names};
use crate::shared::MaterialKeys;
use std::sync::Arc;
use voussoir_core::law::{
    BulkMaterial, Elasticity, Isotropic, StressPoint, StressUpdate, UpdateContext, UpdateFailure, Voigt,
};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// Associated Drucker–Prager with linear softening.
#[derive(Debug, Clone, Keys)]
#[keys(check = DruckerPragerSoftening::validate)]
pub struct DruckerPragerSoftening {
    /// E \[Pa\].
    #[key(like = MaterialKeys)]
    pub young_modulus: f64,
    /// ν.
    #[key(like = MaterialKeys)]
    pub poisson_ratio: f64,
    /// ρ \[kg/m³\].
    #[key(like = MaterialKeys)]
    pub density: f64,
    /// A in q + A tr σ = R
    #[key(unit = "-", range = ">= 0, < 1")]
    pub pressure_coefficient: f64,
    /// R of the intact material; it crushes at yield_stress / (1 − A)
    #[key(unit = "Pa", range = "> 0")]
    pub yield_stress: f64,
    /// R once it has softened
    #[key(unit = "Pa", range = ">= 0", default = 0.0)]
    pub residual_stress: f64,
    /// energy of softening in uniaxial compression per area
    #[key(unit = "J/m2", range = "> 0", optional = "ultimate_plastic_strain is given")]
    pub crushing_fracture_energy: Option<f64>,
    /// cumulated plastic strain at which softening ends, whatever the element size
    #[key(unit = "-", range = "> 0", optional = "crushing_fracture_energy is given")]
    pub ultimate_plastic_strain: Option<f64>,
}

impl DruckerPragerSoftening {
    fn drop(&self) -> f64 {
        self.yield_stress - self.residual_stress
    }

    /// Returns the steepest softening −dR/dκ \[Pa\] that a point can follow: the smallest of E (1 − A)² (uniaxial compression would
    /// snap back), 9 K A² (the tip of the cone) and 3 G + 9 K A².
    pub fn steepest_softening(&self) -> f64 {
        let Isotropic { bulk, shear } = Isotropic::new(self.young_modulus, self.poisson_ratio);
        let a = self.pressure_coefficient;
        let tip = if a > 0.0 { 9.0 * bulk * a * a } else { f64::INFINITY };
        (self.young_modulus * (1.0 - a).powi(2)).min(tip).min(3.0 * shear + 9.0 * bulk * a * a)
    }

    /// Returns the mistakes in the combination of parameters.
    pub fn validate(&self) -> Vec<(String, String)> {
        let mut wrong = Vec::new();
        if self.residual_stress >= self.yield_stress {
            let message = format!("{} Pa must be less than yield_stress: the law softens", self.residual_stress);
            wrong.push(("residual_stress".into(), message));
        }
        match (self.ultimate_plastic_strain, self.crushing_fracture_energy) {
            (None, None) => {
                wrong.push((String::new(), "needs crushing_fracture_energy or ultimate_plastic_strain".into()));
            }
            (Some(_), Some(_)) => {
                let message = "given besides crushing_fracture_energy; give one of the two";
                wrong.push(("ultimate_plastic_strain".into(), message.into()));
            }
            (Some(ultimate), None) if self.drop() / ultimate >= self.steepest_softening() => {
                let least = self.drop() / self.steepest_softening();
                let message =
                    format!("{ultimate} is too brittle: a point would snap back; it must be above {least:.4e}");
                wrong.push(("ultimate_plastic_strain".into(), message));
            }
            _ => {}
        }
        wrong
    }
}

#[typetag::serde(name = "drucker_prager_softening")]
impl BulkMaterial for DruckerPragerSoftening {
    fn density(&self) -> f64 {
        self.density
    }

    fn elasticity(&self) -> Option<Elasticity> {
        Some(Elasticity::isotropic(self.young_modulus, self.poisson_ratio))
    }

    fn inelastic(&self) -> Option<Arc<dyn StressUpdate>> {
        Some(Arc::new(SofteningUpdate {
            elastic: Isotropic::new(self.young_modulus, self.poisson_ratio),
            law: self.clone(),
            largest_length: self
                .crushing_fracture_energy
                .map_or(f64::INFINITY, |energy| 2.0 * energy * self.steepest_softening() / self.drop().powi(2)),
        }))
    }
}

/// The law at a point. State: plastic strain (engineering shears) and κ.
#[derive(Debug, Clone)]
pub struct SofteningUpdate {
    elastic: Isotropic,
    law: DruckerPragerSoftening,
    largest_length: f64,
}

const KAPPA: usize = 6;

static STATE: [&str; 7] = state_names(&["cumulated_plastic_strain [-]"]);

impl SofteningUpdate {
    /// Returns κ_u of a point with this characteristic length \[m\].
    fn ultimate(&self, length: f64) -> f64 {
        match (self.law.ultimate_plastic_strain, self.law.crushing_fracture_energy) {
            (_, Some(energy)) => 2.0 * energy / (length * self.law.drop()),
            (ultimate, None) => ultimate.unwrap_or(f64::INFINITY),
        }
    }

    /// Returns the root Δκ ≥ 0 of excess − stiffness Δκ − (R(κ + Δκ) − R(κ)) = 0 with the slope dR/dκ there. R decreases by
    /// `slope` up to κ_u; `stiffness` exceeds it, so the left side decreases and the root is unique.
    fn multiplier(&self, excess: f64, stiffness: f64, kappa: f64, ultimate: f64) -> (f64, f64) {
        let slope = -self.law.drop() / ultimate;
        let left = (ultimate - kappa).max(0.0);
        let softening = excess / (stiffness + slope);
        if softening <= left { (softening, slope) } else { ((excess - slope * left) / stiffness, 0.0) }
    }
}

impl StressUpdate for SofteningUpdate {
    fn state_size(&self) -> usize {
        7
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &STATE
    }

    fn largest_length(&self) -> f64 {
        self.largest_length
    }

    fn update_point(
        &self,
        strain: &Voigt,
        context: &UpdateContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<StressPoint, UpdateFailure> {
        let length = context.length;
        // Also refuses a length that is NaN.
        if self.law.crushing_fracture_energy.is_some() && !(length > 0.0 && length <= self.largest_length) {
            return Err(UpdateFailure::LengthTooLarge);
        }
        let Isotropic { bulk, shear } = self.elastic;
        let trial = Trial::new(&self.elastic, strain, old)?;
        new.copy_from_slice(old);
        let a = self.law.pressure_coefficient;
        let (kappa, ultimate) = (old[KAPPA], self.ultimate(length));
        let strength = self.law.yield_stress - self.law.drop() * (kappa / ultimate).min(1.0);
        let excess = trial.mises - 3.0 * a * trial.pressure - strength;
        if excess <= 0.0 {
            return Ok(trial.elastic(&self.elastic));
        }
        let stiffness = 3.0 * shear + 9.0 * bulk * a * a;
        let (step, slope) = self.multiplier(excess, stiffness, kappa, ultimate);
        let q = trial.mises - 3.0 * shear * step;
        let (back, step) = if q > 0.0 || a == 0.0 {
            let total = stiffness + slope;
            let jacobian = [
                [1.0 - 9.0 * bulk * a * a / total, 3.0 * bulk * a / total],
                [9.0 * shear * a / total, 1.0 - 3.0 * shear / total],
            ];
            let back = Returned {
                pressure: trial.pressure + 3.0 * bulk * a * step,
                ratio: (q / trial.mises).max(0.0),
                compaction: -3.0 * a * step,
                jacobian,
                branch: SHEAR,
            };
            (back, step)
        } else {
            // The tip: −3 A p = R(κ + Δκ), p = P + 3 K A Δκ.
            let excess = -3.0 * a * trial.pressure - strength;
            let (step, slope) = self.multiplier(excess, 9.0 * bulk * a * a, kappa, ultimate);
            let back = Returned {
                pressure: trial.pressure + 3.0 * bulk * a * step,
                ratio: 0.0,
                compaction: -3.0 * a * step,
                jacobian: [[slope / (9.0 * bulk * a * a + slope), 0.0], [0.0, 0.0]],
                branch: APEX,
            };
            (back, step)
        };
        new[KAPPA] += step;
        Ok(trial.returned(&self.elastic, &back, new))
    }
}

/// Sheared at constant volume, Δκ = (√3 G γ − σ_Y) / (3 G + 9 K A² + dR/dκ), which gives a pressure of 3 K A Δκ; then back.
const KNOWN_PATHS: &[KnownPath] = &[KnownPath {
    table: "young_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0\npressure_coefficient = 0.3\nyield_stress = 1e7\nresidual_stress = 1e6\nultimate_plastic_strain = 0.01",
    source: "by hand: radial return on the cone in pure shear",
    steps: &[
        (
            &[0.0, 0.0, 0.0, 8e-3, 0.0, 0.0],
            &[-6_206_418.901_145_161, -6_206_418.901_145_161, -6_206_418.901_145_161, 7_708_472.608_467_317, 0.0, 0.0],
        ),
        (
            &[0.0, 0.0, 0.0, 6e-3, 0.0, 0.0],
            &[-6_206_418.901_145_161, -6_206_418.901_145_161, -6_206_418.901_145_161, 3_541_805.941_800_65, 0.0, 0.0],
        ),
    ],
    tolerance: 1e-12,
}];

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::BulkMaterial,
        tag: "drucker_prager_softening",
        summary: "Drucker-Prager cone that softens linearly; its fracture energy makes it independent of the mesh",
        provides: &[Capability::STRESS_UPDATE, Capability::RIGID_LIMIT],
        claims: &[Property::DISSIPATIVE, Property::ISOTROPIC, Property::SYMMETRIC_TANGENT],
        samples: &[
            Sample::new("young_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0\npressure_coefficient = 0.3\nyield_stress = 1e7\nresidual_stress = 1e6\ncrushing_fracture_energy = 5000.0", 2e-3, &["elastic", "shear", "apex"]),
            Sample::new("young_modulus = 5e9\npoisson_ratio = 0.2\ndensity = 2200.0\npressure_coefficient = 0.3\nyield_stress = 1e7\nresidual_stress = 1e6\nultimate_plastic_strain = 0.01", 2e-3, &["elastic", "shear", "apex"]),
        ],
        known_paths: KNOWN_PATHS,
        sources: &[
            "Drucker & Prager 1952, Q. Appl. Math. 10",
            "code_aster R7.01.16, Intégration des comportements de Drucker-Prager",
            "Bažant & Oh 1983, Mater. Struct. 16 (fracture energy over the width of the band)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("drucker_prager_softening.md"),
        ..Card::of::<DruckerPragerSoftening>()
    }
}
