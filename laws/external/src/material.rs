//! `external` for materials: a behaviour with small strains in space. The library orders tensors xx, yy, zz, xy, xz, yz
//! and multiplies off-diagonal components by √2.

use crate::behaviour::{Family, Request, Wrong};
use crate::joint::ExternalJoint;
use crate::runner::Runner;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_1_SQRT_2;
use std::sync::Arc;
use voussoir_core::law::{BulkMaterial, Elasticity, StressPoint, StressUpdate, UpdateContext, UpdateFailure, Voigt};
use voussoir_core::plugin::{Capability, Card, Keys, PluginKind};

/// A behaviour with small strains from a shared library.
#[derive(Debug, Clone, Keys)]
#[keys(check = complaints)]
pub struct ExternalMaterial {
    /// Path of the library.
    #[key(like = ExternalJoint)]
    pub library: String,
    /// Name of the behaviour.
    #[key(like = ExternalJoint)]
    pub behaviour: String,
    /// Material properties by their names in the library.
    #[key(like = ExternalJoint, default)]
    pub properties: BTreeMap<String, f64>,
    /// Temperature \[K\].
    #[key(like = ExternalJoint, default)]
    pub temperature: f64,
    /// External state variables by their names in the library, without the temperature.
    #[key(like = ExternalJoint, default)]
    pub variables: BTreeMap<String, f64>,
    /// True if it runs in a separate process.
    #[key(like = ExternalJoint, default)]
    pub isolate: bool,
    /// mass per volume
    #[key(unit = "kg/m3", range = ">= 0")]
    pub density: f64,
}

/// Place of each of our components in the order of the library, and the factor from our engineering strains to its
/// strains; the same factor converts its stresses to ours.
const PLACES: [(usize, f64); 6] =
    [(0, 1.0), (1, 1.0), (2, 1.0), (3, FRAC_1_SQRT_2), (5, FRAC_1_SQRT_2), (4, FRAC_1_SQRT_2)];

fn ours(tangent: &[[f64; 6]; 6]) -> [Voigt; 6] {
    PLACES.map(|(row, by)| PLACES.map(|(column, along)| by * along * tangent[row][column]))
}

impl ExternalMaterial {
    fn load(&self) -> Result<Runner, Wrong> {
        let request = Request {
            library: &self.library,
            behaviour: &self.behaviour,
            properties: &self.properties,
            variables: &self.variables,
            temperature: self.temperature,
            density: self.density,
        };
        Runner::load::<6>(&request, &Family::SMALL_STRAIN, self.isolate)
    }
}

#[typetag::serde(name = "external")]
impl BulkMaterial for ExternalMaterial {
    fn density(&self) -> f64 {
        self.density
    }

    fn elasticity(&self) -> Option<Elasticity> {
        let stiffness = ours(&self.load().ok()?.at_rest::<6>().ok()?);
        let modulus = stiffness[0][0];
        Some(Elasticity { modulus, relative: stiffness.map(|row| row.map(|entry| entry / modulus)) })
    }

    fn inelastic(&self) -> Option<Arc<dyn StressUpdate>> {
        Some(Arc::new(ExternalUpdate(self.load().ok()?)))
    }
}

#[derive(Debug)]
struct ExternalUpdate(Runner);

impl StressUpdate for ExternalUpdate {
    fn state_size(&self) -> usize {
        self.0.names().len()
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        self.0.names()
    }

    fn update_point(
        &self,
        strain: &Voigt,
        context: &UpdateContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<StressPoint, UpdateFailure> {
        let mut theirs = [0.0; 6];
        for ((place, by), own) in PLACES.iter().zip(strain) {
            theirs[*place] = by * own;
        }
        let step = self.0.step(theirs, context.time_step, old, new)?;
        Ok(StressPoint {
            stress: PLACES.map(|(place, by)| by * step.forces[place]),
            tangent: ours(&step.tangent),
            branch: step.branch,
            stored: step.stored,
            dissipated: step.dissipated,
        })
    }
}

/// The reason why there is no behaviour, for cards.
fn complaints(law: &ExternalMaterial) -> Vec<(String, String)> {
    law.load().err().unwrap_or_default()
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::BulkMaterial,
        tag: "external",
        summary: "a behaviour of small strains of a shared library, by MFront's generic interface",
        provides: &[Capability::STRESS_UPDATE],
        sources: &["Helfer et al. 2020, J. Open Source Softw. 5(48) (the generic interface)"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("external.md"),
        ..Card::of::<ExternalMaterial>()
    }
}
