//! `voussoir run`.

use super::codes::{FINE, NO_ACCESS, NOT_PROVEN, WRONG_INPUT, say};
use super::files;
use super::progress::Progress;
use crate::kinds::{LoadedStudy, RunRequest};
use std::path::{Path, PathBuf};

/// Options of the command.
pub struct Options {
    /// Where results go.
    pub out: Option<PathBuf>,
    /// KEY=VALUE overrides.
    pub set: Vec<String>,
    /// Cases side by side.
    pub jobs: usize,
    /// Only this case.
    pub case: Option<usize>,
    /// Go on from finished cases.
    pub resume: bool,
    /// Print nothing but errors.
    pub quiet: bool,
}

/// Runs studies of any kind; the greatest exit code of them. Every study is checked before the first is run.
pub fn run(paths: &[PathBuf], options: &Options) -> u8 {
    let sets = match files::overrides(&options.set) {
        Ok(sets) => sets,
        Err(code) => return code,
    };
    let (mut studies, mut wrong) = (Vec::new(), FINE);
    for path in paths {
        match files::study(path, &sets) {
            Ok(study) => studies.push(study),
            Err(code) => wrong = wrong.max(code),
        }
    }
    if wrong != FINE {
        return wrong;
    }
    let mut code = FINE;
    for study in &studies {
        let dir = match &options.out {
            Some(dir) if studies.len() > 1 => dir.join(study.name()),
            Some(dir) => dir.clone(),
            None => Path::new("results").join(study.name()),
        };
        code = code.max(match run_one(study.as_ref(), &dir, options) {
            Ok(code) | Err(code) => code,
        });
    }
    code
}

/// Cases that are finished, a line of JSON each, while a run is under way.
const JOURNAL: &str = "unfinished.jsonl";

/// Results of an interrupted run of the same study.
fn stored(dir: &Path, resolved: &str) -> Option<[String; 2]> {
    let read = |name: &str| std::fs::read_to_string(dir.join(name)).unwrap_or_default();
    (read("resolved.toml") == resolved).then(|| [read("results.json"), read(JOURNAL)])
}

fn run_one(study: &dyn LoadedStudy, dir: &Path, options: &Options) -> Result<u8, u8> {
    let resolved = toml::to_string(study.resolved()).map_err(|error| {
        eprintln!("voussoir: the study \"{}\" cannot be written back: {error}", study.name());
        NO_ACCESS
    })?;
    let wanted: Vec<usize> = match options.case {
        Some(id) if id < study.count() => vec![id],
        Some(id) => {
            let last = study.count().saturating_sub(1);
            eprintln!("--case {id}: the study \"{}\" has cases 0 to {last}", study.name());
            return Err(WRONG_INPUT);
        }
        None => (0..study.count()).collect(),
    };
    let stored = options.resume.then(|| stored(dir, &resolved)).flatten();
    files::write(&dir.join("resolved.toml"), resolved.as_bytes())?;
    let journal = dir.join(JOURNAL);
    if !options.resume {
        let _ = std::fs::remove_file(&journal);
    }
    let progress = Progress::new(study.name(), options.quiet, &journal);
    let request = RunRequest { wanted, jobs: options.jobs, stored, version: env!("CARGO_PKG_VERSION").into() };
    let output = study.run(&request, &progress);
    progress.finish();
    for (name, bytes) in &output.files {
        files::write(&dir.join(name), bytes)?;
    }
    if !options.quiet {
        say(output.table);
        say(format!("results in {}", dir.display()));
    }
    let _ = std::fs::remove_file(&journal);
    Ok(if output.certified { FINE } else { NOT_PROVEN })
}
