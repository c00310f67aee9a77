//! `damage_plasticity`: masonry that cracks by damage and crushes by plastic flow; cracks close under compression.
#![doc = include_str!("damage_plasticity.md")]

use crate::damage::{DamageGrowth, positive_norm, strain_tensor};
use crate::meridian::state_names;
use crate::principal::{PrincipalFacet, PrincipalUpdate, in_space, principal};
use crate::shared::MaterialKeys;
use std::sync::Arc;
use voussoir_core::law::{
    BulkMaterial, Effect, Elasticity, StressPoint, StressUpdate, UpdateBranch, UpdateContext, UpdateFailure, Voigt,
};
use voussoir_core::plugin::{Capability, Card, Keys, KnownPath, PluginKind, Property, Sample};

/// Damage in tension, perfect plasticity in compression.
#[derive(Debug, Clone, Keys)]
pub struct DamagePlasticity {
    /// E \[Pa\].
    #[key(like = MaterialKeys)]
    pub young_modulus: f64,
    /// ν of the undamaged material
    #[key(unit = "-", range = ">= 0, < 0.5")]
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
    /// f_c, uniaxial strength in compression
    #[key(unit = "Pa", range = "> 0")]
    pub compressive_strength: f64,
}

/// It crushes.
const CRUSHING: UpdateBranch = UpdateBranch::new("crushing", Effect::Yielding);
/// Damage grows.
const DAMAGE: UpdateBranch = UpdateBranch::new("damage", Effect::Tearing);
/// It crushes along one axis while damage grows across it.
const BOTH: UpdateBranch = UpdateBranch::new("damage_and_crushing", Effect::Yielding);

fn crushing(_: usize, _: usize) -> UpdateBranch {
    CRUSHING
}

#[typetag::serde(name = "damage_plasticity")]
impl BulkMaterial for DamagePlasticity {
    fn density(&self) -> f64 {
        self.density
    }

    fn elasticity(&self) -> Option<Elasticity> {
        Some(Elasticity::isotropic(self.young_modulus, self.poisson_ratio))
    }

    fn inelastic(&self) -> Option<Arc<dyn StressUpdate>> {
        let facet = |i: usize| {
            let normal: [f64; 3] = std::array::from_fn(|j| if i == j { -1.0 } else { 0.0 });
            PrincipalFacet { normal, bound: self.compressive_strength, flow: normal, tension: false }
        };
        let elasticity = self.elasticity()?;
        let (e, nu) = (self.young_modulus, self.poisson_ratio);
        Some(Arc::new(MasonryUpdate {
            young_modulus: e,
            lame: [e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu))],
            stiffness: elasticity.stiffness(),
            compliance: elasticity.compliance().map(|row| row.map(|c| c / elasticity.modulus)),
            plastic: PrincipalUpdate::new(e, nu, [0, 1, 2].map(facet).to_vec(), crushing),
            growth: DamageGrowth {
                onset: self.tensile_strength / e,
                strength: self.tensile_strength,
                energy: self.fracture_energy,
            },
        }))
    }
}

/// The law at a point. State: plastic strain (engineering shears) and κ, the greatest equivalent strain so far.
#[derive(Debug)]
struct MasonryUpdate {
    young_modulus: f64,
    /// λ and G \[Pa\].
    lame: [f64; 2],
    stiffness: [Voigt; 6],
    compliance: [Voigt; 6],
    plastic: PrincipalUpdate,
    growth: DamageGrowth,
}

const KAPPA: usize = 6;

static STATE: [&str; 7] = state_names(&["greatest_equivalent_strain [-]"]);

fn times(matrix: &[Voigt; 6], vector: &Voigt) -> Voigt {
    std::array::from_fn(|i| (0..6).map(|j| matrix[i][j] * vector[j]).sum())
}

fn product(a: &[Voigt; 6], b: &[Voigt; 6]) -> [Voigt; 6] {
    std::array::from_fn(|i| std::array::from_fn(|j| (0..6).map(|k| a[i][k] * b[k][j]).sum()))
}

fn dot(a: &Voigt, b: &Voigt) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The tensile part of the elastic energy.
struct Tension {
    /// ψ⁺ \[J/m³\].
    energy: f64,
    /// σ⁺ = ∂ψ⁺/∂e \[Pa\].
    stress: Voigt,
    /// ∂σ⁺/∂e \[Pa\].
    stiffness: [Voigt; 6],
}

impl MasonryUpdate {
    /// Returns the tensile part ψ⁺ = ½ λ ⟨tr e⟩² + G Σ⟨e_i⟩² with its derivatives.
    fn tension(&self, elastic: &Voigt) -> Tension {
        let [lambda, shear] = self.lame;
        let (values, axes) = principal(&strain_tensor(elastic));
        let trace: f64 = values.iter().sum();
        let (volume, positive) = (trace.max(0.0), values.map(|value| value.max(0.0)));
        let energy = 0.5 * lambda * volume * volume + shear * positive.iter().map(|e| e * e).sum::<f64>();
        let stress = in_space(&positive.map(|e| lambda * volume + 2.0 * shear * e), &axes, 1.0);
        let grows = |value: f64| if value > 0.0 { 1.0 } else { 0.0 };
        // ⟨e⟩ has the component θ e_ij in the axes, with θ the secant of ⟨·⟩ between both principal values.
        let secant = |i: usize, j: usize| {
            let difference = values[i] - values[j];
            if difference == 0.0 { grows(values[i]) } else { (positive[i] - positive[j]) / difference }
        };
        let relative = std::array::from_fn(|i| {
            std::array::from_fn(|j| match (i, j) {
                (0..3, 0..3) if i == j => lambda * grows(trace) + 2.0 * shear * grows(values[i]),
                (0..3, 0..3) => lambda * grows(trace),
                _ if i == j => shear * secant(i - 3, (i - 2) % 3),
                _ => 0.0,
            })
        });
        let stiffness = Elasticity { modulus: 1.0, relative }.turned(&axes).relative;
        Tension { energy, stress, stiffness }
    }

    /// Returns the equivalent strain √Σ⟨σ̃_i⟩² / E and its derivative by the elastic strain.
    fn equivalent(&self, stress: &Voigt) -> (f64, Voigt) {
        let (norm, by_stress) = positive_norm(stress, 2.0);
        (norm / self.young_modulus, times(&self.stiffness, &by_stress.map(|entry| entry / self.young_modulus)))
    }
}

impl StressUpdate for MasonryUpdate {
    fn state_size(&self) -> usize {
        STATE.len()
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &STATE
    }

    fn largest_length(&self) -> f64 {
        self.growth.largest_length()
    }

    /// Crushing is permanent; cracks close when the stress is released.
    fn inelastic_strain(&self, _: &Voigt, state: &[f64]) -> Option<Voigt> {
        Some(std::array::from_fn(|i| state[i]))
    }

    fn update_point(
        &self,
        strain: &Voigt,
        context: &UpdateContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<StressPoint, UpdateFailure> {
        self.growth.check(strain, old, context)?;
        let sound = self.plastic.update_point(strain, context, &old[..KAPPA], &mut new[..KAPPA])?;
        let elastic: Voigt = std::array::from_fn(|i| strain[i] - new[i]);
        let flow: Voigt = std::array::from_fn(|i| new[i] - old[i]);
        let (size, by_strain) = self.equivalent(&sound.stress);
        let step = self.growth.step(size, old[KAPPA], context.length);
        new[KAPPA] = step.kappa;
        let damage = step.damage;
        let crushes = !sound.branch.is_elastic();
        let branch = match (crushes, step.grows) {
            (true, true) => BOTH,
            (true, false) => CRUSHING,
            (false, true) => DAMAGE,
            (false, false) if damage > 0.0 => UpdateBranch::UNLOADING,
            (false, false) => return Ok(sound),
        };
        let tension = self.tension(&elastic);
        let by_elastic: [Voigt; 6] = std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                self.stiffness[i][j] - damage * tension.stiffness[i][j] - tension.stress[i] * step.slope * by_strain[j]
            })
        });
        let stress: Voigt = std::array::from_fn(|i| sound.stress[i] - damage * tension.stress[i]);
        let tangent = match crushes {
            true => product(&by_elastic, &product(&self.compliance, &sound.tangent)),
            false => by_elastic,
        };
        Ok(StressPoint {
            stress,
            tangent,
            branch,
            stored: sound.stored - damage * tension.energy,
            dissipated: dot(&stress, &flow) + step.growth * tension.energy,
        })
    }
}

/// E = 10 GPa, ν = 0, element of 1 m: κ₀ = 1e-4, tail 1e-4, f_c = 2 MPa. Torn, unloaded along the secant, pressed with the crack
/// closed, crushed, unloaded, and stretched again with the damage of the first time.
const KNOWN_PATH: KnownPath = KnownPath {
    table: "young_modulus = 1e10\npoisson_ratio = 0.0\ndensity = 2200.0\ntensile_strength = 1e6\nfracture_energy = 150.0\ncompressive_strength = 2e6",
    source: "by hand: σ = f_t exp(−(κ − κ₀)/tail) at κ = 1.5e-4; E ε under compression up to −f_c; (1 − D) E (ε − ε^p) after it",
    steps: &[
        (&[1e-4, 0.0, 0.0, 0.0, 0.0, 0.0], &[1e6, 0.0, 0.0, 0.0, 0.0, 0.0]),
        (&[1.5e-4, 0.0, 0.0, 0.0, 0.0, 0.0], &[606_530.659_712_633_4, 0.0, 0.0, 0.0, 0.0, 0.0]),
        (&[5e-5, 0.0, 0.0, 0.0, 0.0, 0.0], &[202_176.886_570_877_8, 0.0, 0.0, 0.0, 0.0, 0.0]),
        (&[-1e-4, 0.0, 0.0, 0.0, 0.0, 0.0], &[-1e6, 0.0, 0.0, 0.0, 0.0, 0.0]),
        (&[-3e-4, 0.0, 0.0, 0.0, 0.0, 0.0], &[-2e6, 0.0, 0.0, 0.0, 0.0, 0.0]),
        (&[-2e-4, 0.0, 0.0, 0.0, 0.0, 0.0], &[-1e6, 0.0, 0.0, 0.0, 0.0, 0.0]),
        (&[0.0, 0.0, 0.0, 0.0, 0.0, 0.0], &[404_353.773_141_755_6, 0.0, 0.0, 0.0, 0.0, 0.0]),
    ],
    tolerance: 1e-12,
};

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::BulkMaterial,
        tag: "damage_plasticity",
        summary: "masonry: damage in tension with a fracture energy, plastic crushing, cracks that close",
        provides: &[Capability::STRESS_UPDATE, Capability::RIGID_LIMIT],
        claims: &[Property::DISSIPATIVE, Property::ISOTROPIC],
        samples: &[
            Sample::new("young_modulus = 1e10\npoisson_ratio = 0.2\ndensity = 2200.0\ntensile_strength = 1e6\nfracture_energy = 200.0\ncompressive_strength = 3e6", 3e-4, &["elastic", "damage", "unloading", "crushing", "damage_and_crushing"]),
        ],
        known_paths: &[KNOWN_PATH],
        sources: &[
            "Miehe, Welschinger & Hofacker 2010, Int. J. Numer. Meth. Eng. 83 (tensile part of the energy)",
            "Lubliner, Oliver, Oller & Oñate 1989, Int. J. Solids Struct. 25 (damage with plastic flow)",
            "Bažant & Oh 1983, Mater. Struct. 16 (crack band: softening by element length)",
        ],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("damage_plasticity.md"),
        ..Card::of::<DamagePlasticity>()
    }
}
