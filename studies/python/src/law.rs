//! Joint laws written in Python: `law = "python_facets"` and `law = "python_response"`.
//!
//! The table names a class that `voussoir.law` has registered, and its parameters. Both forms are meant for
//! experiments. The facets are requested once for each case, so they cost nothing more; `respond` is called for every
//! group of points.

use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value as Json};
use std::sync::{Arc, LazyLock, Mutex};
use voussoir::core::law::{
    BatchFailure, Effect, Facet, FacetMode, FacetResponse, InterfaceLaw, InterfaceResponse, PointContext,
    TractionPoint, UpdateBranch, UpdateFailure,
};
use voussoir::core::plugin::{Capability, Card, Need, Parameter, PluginKind, Shape};

/// The keys of both tables.
const PARAMETERS: &[Parameter] = &[
    Parameter {
        name: "class",
        doc: "name under which the class is registered: @voussoir.law(\"NAME\")",
        shape: Shape::Text,
        need: Need::Required,
    },
    Parameter { name: "parameters", doc: "what the class is made with", shape: Shape::Free, need: Need::Default("{}") },
];

voussoir::core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "python_facets",
        summary: "facets from a Python class: usable by every solver",
        parameters: PARAMETERS,
        provides: &[Capability::FACETS, Capability::RESPONSE],
        file: file!(),
        package: voussoir::core::package!(),
        page: "# `python_facets`\n\nThe class has `facets()`, a list of `voussoir.Facet`, and may have `stiffness`, two numbers in Pa/m.\n",
        check: |table| checked(table, "facets"),
        ..Card::BLANK
    }
}

voussoir::core::inventory::submit! {
    Card {
        kind: PluginKind::InterfaceLaw,
        tag: "python_response",
        summary: "tractions from gaps from a Python class, in groups of points: slow, for trying a law out",
        parameters: PARAMETERS,
        provides: &[Capability::RESPONSE],
        file: file!(),
        package: voussoir::core::package!(),
        page: "# `python_response`\n\nThe class has `stiffness`, two numbers in Pa/m, `state_names`, and `respond(gap, state)` or `respond(gap, state, context)`. The context has the previous gap, the position, the length and the width of each point, the duration of the step, and the fields that the attribute `fields` names.\n",
        check: |table| checked(table, "response"),
        ..Card::BLANK
    }
}

/// Creates an object of the class with these parameters.
fn made<'py>(py: Python<'py>, class: &str, parameters: &Map<String, Json>) -> PyResult<Bound<'py, PyAny>> {
    let text = serde_json::to_string(parameters).unwrap_or_default();
    py.import("voussoir._laws")?.call_method1("make", (class, text))
}

/// Returns the mistakes in a table, as reported by Python.
fn checked(table: &Json, form: &str) -> Vec<(String, String)> {
    let class = table["class"].as_str().unwrap_or_default();
    let empty = Map::new();
    let parameters = table["parameters"].as_object().unwrap_or(&empty);
    Python::attach(|py| {
        let complaint = py
            .import("voussoir._laws")
            .and_then(|laws| {
                laws.call_method1("check", (class, serde_json::to_string(parameters).unwrap_or_default(), form))
            })
            .and_then(|found| found.extract::<Option<(String, String)>>());
        match complaint {
            Ok(found) => found.into_iter().collect(),
            Err(error) => vec![("class".into(), error.to_string())],
        }
    })
}

/// Returns a text that lives as long as the program. Each text is stored once.
pub(crate) fn kept(text: String) -> &'static str {
    static TEXTS: LazyLock<Mutex<Vec<&'static str>>> = LazyLock::new(Mutex::default);
    let Ok(mut texts) = TEXTS.lock() else { return "a law written in Python" };
    match texts.iter().find(|own| **own == text) {
        Some(own) => own,
        None => {
            let own: &'static str = Box::leak(text.into_boxed_str());
            texts.push(own);
            own
        }
    }
}

/// A law whose facets are defined in Python.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PythonFacets {
    class: String,
    #[serde(default)]
    parameters: Map<String, Json>,
}

#[typetag::serde(name = "python_facets")]
impl InterfaceLaw for PythonFacets {
    fn facets(&self) -> Option<Vec<Facet>> {
        let read = |py: Python<'_>| -> PyResult<Vec<Facet>> {
            let law = made(py, &self.class, &self.parameters)?;
            let rows: Vec<(String, [f64; 2], f64, [f64; 2])> =
                py.import("voussoir._laws")?.call_method1("facets", (law,))?.extract()?;
            Ok(rows
                .into_iter()
                .map(|(mode, normal, bound, flow)| Facet { mode: mode_of(&mode), normal, bound, flow })
                .collect())
        };
        Python::attach(read).ok()
    }

    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        Some(Arc::new(FacetResponse::new(self.facets()?, self.stiffness()?)?))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        stiffness(&self.class, &self.parameters)
    }
}

fn mode_of(word: &str) -> FacetMode {
    match word {
        "opening" => FacetMode::Opening,
        "crushing" => FacetMode::Crushing,
        _ => FacetMode::Sliding,
    }
}

fn stiffness(class: &str, parameters: &Map<String, Json>) -> Option<[f64; 2]> {
    Python::attach(|py| {
        let law = made(py, class, parameters).ok()?;
        py.import("voussoir._laws").ok()?.call_method1("stiffness", (law,)).ok()?.extract().ok()?
    })
}

/// A law of tractions from gaps that is defined in Python.
#[derive(Debug, Clone, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PythonResponse {
    class: String,
    #[serde(default)]
    parameters: Map<String, Json>,
}

#[typetag::serde(name = "python_response")]
impl InterfaceLaw for PythonResponse {
    fn response(&self) -> Option<Arc<dyn InterfaceResponse>> {
        let read = |py: Python<'_>| -> PyResult<Response> {
            let law = made(py, &self.class, &self.parameters)?;
            let laws = py.import("voussoir._laws")?;
            let names: Vec<String> = laws.call_method1("state_names", (&law,))?.extract()?;
            let initial: Vec<f64> = laws.call_method1("initial_state", (&law,))?.extract()?;
            let names: Vec<&'static str> = names.into_iter().map(kept).collect();
            let fields = laws.call_method1("fields_read", (&law,))?.extract()?;
            Ok(Response { law: law.unbind(), initial, names: Vec::leak(names), fields })
        };
        Some(Arc::new(Python::attach(read).ok()?))
    }

    fn stiffness(&self) -> Option<[f64; 2]> {
        stiffness(&self.class, &self.parameters)
    }
}

/// The Python object of the law.
#[derive(Debug)]
struct Response {
    law: Py<PyAny>,
    initial: Vec<f64>,
    names: &'static [&'static str],
    /// Names of the fields that the law reads; `None` if it does not read the context.
    fields: Option<Vec<String>>,
}

/// The law dissipates energy.
const DISSIPATING: UpdateBranch = UpdateBranch::new("dissipating", Effect::Softening);

/// Returns the branch of a step: open without traction, dissipating, or elastic.
fn branch_of(gap: [f64; 2], traction: [f64; 2], dissipated: f64) -> UpdateBranch {
    match dissipated > 0.0 {
        true => DISSIPATING,
        false if gap[0] > 0.0 && traction == [0.0; 2] => UpdateBranch::OPEN,
        false => UpdateBranch::ELASTIC,
    }
}

pub(crate) fn bytes_of(numbers: &[f64]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_ne_bytes()).collect()
}

pub(crate) fn numbers_of(bytes: &[u8]) -> Vec<f64> {
    bytes.chunks_exact(8).filter_map(|eight| Some(f64::from_ne_bytes(eight.try_into().ok()?))).collect()
}

/// The contexts of a group of points: previous gap, position, length and width of each, then the time step of each, and the
/// fields at the start and end of the step, name by name. NaN is a field that no stage has set.
fn context_of<'py>(py: Python<'py>, contexts: &[PointContext], names: &[String]) -> [Bound<'py, PyBytes>; 2] {
    let places = contexts.iter().flat_map(|own| {
        let ([n, t], [x, y]) = (own.previous_gap, own.position);
        [n, t, x, y, own.length, own.width, own.time_step]
    });
    let value = |own: Option<f64>| own.unwrap_or(f64::NAN);
    let fields = contexts.iter().flat_map(|own| {
        names.iter().flat_map(move |name| [value(own.previous_fields.get(name)), value(own.fields.get(name))])
    });
    [places.collect::<Vec<_>>(), fields.collect()].map(|numbers| PyBytes::new(py, &bytes_of(&numbers)))
}

impl Response {
    /// Calls the law: tractions, tangents, states, stored and dissipated energies of a group, point by point, and the
    /// energies that fields supply.
    fn ask(&self, gaps: &[[f64; 2]], contexts: &[PointContext], old: &[f64]) -> PyResult<[Vec<f64>; 6]> {
        Python::attach(|py| {
            let gap = PyBytes::new(py, &bytes_of(gaps.as_flattened()));
            let state = PyBytes::new(py, &bytes_of(old));
            let context = self.fields.as_ref().map(|names| context_of(py, contexts, names));
            let arguments = (&self.law, gap, state, gaps.len(), context);
            let answer = py.import("voussoir._laws")?.call_method1("respond", arguments)?;
            let parts: [Bound<'_, PyBytes>; 6] = answer.extract()?;
            Ok(parts.map(|part| numbers_of(part.as_bytes())))
        })
    }
}

impl InterfaceResponse for Response {
    fn state_size(&self) -> usize {
        self.names.len()
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.copy_from_slice(&self.initial);
    }

    fn state_names(&self) -> &'static [&'static str] {
        self.names
    }

    fn respond_point(
        &self,
        gap: [f64; 2],
        context: &PointContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<TractionPoint, UpdateFailure> {
        let mut point = [TractionPoint::ZERO];
        self.respond(&[gap], &[*context], old, new, &mut point).map_err(|failed| failed.failure)?;
        Ok(point[0])
    }

    fn respond(
        &self,
        gaps: &[[f64; 2]],
        contexts: &[PointContext],
        old: &[f64],
        new: &mut [f64],
        points: &mut [TractionPoint],
    ) -> Result<(), BatchFailure> {
        let failed = |failure: UpdateFailure| BatchFailure { point: 0, failure };
        let count = gaps.len();
        if points.len() != count
            || contexts.len() != count
            || old.len() != count * self.state_size()
            || new.len() != old.len()
        {
            return Err(failed(UpdateFailure::WrongSize));
        }
        if !gaps.as_flattened().iter().chain(old).all(|x| x.is_finite()) {
            return Err(failed(UpdateFailure::NotFinite));
        }
        let said = |error: PyErr| failed(UpdateFailure::Law(kept(error.to_string())));
        let [traction, tangent, state, stored, dissipated, supplied] = self.ask(gaps, contexts, old).map_err(said)?;
        let right = [traction.len() == 2 * count, tangent.len() == 4 * count, state.len() == new.len()];
        let energies = [&stored, &dissipated, &supplied];
        if !right.iter().all(|right| *right) || energies.iter().any(|energy| energy.len() != count) {
            return Err(failed(UpdateFailure::WrongSize));
        }
        let answers = traction.iter().chain(&tangent).chain(&state);
        if !answers.chain(energies.into_iter().flatten()).all(|x| x.is_finite()) {
            return Err(failed(UpdateFailure::NotFinite));
        }
        new.copy_from_slice(&state);
        for (index, point) in points.iter_mut().enumerate() {
            let (t, k) = (&traction[2 * index..], &tangent[4 * index..]);
            *point = TractionPoint {
                traction: [t[0], t[1]],
                tangent: [[k[0], k[1]], [k[2], k[3]]],
                branch: branch_of(gaps[index], [t[0], t[1]], dissipated[index]),
                stored: stored[index],
                dissipated: dissipated[index],
                supplied: supplied[index],
            };
        }
        Ok(())
    }
}
