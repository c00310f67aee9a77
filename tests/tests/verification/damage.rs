//! Materials whose stiffness changes: a damaged block unloads along its damaged stiffness.

use serde::{Deserialize, Serialize};
use std::sync::Arc;
use voussoir::core::law::{BulkMaterial, Elasticity, StressPoint, StressUpdate, UpdateContext, UpdateFailure, Voigt};
use voussoir::core::limit::Status;
use voussoir::core::plugin::{Capability, Card, Parameter, PluginKind, Quantity, Range};
use voussoir::laws::mazars_damage::MazarsDamage;
use voussoir_tests::{answered, assert_close, changed};

/// A block of 1 m that is bonded to the ground and pushed sideways at its top by 250 kN, then by 50 kN only.
const PULL: &str = r#"name = "pull"
[scene]
scene = "blocks"
width = 1.0
material = "stone"
joint = "glue"
plane = "stress"
mesh = { elements = [4, 4] }
blocks = [
  { name = "ground", fixed = true, vertices = [[-1.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-1.0, 0.0]] },
  { name = "stone", vertices = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]] },
]
[materials.stone]
law = "mazars_damage"
young_modulus = 1e10
poisson_ratio = 0.0
density = 2200.0
tensile_strength = 1e6
fracture_energy = 20000.0
[joints.glue]
law = "mohr_coulomb"
friction = 1.0
cohesion = 1e9
tensile_strength = 1e9
[[stages]]
name = "pull"
gravity = 0.0
factor = 1.0
loads = [{ kind = "point", block = "stone", point = [0.5, 1.0], force = ["250 kN", "0 kN"] }]
[[stages]]
name = "back"
factor = 1.0
loads = [{ kind = "point", block = "stone", point = [0.5, 1.0], force = ["-200 kN", "0 kN"] }]
[output]
curve = true
"#;

/// Returns the compliance [m/N] at every state of the second stage, in which 250 kN decrease to 50 kN.
fn compliances(text: &str) -> Vec<f64> {
    let result = answered(text);
    assert_eq!((result.status, result.certificate.passed), (Status::Stands, true), "{:?}", result.notes);
    let curve = result.path.curve.expect("a curve");
    curve.iter().map(|[displacement, factor]| -displacement / (250e3 - 200e3 * factor)).collect()
}

/// Isotropic damage unloads along a line through the origin: all states have the same compliance. The number at the end comes from a
/// run in which unloading was declared as softening, so that every step used the law's tangent.
#[test]
fn a_damaged_block_unloads_through_the_origin() {
    let found = compliances(PULL);
    let last = *found.last().expect("states");
    assert_close(last, 2.896_882_00e-5 / 50e3, 1e-7);
    found.iter().for_each(|own| assert_close(*own, last, 1e-8));
}

/// In a bar under uniform tension the output is D of the law at its strain. Damage of the bent block is least at mid-width, and its
/// greatest value in the block is the greatest one of its points.
#[test]
fn the_outputs_give_the_damage() {
    let result = answered(PULL);
    let of = |name: &str| result.outputs.iter().find(|entry| entry.name == name).expect("an output");
    let (points, block, case) = (of("damage"), of("block_damage"), of("greatest_damage"));
    let values: Vec<f64> = points.values.iter().map(|value| value.expect("a number")).collect();
    let greatest = values.iter().copied().fold(0.0, f64::max);
    assert!(values.iter().all(|own| (0.0..1.0).contains(own)) && greatest > 0.0, "{values:?}");
    assert_eq!((block.places.as_slice(), block.values.as_slice()), (&[1][..], &[Some(greatest)][..]));
    assert_eq!(case.values, [Some(greatest)]);
    // D = 1 − κ₀/κ exp(−(κ − κ₀)/t) at the greatest κ that is stored.
    let (onset, length) = (1e6 / 1e10, 0.25);
    let tail = 20_000.0 / (length * 1e6) - 0.5 * onset;
    let kappa = result.path.yielded.iter().flat_map(|entry| &entry.points).map(|point| point.3[0]).fold(0.0, f64::max);
    assert_close(greatest, 1.0 - onset / kappa * (-(kappa - onset) / tail).exp(), 1e-12);
    // Points are inside the block, and their areas add up to it.
    assert!(points.positions.iter().flatten().all(|x| (0.0..1.0).contains(x)));
    let (area, mean) =
        (of("damaged_area").values[0].expect("a number"), values.iter().sum::<f64>() / values.len() as f64);
    assert!(area > 0.0 && area < greatest && mean < greatest, "{area} {mean}");
}

/// The same holds if cracks can close and the block can crush far above these stresses, with another element order, in plane
/// strain, and on another mesh.
#[test]
fn unloading_does_not_depend_on_the_form_of_damage() {
    let both = PULL.replace("law = \"mazars_damage\"", "law = \"damage_plasticity\"\ncompressive_strength = 1e9");
    for text in [
        both.clone(),
        changed(&both, "elements = [4, 4]", "elements = [4, 4], order = 1"),
        changed(&both, "plane = \"stress\"", "plane = \"strain\""),
        changed(PULL, "elements = [4, 4]", "elements = [3, 3]"),
    ] {
        let found = compliances(&text);
        let last = *found.last().expect("states");
        found.iter().for_each(|own| assert_close(*own, last, 1e-6));
    }
}

/// Damage as shared libraries give it: the state also holds strain and stress at the end of the last step.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct DamageWithMemory {
    tensile_strength: f64,
}

impl DamageWithMemory {
    fn inner(&self) -> MazarsDamage {
        MazarsDamage {
            young_modulus: 1e10,
            poisson_ratio: 0.0,
            density: 2200.0,
            tensile_strength: self.tensile_strength,
            fracture_energy: 2e4,
        }
    }
}

#[typetag::serde(name = "damage_with_memory")]
impl BulkMaterial for DamageWithMemory {
    fn density(&self) -> f64 {
        2200.0
    }

    fn elasticity(&self) -> Option<Elasticity> {
        self.inner().elasticity()
    }

    fn inelastic(&self) -> Option<Arc<dyn StressUpdate>> {
        Some(Arc::new(Remembering(self.inner().inelastic()?)))
    }
}

#[derive(Debug)]
struct Remembering(Arc<dyn StressUpdate>);

impl StressUpdate for Remembering {
    fn state_size(&self) -> usize {
        13
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &["damage", "e1", "e2", "e3", "e4", "e5", "e6", "s1", "s2", "s3", "s4", "s5", "s6"]
    }

    fn update_point(
        &self,
        strain: &Voigt,
        context: &UpdateContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<StressPoint, UpdateFailure> {
        let said = self.0.update_point(strain, context, &old[..1], &mut new[..1])?;
        new[1..7].copy_from_slice(strain);
        new[7..].copy_from_slice(&said.stress);
        Ok(said)
    }
}

voussoir::core::inventory::submit! {
    Card {
        kind: PluginKind::BulkMaterial,
        tag: "damage_with_memory",
        summary: "for this test",
        parameters: &[Parameter::number("tensile_strength", Quantity::Stress, Range::POSITIVE, "f_t")],
        provides: &[Capability::STRESS_UPDATE, Capability::RIGID_LIMIT],
        sources: &["this test"],
        file: file!(),
        page: "for this test",
        ..Card::BLANK
    }
}

/// A law may write strain and stress into its state in an elastic step. Certificates of states before the first damage start
/// from that state, and the answer is the same.
#[test]
fn a_law_that_remembers_strain_and_stress_is_confirmed() {
    let plain = "law = \"mazars_damage\"\nyoung_modulus = 1e10\npoisson_ratio = 0.0\ndensity = 2200.0\ntensile_strength = 1e6\nfracture_energy = 20000.0";
    let found = compliances(&changed(PULL, plain, "law = \"damage_with_memory\"\ntensile_strength = 1e6"));
    assert_close(*found.last().expect("states"), 2.896_882_00e-5 / 50e3, 1e-7);
}
