//! `external` for joints: a cohesive zone model. Openings and tractions of the library are positive in tension.

use crate::behaviour::{Family, Request, Wrong};
use crate::runner::Runner;
use serde::{Deserialize, Serialize};
use std::collections::BTreeMap;
use std::sync::Arc;
use voussoir_core::law::{InterfaceLaw, InterfaceResponse, TractionPoint, UpdateFailure};
use voussoir_core::plugin::{Capability, Card, Need, Parameter, PluginKind, Quantity, Range, Shape, check_as};

/// A cohesive zone model from a shared library.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExternalJoint {
    /// Path of the library.
    pub library: String,
    /// Name of the behaviour.
    pub behaviour: String,
    /// Material properties by their names in the library.
    #[serde(default)]
    pub properties: BTreeMap<String, f64>,
    /// Temperature \[K\].
    #[serde(default = "room")]
    pub temperature: f64,
    /// External state variables by their names in the library, without the temperature.
    #[serde(default)]
    pub variables: BTreeMap<String, f64>,
    /// True if it runs in a separate process.
    #[serde(default)]
    pub isolate: bool,
}

pub(crate) fn room() -> f64 {
    293.15
}

pub(crate) const FAMILY: Family = Family {
    hypothesis: "PlaneStrain",
    kind: [3, 2],
    words: "cohesive zone model",
    names: ["OpeningDisplacement", "CohesiveForce"],
    sizes: [1, 4, 2, 5],
};

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
        Runner::load::<2>(&request, &FAMILY, self.isolate)
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

    fn respond_point(&self, gap: [f64; 2], old: &[f64], new: &mut [f64]) -> Result<TractionPoint, UpdateFailure> {
        let step = self.0.step(gap, 0.0, old, new)?;
        Ok(TractionPoint {
            traction: step.forces.map(|force| -force),
            tangent: step.tangent.map(|row| row.map(|entry| -entry)),
            branch: step.branch,
            stored: step.stored,
            dissipated: step.dissipated,
        })
    }
}

pub(crate) const LIBRARY: Parameter = Parameter {
    name: "library",
    doc: "path of the shared library; the command line must allow it: --allow-library PATH",
    shape: Shape::Text,
    need: Need::Required,
};
pub(crate) const BEHAVIOUR: Parameter = Parameter {
    name: "behaviour",
    doc: "name of the behaviour in the library",
    shape: Shape::Text,
    need: Need::Required,
};
pub(crate) const PROPERTIES: Parameter = Parameter {
    name: "properties",
    doc: "its material properties, by their names in the library and in SI units",
    shape: Shape::Map(&Shape::Number(Quantity::Ratio, Range::ANY)),
    need: Need::Default("{}"),
};
pub(crate) const TEMPERATURE: Parameter =
    Parameter::number("temperature", Quantity::Temperature, Range::POSITIVE, "temperature").default("293.15");
pub(crate) const VARIABLES: Parameter = Parameter {
    name: "variables",
    doc: "its external state variables without the temperature, by their names in the library",
    shape: Shape::Map(&Shape::Number(Quantity::Ratio, Range::ANY)),
    need: Need::Default("{}"),
};

pub(crate) const ISOLATE: Parameter = Parameter {
    name: "isolate",
    doc: "whether it runs in a process of its own, so that a crash of it ends one case only",
    shape: Shape::Boolean,
    need: Need::Default("false"),
};

/// The reason why there is no behaviour, for cards.
fn complaints(law: &ExternalJoint) -> Vec<(String, String)> {
    law.load().err().unwrap_or_default()
}

voussoir_core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "external",
        summary: "a cohesive zone model of a shared library, by MFront's generic interface",
        parameters: &[LIBRARY, BEHAVIOUR, PROPERTIES, TEMPERATURE, VARIABLES, ISOLATE],
        provides: &[Capability::RESPONSE],
        sources: &["Helfer et al. 2020, J. Open Source Softw. 5(48) (the generic interface)"],
        file: file!(),
        package: voussoir_core::package!(),
        page: include_str!("external.md"),
        check: |value| check_as::<ExternalJoint>(value, complaints),
        ..Card::BLANK
    }
}
