//! The blocks of a stored case, for pictures.

use crate::source::{Source, study_error};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use voussoir::results::CaseLabel;
use voussoir::study::StudyFile;

/// Name, true for a support, vertices \[m\] and centroid \[m\].
type Block = (String, bool, Vec<(f64, f64)>, (f64, f64));

/// Returns the blocks of a case of a study. `case` is its entry in results.json, as text.
#[pyfunction]
pub fn blocks(py: Python<'_>, source: Source, case: &str) -> PyResult<Vec<Block>> {
    let label: CaseLabel =
        serde_json::from_str(case).map_err(|error| PyValueError::new_err(format!("not a case: {error}")))?;
    py.detach(|| {
        let read = StudyFile::read(source.read()?).and_then(StudyFile::study_unchecked);
        let study = read.map_err(|wrong| study_error(wrong.mistakes()))?;
        let missing = || PyValueError::new_err(format!("the study has no case {}", label.id));
        let assembly = &study.case_of(&label).ok_or_else(missing)?.assembly;
        let block = |(index, body): (usize, &voussoir::core::model::Body)| {
            let centroid = assembly.inertia(index).centroid;
            let vertices = body.vertices.iter().map(|vertex| (vertex.x, vertex.y)).collect();
            (body.name.clone(), body.fixed, vertices, (centroid.x, centroid.y))
        };
        Ok(assembly.bodies.iter().enumerate().map(block).collect())
    })
}
