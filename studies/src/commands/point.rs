//! `voussoir point`.

use super::{FINE, NOT_PROVEN, files, say};
use std::path::{Path, PathBuf};
use voussoir::kinds::point::{PathStatus, PointStudy, answer, output};

/// Drives the points of studies; the greatest exit code of them. Every study is checked before the
/// first is driven.
pub fn point(paths: &[PathBuf], out: Option<&Path>, sets: &[String], quiet: bool) -> u8 {
    let sets = match files::overrides(sets) {
        Ok(sets) => sets,
        Err(code) => return code,
    };
    let (mut studies, mut wrong) = (Vec::new(), FINE);
    for path in paths {
        match files::point_study(path, &sets) {
            Ok(study) => studies.push(study),
            Err(code) => wrong = wrong.max(code),
        }
    }
    if wrong != FINE {
        return wrong;
    }
    let mut code = FINE;
    for study in &studies {
        let dir = match out {
            Some(dir) if studies.len() > 1 => dir.join(&study.name),
            Some(dir) => dir.to_path_buf(),
            None => Path::new("results").join(&study.name),
        };
        code = code.max(match drive(study, &dir, quiet) {
            Ok(code) | Err(code) => code,
        });
    }
    code
}

fn drive(study: &PointStudy, dir: &Path, quiet: bool) -> Result<u8, u8> {
    let results: Vec<_> = study.cases.iter().map(answer).collect();
    for (name, text) in output::files(study, &results, env!("CARGO_PKG_VERSION")) {
        files::write(&dir.join(name), &text)?;
    }
    if !quiet {
        say(output::table(study, &results));
        say(format!("results in {}", dir.display()));
    }
    let reached = results.iter().all(|result| result.status == PathStatus::Reached);
    Ok(if reached { FINE } else { NOT_PROVEN })
}
