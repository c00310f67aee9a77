//! Many cases as columns, a chunk at a time: what `voussoir.sweep` gives to its workers.

use crate::interrupted::{Told, interruptible};
use crate::source::{Source, study_error};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use serde_json::Value as Json;
use voussoir::kinds::CasesOf;
use voussoir::results::CaseResult;
use voussoir::study::StudyFile;

/// A study whose cases are made one at a time; nothing of them is kept.
#[pyclass(frozen)]
pub struct Sweep {
    sweep: voussoir::study::Sweep,
}

fn text(value: impl serde::Serialize) -> Option<String> {
    serde_json::to_value(value).ok().and_then(|value| value.as_str().map(str::to_string))
}

fn number(x: Option<f64>) -> f64 {
    x.unwrap_or(f64::NAN)
}

#[pymethods]
impl Sweep {
    /// Reads a study; with `checked` every case is made once, so that every mistake is told at once. Without it only
    /// the first is: for workers that are given what has been checked.
    #[new]
    #[pyo3(signature = (source, checked=true))]
    fn new(py: Python<'_>, source: Source, checked: bool) -> PyResult<Self> {
        let sweep = py.detach(|| {
            let file = StudyFile::read(source.read()?).map_err(|wrong| study_error(wrong.mistakes()))?;
            if checked { file.sweep() } else { file.sweep_unchecked() }.map_err(|wrong| study_error(wrong.mistakes()))
        })?;
        if sweep.kind != "run" {
            let message =
                format!("a sweep answers studies of the kind \"run\", not \"{}\": use voussoir.run", sweep.kind);
            return Err(PyValueError::new_err(message));
        }
        Ok(Sweep { sweep })
    }

    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        &self.sweep.name
    }

    /// Number of cases.
    #[getter]
    fn count(&self) -> usize {
        self.sweep.count()
    }

    /// Swept keys, outermost first.
    #[getter]
    fn keys(&self) -> Vec<String> {
        self.sweep.keys()
    }

    /// Solves cases and gives a column for each quantity; NaN where a case has no such number, None where no such word.
    #[pyo3(signature = (ids, jobs=1, progress=None))]
    fn solve<'py>(
        &self,
        py: Python<'py>,
        mut ids: Vec<usize>,
        jobs: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Bound<'py, PyDict>> {
        ids.sort_unstable();
        ids.dedup();
        let count = self.sweep.count();
        if let Some(id) = ids.iter().find(|id| **id >= count) {
            return Err(PyValueError::new_err(format!("there is no case {id}: the study has {count}")));
        }
        let keys = self.sweep.keys();
        let mut rows = Rows { parameters: vec![Vec::new(); keys.len()], ..Rows::default() };
        interruptible(py, progress, |told: &Told| {
            CasesOf::Streamed(&self.sweep).solve(&ids, jobs, told, &mut |case| rows.add(&keys, case));
        })?;
        rows.columns(py, &keys)
    }
}

/// Columns while they grow.
#[derive(Default)]
struct Rows {
    id: Vec<usize>,
    variant: Vec<Option<String>>,
    parameters: Vec<Vec<Json>>,
    status: Vec<Option<String>>,
    load_factor: Vec<f64>,
    lower: Vec<f64>,
    upper: Vec<f64>,
    first_limit_point: Vec<f64>,
    mechanism: Vec<Option<String>>,
    hinge_count: Vec<f64>,
    certified: Vec<bool>,
    solver: Vec<String>,
    seconds: Vec<f64>,
    case_hash: Vec<String>,
    notes: Vec<String>,
}

impl Rows {
    fn add(&mut self, keys: &[String], case: CaseResult) {
        for (column, key) in self.parameters.iter_mut().zip(keys) {
            column.push(case.label.parameters.get(key).cloned().unwrap_or_default());
        }
        let mechanism = case.mechanism.as_ref();
        self.id.push(case.label.id);
        self.variant.push(case.label.variant);
        self.status.push(text(case.status));
        self.load_factor.push(number(case.load_factor));
        self.lower.push(number(case.bounds.and_then(|bounds| bounds[0])));
        self.upper.push(number(case.bounds.and_then(|bounds| bounds[1])));
        self.first_limit_point.push(number(case.path.first_limit_point));
        self.mechanism.push(mechanism.and_then(|mechanism| text(mechanism.kind)));
        self.hinge_count.push(number(mechanism.map(|mechanism| mechanism.hinge_count as f64)));
        self.certified.push(case.certificate.passed);
        self.solver.push(case.solver);
        self.seconds.push(case.seconds);
        self.case_hash.push(case.label.case_hash);
        self.notes.push(case.notes.join(" | "));
    }

    fn columns<'py>(self, py: Python<'py>, keys: &[String]) -> PyResult<Bound<'py, PyDict>> {
        let dict = PyDict::new(py);
        dict.set_item("id", self.id)?;
        if self.variant.iter().any(Option::is_some) {
            dict.set_item("variant", self.variant)?;
        }
        for (key, column) in keys.iter().zip(self.parameters) {
            match column.iter().map(Json::as_f64).collect::<Option<Vec<f64>>>() {
                Some(numbers) => dict.set_item(key, numbers)?,
                None => {
                    let word = |value: Json| value.as_str().map_or_else(|| value.to_string(), str::to_string);
                    dict.set_item(key, column.into_iter().map(word).collect::<Vec<_>>())?;
                }
            }
        }
        dict.set_item("status", self.status)?;
        dict.set_item("load_factor", self.load_factor)?;
        dict.set_item("lower_bound", self.lower)?;
        dict.set_item("upper_bound", self.upper)?;
        dict.set_item("first_limit_point", self.first_limit_point)?;
        dict.set_item("mechanism", self.mechanism)?;
        dict.set_item("hinge_count", self.hinge_count)?;
        dict.set_item("certified", self.certified)?;
        dict.set_item("solver", self.solver)?;
        dict.set_item("seconds", self.seconds)?;
        dict.set_item("case_hash", self.case_hash)?;
        dict.set_item("notes", self.notes)?;
        Ok(dict)
    }
}
