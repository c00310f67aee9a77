//! The native part of the Python package `voussoir`. It accepts studies and returns texts and columns. The public
//! interface is written in Python, in `python/voussoir/`.

mod blocks;
mod conform;
mod interrupted;
mod law;
mod solver;
mod source;
mod sweep;

use interrupted::{Told, interruptible};
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyDict};
use source::Source;
use std::path::{Path, PathBuf};
use voussoir::kinds::{LoadedStudy, RunOutput, RunRequest, StoredResults, Verification};

/// Version of the program, for results.
const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Returns number of cases, name, notes and the resolved study. The study must be free of mistakes.
#[pyfunction]
fn check<'py>(py: Python<'py>, source: Source) -> PyResult<Bound<'py, PyDict>> {
    let study = py.detach(|| source.load())?;
    let dict = PyDict::new(py);
    dict.set_item("name", study.name())?;
    dict.set_item("count", study.count())?;
    dict.set_item("notes", study.notes())?;
    dict.set_item("plan", study.explain())?;
    Ok(dict)
}

/// Runs a study and returns the files that the command line would write, as bytes by name.
#[pyfunction]
#[pyo3(signature = (source, cases=None, jobs=1, progress=None))]
fn run<'py>(
    py: Python<'py>,
    source: Source,
    cases: Option<Vec<usize>>,
    jobs: usize,
    progress: Option<Py<PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let study = py.detach(|| source.load())?;
    let count = study.count();
    if let Some(id) = cases.iter().flatten().find(|id| **id >= count) {
        return Err(PyValueError::new_err(format!(
            "there is no case {id}: the study \"{}\" has {count}",
            study.name()
        )));
    }
    let mut wanted = cases.unwrap_or_else(|| (0..count).collect());
    wanted.sort_unstable();
    wanted.dedup();
    let resolved = toml_text(study.as_ref())?;
    let work = |told: &Told| run_with_parts(study.as_ref(), wanted, jobs, told);
    let RunOutput { files, table, remarks, certified } = interruptible(py, progress, work)?;
    let dict = PyDict::new(py);
    let bytes = PyDict::new(py);
    for (name, content) in &files {
        bytes.set_item(name, PyBytes::new(py, content))?;
    }
    bytes.set_item("resolved.toml", PyBytes::new(py, resolved.as_bytes()))?;
    dict.set_item("files", bytes)?;
    dict.set_item("name", study.name())?;
    dict.set_item("table", table)?;
    dict.set_item("remarks", remarks)?;
    dict.set_item("certified", certified)?;
    Ok(dict)
}

/// Runs a study after the studies that it reports on. Their files are in separate folders.
fn run_with_parts(study: &dyn LoadedStudy, wanted: Vec<usize>, jobs: usize, told: &Told) -> RunOutput {
    let (mut files, mut parts, mut certified) = (Vec::new(), Vec::new(), true);
    for part in study.parts() {
        let all = (0..part.study.count()).collect();
        let mut output = run_with_parts(part.study.as_ref(), all, jobs, told);
        let resolved = part.study.resolved_text().unwrap_or_default();
        output.files.push(("resolved.toml".into(), resolved.into_bytes()));
        let results = output.files.iter().find(|(name, _)| name == "results.json");
        parts.push(results.map(|(_, bytes)| String::from_utf8_lossy(bytes).into_owned()).unwrap_or_default());
        files.extend(output.files.into_iter().map(|(name, bytes)| (format!("{}/{name}", part.folder), bytes)));
        certified &= output.certified;
    }
    let request = RunRequest { wanted, jobs, version: VERSION.into(), parts, ..RunRequest::default() };
    let mut output = study.run(&request, told);
    output.files.extend(files);
    output.certified &= certified;
    output
}

fn toml_text(study: &dyn LoadedStudy) -> PyResult<String> {
    study.resolved_text().map_err(|error| PyValueError::new_err(format!("the study cannot be written back: {error}")))
}

/// Checks a result folder. Returns the findings line by line, the number of cases and the number of stalled cases.
#[pyfunction]
#[pyo3(signature = (dir, jobs=1))]
fn verify<'py>(py: Python<'py>, dir: PathBuf, jobs: usize) -> PyResult<Bound<'py, PyDict>> {
    let (mut findings, mut cases, mut stalled) = (Vec::new(), 0, 0);
    let mut folders = vec![dir];
    while let Some(dir) = folders.pop() {
        let found = verify_one(py, &dir, jobs, &mut folders)?;
        findings.extend(found.findings.iter().map(|(id, why)| format!("case {id}: {why}")));
        findings.extend(found.files);
        cases += found.cases;
        stalled += found.stalled;
    }
    let dict = PyDict::new(py);
    dict.set_item("findings", findings)?;
    dict.set_item("cases", cases)?;
    dict.set_item("stalled", stalled)?;
    Ok(dict)
}

/// Checks one folder. The folders of studies that it reports on are added to `later`.
fn verify_one(py: Python<'_>, dir: &Path, jobs: usize, later: &mut Vec<PathBuf>) -> PyResult<Verification> {
    let unreadable = |name: &'static str| {
        move |error: std::io::Error| PyOSError::new_err(format!("cannot read {}: {error}", dir.join(name).display()))
    };
    std::fs::File::open(dir.join("results.json")).map_err(unreadable("results.json"))?;
    let resolved = std::fs::read_to_string(dir.join("resolved.toml")).map_err(unreadable("resolved.toml"))?;
    let file = dir.join("resolved.toml").display().to_string();
    let study = Source::Toml { text: resolved, file, sets: Vec::new() }.load()?;
    later.extend(study.parts().iter().map(|part| dir.join(&part.folder)));
    let stored =
        |name: &str| std::fs::File::open(dir.join(name)).ok().map(|file| Box::new(file) as Box<dyn std::io::Read>);
    let found = interruptible(py, None, |told| study.verify_stored(&StoredResults { jobs, file: &stored }, told))?;
    found.map_err(|error| PyValueError::new_err(format!("{}: not a results file: {error}", dir.display())))
}

/// Returns the JSON Schema of study files.
#[pyfunction]
fn schema() -> String {
    voussoir::kinds::json_schema().to_string()
}

/// Returns (kind, tag, summary) of every plug-in.
#[pyfunction]
fn plugins() -> Vec<(&'static str, &'static str, &'static str)> {
    let cards = voussoir::core::plugin::cards();
    cards.iter().map(|card| (card.kind.plural(), card.tag, card.summary)).collect()
}

/// Runs the command line and returns its exit code.
#[pyfunction]
fn main(py: Python<'_>, arguments: Vec<String>) -> i32 {
    use std::io::Write;
    let answer = py.detach(|| voussoir::cli::main_from(arguments.into_iter().map(Into::into)));
    let code = answer.map(i32::from).unwrap_or_else(|said| {
        drop(said.print());
        said.exit_code()
    });
    drop(std::io::stdout().flush());
    code
}

/// The native module.
#[pymodule]
mod _voussoir {
    #[pymodule_export]
    use super::blocks::blocks;
    #[pymodule_export]
    use super::conform::{conform_law, conform_tag};
    #[pymodule_export]
    use super::source::StudyError;
    #[pymodule_export]
    use super::sweep::Sweep;
    #[pymodule_export]
    use super::{check, main, plugins, run, schema, verify};
    use pyo3::prelude::*;

    /// Adds the version to the module.
    #[pymodule_init]
    fn init(module: &Bound<'_, PyModule>) -> PyResult<()> {
        module.add("__version__", super::VERSION)
    }
}
