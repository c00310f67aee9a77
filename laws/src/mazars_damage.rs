//! `mazars_damage`: a material that loses stiffness by positive principal strains.
#![doc = include_str!("mazars_damage.md")]

use crate::damage::{DamageGrowth, positive_norm, strain_tensor};
use crate::shared::MaterialKeys;
use std::sync::Arc;
use voussoir_core::law::{
    BulkMaterial, Effect, Elasticity, StressPoint, StressUpdate, UpdateBranch, UpdateContext, UpdateFailure, Voigt,
};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, Output, PluginKind, Property, Sample};

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

/// The law at a point. State: κ, the greatest equivalent strain so far.
#[derive(Debug)]
struct DamageUpdate {
    stiffness: [Voigt; 6],
    growth: DamageGrowth,
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
        self.growth.check(strain, old, context)?;
        let (size, by_strain) = positive_norm(&strain_tensor(strain), 1.0);
        let step = self.growth.step(size, old[0], context.length);
        new[0] = step.kappa;
        let intact = 1.0 - step.damage;
        let sound: Voigt = std::array::from_fn(|i| (0..6).map(|j| self.stiffness[i][j] * strain[j]).sum());
        let energy = 0.5 * sound.iter().zip(strain).map(|(s, e)| s * e).sum::<f64>();
        let tangent = std::array::from_fn(|i| {
            std::array::from_fn(|j| intact * self.stiffness[i][j] - sound[i] * step.slope * by_strain[j])
        });
        let branch = match (step.grows, step.damage > 0.0) {
            (true, _) => DAMAGE,
            (false, true) => UpdateBranch::UNLOADING,
            (false, false) => UpdateBranch::ELASTIC,
        };
        Ok(StressPoint {
            stress: sound.map(|s| intact * s),
            tangent,
            branch,
            stored: intact * energy,
            dissipated: step.growth * energy,
        })
    }

    fn outputs(&self, _: &Voigt, context: &UpdateContext, state: &[f64], _: &StressPoint, values: &mut [f64]) {
        values[0] = self.growth.step(0.0, state[0], context.length).damage;
    }
}

const OUTPUTS: &[Output] = &[
    Output::point("damage", "-", "D: 0 if the material is sound, 1 if it has no stiffness"),
    Output::block("block_damage", "-", "greatest damage in the block").greatest("damage"),
    Output::block("damaged_area", "m2", "integral of the damage over the block").integral("damage"),
    Output::case("greatest_damage", "-", "greatest damage in all blocks").greatest("damage"),
];

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
        outputs: OUTPUTS,
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
