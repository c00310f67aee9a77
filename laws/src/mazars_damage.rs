//! `mazars_damage`: a material that loses stiffness by positive principal strains.
#![doc = include_str!("mazars_damage.md")]

use crate::principal::{in_space, principal};
use crate::shared::MaterialKeys;
use std::sync::Arc;
use voussoir_core::law::{
    BulkMaterial, Effect, Elasticity, StressPoint, StressUpdate, UpdateBranch, UpdateContext, UpdateFailure, Voigt,
};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// Isotropic damage with exponential softening.
#[derive(Debug, Clone, Keys)]
pub struct MazarsDamage {
    /// E \[Pa\].
    #[key(like = MaterialKeys)]
    pub young_modulus: f64,
    /// ν.
    #[key(like = MaterialKeys)]
    pub poisson_ratio: f64,
    /// ρ \[kg/m³\].
    #[key(like = MaterialKeys)]
    pub density: f64,
    /// f_t, uniaxial strength in tension
    #[key(unit = "Pa", range = "> 0")]
    pub tensile_strength: f64,
    /// G_f, energy of a crack per area
    #[key(unit = "J/m2", range = "> 0")]
    pub fracture_energy: f64,
}

/// Damage grows.
const DAMAGE: UpdateBranch = UpdateBranch::new("damage", Effect::Tearing);

#[typetag::serde(name = "mazars_damage")]
impl BulkMaterial for MazarsDamage {
    fn density(&self) -> f64 {
        self.density
    }

    fn elasticity(&self) -> Option<Elasticity> {
        Some(Elasticity::isotropic(self.young_modulus, self.poisson_ratio))
    }

    fn inelastic(&self) -> Option<Arc<dyn StressUpdate>> {
        let stiffness = self.elasticity()?.stiffness();
        Some(Arc::new(DamageUpdate {
            stiffness,
            growth: DamageGrowth {
                onset: self.tensile_strength / self.young_modulus,
                strength: self.tensile_strength,
                energy: self.fracture_energy,
            },
        }))
    }
}

/// Exponential growth of damage D with the greatest equivalent strain κ. The energy of a crack per area does not depend on the
/// length of the element.
#[derive(Debug, Clone, Copy)]
pub(crate) struct DamageGrowth {
    /// κ₀, at which damage begins.
    pub onset: f64,
    /// f_t = E κ₀ \[Pa\].
    pub strength: f64,
    /// G_f \[J/m²\].
    pub energy: f64,
}

impl DamageGrowth {
    /// Returns D(κ) and dD/dκ in an element with this length \[m\].
    pub fn at(&self, kappa: f64, length: f64) -> [f64; 2] {
        if kappa <= self.onset {
            return [0.0, 0.0];
        }
        let tail = self.energy / (length * self.strength) - 0.5 * self.onset;
        let intact = self.onset / kappa * (-(kappa - self.onset) / tail).exp();
        [1.0 - intact, intact * (1.0 / kappa + 1.0 / tail)]
    }

    /// Returns the greatest length of an element \[m\]: half of the length at which the stress would drop at once.
    pub fn largest_length(&self) -> f64 {
        self.energy / (self.strength * self.onset)
    }
}

/// The law at a point. State: κ, the greatest equivalent strain so far.
#[derive(Debug)]
struct DamageUpdate {
    stiffness: [Voigt; 6],
    growth: DamageGrowth,
}

/// Returns the equivalent strain √Σ⟨ε_i⟩² and its derivative by the strain.
fn equivalent(strain: &Voigt) -> (f64, Voigt) {
    let [xx, yy, zz, xy, yz, zx] = *strain;
    let (values, axes) = principal(&[xx, yy, zz, 0.5 * xy, 0.5 * yz, 0.5 * zx]);
    let positive = values.map(|value| value.max(0.0));
    let size = positive.iter().map(|value| value * value).sum::<f64>().sqrt();
    if size == 0.0 {
        return (0.0, [0.0; 6]);
    }
    (size, in_space(&positive.map(|value| value / size), &axes, 1.0))
}

impl StressUpdate for DamageUpdate {
    fn state_size(&self) -> usize {
        1
    }

    fn initial_state(&self, state: &mut [f64]) {
        state[0] = 0.0;
    }

    fn state_names(&self) -> &'static [&'static str] {
        &["greatest_equivalent_strain [-]"]
    }

    fn largest_length(&self) -> f64 {
        self.growth.largest_length()
    }

    /// Cracks close when the stress is released: no strain remains.
    fn inelastic_strain(&self, _: &Voigt, _: &[f64]) -> Option<Voigt> {
        Some([0.0; 6])
    }

    fn update_point(
        &self,
        strain: &Voigt,
        context: &UpdateContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<StressPoint, UpdateFailure> {
        if !strain.iter().chain(old).all(|x| x.is_finite()) {
            return Err(UpdateFailure::NotFinite);
        }
        if context.length > self.largest_length() {
            return Err(UpdateFailure::LengthTooLarge);
        }
        let (size, by_strain) = equivalent(strain);
        let grows = size > old[0].max(self.growth.onset);
        new[0] = if grows { size } else { old[0] };
        let [damage, slope] = self.growth.at(new[0], context.length);
        let [before, _] = self.growth.at(old[0], context.length);
        let sound: Voigt = std::array::from_fn(|i| (0..6).map(|j| self.stiffness[i][j] * strain[j]).sum());
        let energy = 0.5 * sound.iter().zip(strain).map(|(s, e)| s * e).sum::<f64>();
        let slope = if grows { slope } else { 0.0 };
        let tangent = std::array::from_fn(|i| {
            std::array::from_fn(|j| (1.0 - damage) * self.stiffness[i][j] - sound[i] * slope * by_strain[j])
        });
        let branch = match (grows, damage > 0.0) {
            (true, _) => DAMAGE,
            (false, true) => UpdateBranch::UNLOADING,
            (false, false) => UpdateBranch::ELASTIC,
        };
        Ok(StressPoint {
            stress: sound.map(|s| (1.0 - damage) * s),
            tangent,
            branch,
            stored: (1.0 - damage) * energy,
            dissipated: (damage - before) * energy,
        })
    }
}

/// E = 10 GPa, ν = 0, element of 1 m: κ₀ = 1e-4 and tail = G_f/(ℓ f_t) − κ₀/2 = 1e-4. Torn to half the tail, unloaded along the
/// secant, compressed with the damaged stiffness.
const KNOWN_PATH: KnownPath = KnownPath {
    table: "young_modulus = 1e10\npoisson_ratio = 0.0\ndensity = 2200.0\ntensile_strength = 1e6\nfracture_energy = 150.0",
    source: "by hand: σ = f_t exp(−(κ − κ₀)/tail) at κ = 1.5e-4, then along the line through the origin",
    steps: &[
        (&[1e-4, 0.0, 0.0, 0.0, 0.0, 0.0], &[1e6, 0.0, 0.0, 0.0, 0.0, 0.0]),
        (&[1.5e-4, 0.0, 0.0, 0.0, 0.0, 0.0], &[606_530.659_712_633_4, 0.0, 0.0, 0.0, 0.0, 0.0]),
        (&[5e-5, 0.0, 0.0, 0.0, 0.0, 0.0], &[202_176.886_570_877_8, 0.0, 0.0, 0.0, 0.0, 0.0]),
        (&[-5e-5, 0.0, 0.0, 0.0, 0.0, 0.0], &[-202_176.886_570_877_8, 0.0, 0.0, 0.0, 0.0, 0.0]),
    ],
    tolerance: 1e-12,
};

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::BulkMaterial,
        tag: "mazars_damage",
        summary: "loses stiffness by positive principal strains; exponential softening with a fracture energy",
        provides: &[Capability::STRESS_UPDATE, Capability::RIGID_LIMIT],
        claims: &[Property::DISSIPATIVE, Property::ISOTROPIC],
        samples: &[
            Sample::new("young_modulus = 1e10\npoisson_ratio = 0.2\ndensity = 2200.0\ntensile_strength = 1e6\nfracture_energy = 200.0", 2e-4, &["elastic", "damage", "unloading"]),
        ],
        known_paths: &[KNOWN_PATH],
        sources: &[
            "Mazars & Pijaudier-Cabot 1989, J. Eng. Mech. 115 (equivalent strain)",
            "Bažant & Oh 1983, Mater. Struct. 16 (crack band: softening by element length)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("mazars_damage.md"),
        ..Card::of::<MazarsDamage>()
    }
}
