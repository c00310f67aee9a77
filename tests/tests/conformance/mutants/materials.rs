//! Stress updates with one fault each: a cone that softens.

use super::every_fault_is_found;
use serde::{Deserialize, Serialize};
use std::sync::Arc;
use voussoir::core::law::{
    BulkMaterial, Effect, Elasticity, StressPoint, StressUpdate, UpdateBranch, UpdateContext, UpdateFailure, Voigt,
};
use voussoir::core::plugin::{
    Capability, Card, KnownPath, Need, Parameter, PluginKind, Property, Quantity, Range, Sample, Shape,
};
use voussoir::laws::drucker_prager_softening::DruckerPragerSoftening;

#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct MutantMaterial {
    fault: String,
    young_modulus: f64,
    yield_stress: f64,
}

impl MutantMaterial {
    fn inner(&self) -> DruckerPragerSoftening {
        let extra = if self.fault == "a_number_of_its_own" { 5e6 } else { 0.0 };
        DruckerPragerSoftening {
            young_modulus: self.young_modulus,
            poisson_ratio: 0.2,
            density: 2000.0,
            pressure_coefficient: 0.3,
            yield_stress: self.yield_stress + extra,
            residual_stress: 0.1 * self.yield_stress,
            ultimate_plastic_strain: Some(0.02),
            crushing_fracture_energy: None,
        }
    }
}

#[typetag::serde(name = "mutant_material")]
impl BulkMaterial for MutantMaterial {
    fn density(&self) -> f64 {
        if self.fault == "negative_density" { -1.0 } else { 2000.0 }
    }

    fn elasticity(&self) -> Option<Elasticity> {
        let share = if self.fault == "elasticity_of_another" { 2.0 } else { 1.0 };
        Some(Elasticity::isotropic(share * self.young_modulus, 0.2))
    }

    fn inelastic(&self) -> Option<Arc<dyn StressUpdate>> {
        Some(Arc::new(Mutated { inner: self.inner().inelastic()?, fault: self.fault.clone() }))
    }
}

#[derive(Debug, Clone)]
struct Mutated {
    inner: Arc<dyn StressUpdate>,
    fault: String,
}

impl StressUpdate for Mutated {
    fn state_size(&self) -> usize {
        self.inner.state_size()
    }

    fn initial_state(&self, state: &mut [f64]) {
        self.inner.initial_state(state);
    }

    fn state_names(&self) -> &'static [&'static str] {
        self.inner.state_names()
    }

    fn update_point(
        &self,
        strain: &Voigt,
        context: &UpdateContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<StressPoint, UpdateFailure> {
        let mut asked = *strain;
        match self.fault.as_str() {
            "stress_of_the_wrong_sign" => asked = asked.map(|e| -e),
            "one_axis_is_stiffer" => asked[0] *= 1.2,
            _ => {}
        }
        let mut said = self.inner.update_point(&asked, context, old, new)?;
        let yields = !said.branch.is_elastic();
        match self.fault.as_str() {
            "tangent_off_the_diagonal" if yields => said.tangent[0][3] *= -1.0,
            "tangent_of_elasticity" if yields => {
                said.tangent = Elasticity::isotropic(5e9, 0.2).stiffness();
            }
            "state_forgotten_on_unloading" if !yields => new.fill(0.0),
            "plastic_strain_half_kept" => new[3] = 0.5 * (old[3] + new[3]),
            "called_elastic" => said.branch = UpdateBranch::ELASTIC,
            "called_yielding" => said.branch = UpdateBranch::new("shear", Effect::Yielding),
            "zero_dissipation" => said.dissipated = 0.0,
            "negative_dissipation" => said.dissipated *= -1.0,
            "not_a_number_at_no_strain" if strain[0] == 0.0 => said.stress[1] *= 0.0 / strain[0],
            "allocates" => said.stored += vec![0.0; new.len()].iter().sum::<f64>(),
            _ => {}
        }
        Ok(said)
    }
}

const CARD: Card = Card {
    kind: PluginKind::BulkMaterial,
    tag: "mutant_material",
    summary: "for this test",
    parameters: &[
        Parameter { name: "fault", doc: "which", shape: Shape::Text, need: Need::Required },
        Parameter::number("young_modulus", Quantity::Stress, Range::POSITIVE, "E"),
        Parameter::number("yield_stress", Quantity::Stress, Range::POSITIVE, "R"),
    ],
    provides: &[Capability::STRESS_UPDATE, Capability::RIGID_LIMIT],
    claims: &[Property::DISSIPATIVE, Property::ISOTROPIC, Property::SYMMETRIC_TANGENT],
    // In pure shear yield begins at q = √3 G γ = R, and A is the pressure coefficient: the path leaves the cone and
    // returns.
    known_paths: &[KnownPath {
        table: TABLE,
        source: "by hand: tension from all sides ends at the tip, where q = 0 and A tr σ = R(κ); then back with 3 K",
        steps: &[
            (&[0.01, 0.01, 0.01, 0.0, 0.0, 0.0], &[TIP, TIP, TIP, 0.0, 0.0, 0.0]),
            (&[0.0099, 0.0099, 0.0099, 0.0, 0.0, 0.0], &[TIP - BACK, TIP - BACK, TIP - BACK, 0.0, 0.0, 0.0]),
        ],
        tolerance: 1e-9,
    }],
    sources: &["this test"],
    file: file!(),
    page: "for this test",
    ..Card::BLANK
};

const TABLE: &str = "young_modulus = 5e9\nyield_stress = 1e7";

/// 3 K = E / (1 − 2ν).
const TRIPLE_BULK: f64 = 5e9 / 0.6;
/// Stress σ at the tip of the cone when R has decreased to R_u: 3 A σ = R_u.
const TIP: f64 = 1e6 / 0.9;
const BACK: f64 = TRIPLE_BULK * 1e-4;

#[test]
fn materials_with_a_fault_are_found() {
    let faults: [(&str, &[&str]); 15] = [
        ("tangent_off_the_diagonal", &["tangent", "symmetry"]),
        ("tangent_of_elasticity", &["tangent"]),
        ("state_forgotten_on_unloading", &["memory"]),
        ("plastic_strain_half_kept", &["memory"]),
        ("called_elastic", &["regions"]),
        ("called_yielding", &["regions"]),
        ("zero_dissipation", &["energy"]),
        ("negative_dissipation", &["dissipation"]),
        ("not_a_number_at_no_strain", &["untouched", "finite"]),
        ("allocates", &["allocation"]),
        ("stress_of_the_wrong_sign", &["normal"]),
        ("one_axis_is_stiffer", &["isotropy", "tangent"]),
        ("elasticity_of_another", &["regions"]),
        ("negative_density", &["density"]),
        ("a_number_of_its_own", &["units"]),
    ];
    every_fault_is_found(&CARD, TABLE, Sample::new("", 2e-3, &["elastic", "shear", "apex"]), &faults);
}
