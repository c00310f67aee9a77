//! `external` for joints: a cohesive zone model. Openings and tractions of the library are positive in tension.

use crate::behaviour::{Family, Request, Wrong};
use crate::runner::Runner;
use std::collections::BTreeMap;
use std::sync::Arc;
use voussoir_core::law::{InterfaceLaw, InterfaceResponse, PointContext, TractionPoint, UpdateFailure};
use voussoir_core::plugin::{Capability, Card, Keys, PluginKind};

/// A cohesive zone model from a shared library.
#[derive(Debug, Clone, Keys)]
#[keys(check = complaints)]
pub struct ExternalJoint {
    /// path of the shared library; the command line must allow it: --allow-library PATH
    pub library: String,
    /// name of the behaviour in the library
    pub behaviour: String,
    /// its material properties, by their names in the library and in SI units
    #[key(unit = "-", default = {})]
    pub properties: BTreeMap<String, f64>,
    /// temperature
    #[key(unit = "K", range = "> 0", default = 293.15)]
    pub temperature: f64,
    /// its external state variables without the temperature, by their names in the library
    #[key(unit = "-", default = {})]
    pub variables: BTreeMap<String, f64>,
    /// true if it runs in a separate process, so that a crash of it ends one case only
    #[key(default = false)]
    pub isolate: bool,
}

impl ExternalJoint {
    fn load(&self) -> Result<Runner, Wrong> {
        let request = Request {
            library: &self.library,
            behaviour: &self.behaviour,
            properties: &self.properties,
            variables: &self.variables,
            temperature: self.temperature,
            density: 0.0,
        };
        Runner::load::<2>(&request, &Family::COHESIVE_ZONE, self.isolate)
    }
}

#[typetag::serde(name = "external")]
impl InterfaceLaw for ExternalJoint {
    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        Some(Arc::new(ExternalResponse(self.load().ok()?)))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        let tangent = self.load().ok()?.at_rest::<2>().ok()?;
        Some([tangent[0][0], tangent[1][1]])
    }
}

#[derive(Debug)]
struct ExternalResponse(Runner);

impl InterfaceResponse for ExternalResponse {
    fn state_size(&self) -> usize {
        self.0.names().len()
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        self.0.names()
    }

    fn respond_point(
        &self,
        gap: [f64; 2],
        context: &PointContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<TractionPoint, UpdateFailure> {
        let step = self.0.step(gap, context.time_step, old, new)?;
        Ok(TractionPoint {
            traction: step.forces.map(|force| -force),
            tangent: step.tangent.map(|row| row.map(|entry| -entry)),
            branch: step.branch,
            stored: step.stored,
            dissipated: step.dissipated,
            supplied: 0.0,
        })
    }
}

/// The reason why there is no behaviour, for cards.
fn complaints(law: &ExternalJoint) -> Vec<(String, String)> {
    law.load().err().unwrap_or_default()
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "external",
        summary: "a cohesive zone model of a shared library, by MFront's generic interface",
        provides: &[Capability::RESPONSE],
        sources: &["Helfer et al. 2020, J. Open Source Softw. 5(48) (the generic interface)"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("external.md"),
        ..Card::of::<ExternalJoint>()
    }
}
