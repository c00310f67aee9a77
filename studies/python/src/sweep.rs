//! Solves many cases in chunks and returns columns, for the workers of `voussoir.sweep`.

use crate::interrupted::{Told, interruptible};
use crate::source::{Source, study_error};
use pyo3::IntoPyObjectExt;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use voussoir::core::plugin::OutputOf;
use voussoir::results::{CaseResult, OutputColumn};
use voussoir::study::{Study, StudyFile};
use voussoir::writers::columns::{Cell, CellKind, Column, Labels};

/// A study whose cases are created one at a time and not kept.
#[pyclass(frozen)]
pub struct Sweep {
    study: Study,
}

#[pymethods]
impl Sweep {
    /// Reads a study. With `checked`, every case is created once, so that all mistakes are reported together. Otherwise
    /// only the first case is created; this is for workers whose study was already checked.
    #[new]
    #[pyo3(signature = (source, checked=true))]
    fn new(py: Python<'_>, source: Source, checked: bool) -> PyResult<Self> {
        let study = py.detach(|| {
            let file = StudyFile::read(source.read()?).map_err(|wrong| study_error(wrong.mistakes()))?;
            let study = if checked { file.study_in_turn() } else { file.study_unchecked() };
            study.map_err(|wrong| study_error(wrong.mistakes()))
        })?;
        if study.kind != "run" {
            let message =
                format!("a sweep answers studies of the kind \"run\", not \"{}\": use voussoir.run", study.kind);
            return Err(PyValueError::new_err(message));
        }
        Ok(Sweep { study })
    }

    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        &self.study.name
    }

    /// Number of cases.
    #[getter]
    fn count(&self) -> usize {
        self.study.count()
    }

    /// Swept keys, outermost first.
    #[getter]
    fn keys(&self) -> Vec<String> {
        self.study.keys()
    }

    /// Solves cases and returns a column for each quantity. Missing numbers are NaN, missing words are None.
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
        let count = self.study.count();
        if let Some(id) = ids.iter().find(|id| **id >= count) {
            return Err(PyValueError::new_err(format!("there is no case {id}: the study has {count}")));
        }
        let (swept, keys) = (self.study.keys(), self.study.swept_keys());
        let variants = !self.study.outline.variants.is_empty();
        let columns = Labels { swept: &swept, keys: &keys, variants, scenes: false, outputs: &[] }.with_results();
        let mut rows: Vec<Vec<Cell>> = vec![Vec::new(); columns.len()];
        let mut hashes = Vec::new();
        let mut outputs: Vec<(OutputColumn, Vec<f64>)> = Vec::new();
        interruptible(py, progress, |told: &Told| {
            self.study.solve(&ids, jobs, told, &mut |case| {
                rows.iter_mut().zip(&columns).for_each(|(cells, column)| cells.push(column.cell(&case)));
                add_outputs(&mut outputs, &case, hashes.len());
                hashes.push(case.label.case_hash);
            });
        })?;
        let dict = PyDict::new(py);
        for (column, cells) in columns.iter().zip(rows) {
            dict.set_item(name(column), values(py, column.kind, cells)?)?;
        }
        for (column, mut cells) in outputs {
            cells.resize(hashes.len(), f64::NAN);
            // With the tag, so that the name does not depend on the other cases of the chunk.
            dict.set_item(format!("{}.{}", column.plugin, column.name), cells)?;
        }
        dict.set_item("case_hash", hashes)?;
        Ok(dict)
    }
}

/// Adds the outputs of a case that `before` cases precede. Cases without a value have NaN.
fn add_outputs(outputs: &mut Vec<(OutputColumn, Vec<f64>)>, case: &CaseResult, before: usize) {
    for entry in case.outputs.iter().filter(|entry| entry.of == OutputOf::Case) {
        let column = OutputColumn::of(entry);
        let place = outputs.iter().position(|(own, _)| *own == column).unwrap_or_else(|| {
            outputs.push((column, Vec::new()));
            outputs.len() - 1
        });
        let cells = &mut outputs[place].1;
        cells.resize(before, f64::NAN);
        cells.push(entry.values.first().copied().flatten().unwrap_or(f64::NAN));
    }
}

/// The name of a column in Python: an identifier. If a result has the same attribute, the names are equal.
fn name(column: &Column) -> &str {
    match column.name.as_str() {
        "kind" => "mechanism",
        "certificate_passed" => "certified",
        name => name,
    }
}

/// The cells of a column. Missing numbers are NaN; missing words and booleans are None.
fn values(py: Python<'_>, kind: CellKind, cells: Vec<Cell>) -> PyResult<Bound<'_, PyAny>> {
    match kind {
        CellKind::Number => {
            let number = |cell| if let Cell::Number(Some(number)) = cell { number } else { f64::NAN };
            cells.into_iter().map(number).collect::<Vec<f64>>().into_bound_py_any(py)
        }
        CellKind::Whole => {
            let counts: Vec<Option<i64>> =
                cells.into_iter().map(|cell| if let Cell::Whole(count) = cell { count } else { None }).collect();
            match counts.iter().copied().collect::<Option<Vec<i64>>>() {
                Some(all) => all.into_bound_py_any(py),
                None => {
                    let number = |count: Option<i64>| count.map_or(f64::NAN, |count| count as f64);
                    counts.into_iter().map(number).collect::<Vec<f64>>().into_bound_py_any(py)
                }
            }
        }
        CellKind::Truth => {
            let truth = |cell| if let Cell::Truth(truth) = cell { truth } else { None };
            cells.into_iter().map(truth).collect::<Vec<Option<bool>>>().into_bound_py_any(py)
        }
        CellKind::Text => {
            let text = |cell| if let Cell::Text(text) = cell { text } else { None };
            cells.into_iter().map(text).collect::<Vec<Option<String>>>().into_bound_py_any(py)
        }
    }
}
