//! A study that is passed from Python, and its mistakes as an exception.

use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList};
use std::path::Path;
use voussoir::config::LocatedDiagnostic;
use voussoir::config::Origin;
use voussoir::kinds::{LoadedStudy, read_source_beside};
use voussoir::study::{StudySource, beside, no_files};

pyo3::create_exception!(
    voussoir,
    StudyError,
    PyValueError,
    "Something is wrong with a study; `mistakes` lists everything, each with file, line, column, key, message and help."
);

/// The text of a study file, or a dictionary with the same keys as JSON; both with overrides of keys.
#[derive(Clone)]
pub enum Source {
    /// TOML.
    Toml {
        /// The text.
        text: String,
        /// Its name in messages.
        file: String,
        /// Overrides of keys, as on the command line.
        sets: Vec<(String, String)>,
    },
    /// A dictionary, as JSON.
    Json {
        /// The text.
        text: String,
        /// Overrides of keys, with values as JSON.
        sets: Vec<(String, String)>,
    },
}

/// From (form, text, file, [(key, value)]).
impl<'py> FromPyObject<'_, 'py> for Source {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        let (form, text, file, sets): (String, String, String, Vec<(String, String)>) = object.extract()?;
        Ok(if form == "json" { Source::Json { text, sets } } else { Source::Toml { text, file, sets } })
    }
}

impl Source {
    /// Reads the keys of the study.
    pub fn read(&self) -> PyResult<StudySource> {
        match self {
            Source::Toml { text, file, sets } => StudySource::parse_with(text, file, sets, &|name| self.beside(name))
                .map_err(|wrong| study_error(wrong.mistakes())),
            Source::Json { text, sets } => {
                let json = |text: &str| {
                    serde_json::from_str(text).map_err(|error| PyValueError::new_err(format!("not a study: {error}")))
                };
                let sets =
                    sets.iter().map(|(key, value)| Ok((key.clone(), json(value)?))).collect::<PyResult<Vec<_>>>()?;
                StudySource::of_value(&json(text)?, &sets).map_err(|wrong| study_error(wrong.mistakes()))
            }
        }
    }
}

impl Source {
    /// Loads the study, of any kind.
    pub fn load(&self) -> PyResult<Box<dyn LoadedStudy>> {
        read_source_beside(self.read()?, &|name| self.beside(name)).map_err(|wrong| study_error(wrong.mistakes()))
    }

    /// Reads the text of a file beside the study file.
    fn beside(&self, name: &str) -> Result<String, String> {
        match self {
            Source::Toml { file, .. } if Path::new(file).is_file() => beside(Path::new(file))(name),
            _ => no_files(name),
        }
    }
}

/// The exception with all mistakes, formatted as on the command line.
pub fn study_error(wrong: &[LocatedDiagnostic]) -> PyErr {
    let text = wrong.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n");
    Python::attach(|py| {
        let error = StudyError::new_err(text);
        let listed = wrong.iter().map(|mistake| entry(py, mistake)).collect::<PyResult<Vec<_>>>();
        let set = listed.and_then(|list| error.value(py).setattr("mistakes", PyList::new(py, list)?));
        set.err().unwrap_or(error)
    })
}

fn entry<'py>(py: Python<'py>, mistake: &LocatedDiagnostic) -> PyResult<Bound<'py, PyDict>> {
    let dict = PyDict::new(py);
    let (file, line, column) = match &mistake.origin {
        Origin::File { file, line, column } => (Some(file.to_string()), Some(*line), Some(*column)),
        _ => (None, None, None),
    };
    dict.set_item("file", file)?;
    dict.set_item("line", line)?;
    dict.set_item("column", column)?;
    dict.set_item("key", &mistake.key)?;
    dict.set_item("message", &mistake.message)?;
    dict.set_item("help", &mistake.help)?;
    dict.set_item("case", &mistake.case)?;
    Ok(dict)
}
