//! Reading and writing files: written aside and renamed, so that a killed run leaves no half file.

use super::codes::{NO_ACCESS, WRONG_INPUT};
use crate::config::diagnostic::LocatedDiagnostic;
use crate::kinds::{LoadedStudy, read_study};
use std::path::Path;

/// Reads a file, or says why not.
pub fn read(path: &Path) -> Result<String, u8> {
    std::fs::read_to_string(path).map_err(|error| {
        eprintln!("voussoir: cannot read {}: {error}", path.display());
        NO_ACCESS
    })
}

/// Writes a file whole or not at all.
pub fn write(path: &Path, bytes: &[u8]) -> Result<(), u8> {
    let aside = path.with_extension(format!("{}.tmp", path.extension().unwrap_or_default().to_string_lossy()));
    let attempt = || -> std::io::Result<()> {
        if let Some(folder) = path.parent() {
            std::fs::create_dir_all(folder)?;
        }
        std::fs::write(&aside, bytes)?;
        std::fs::rename(&aside, path)
    };
    attempt().map_err(|error| {
        eprintln!("voussoir: cannot write {}: {error}", path.display());
        NO_ACCESS
    })
}

/// Splits KEY=VALUE overrides.
pub fn overrides(sets: &[String]) -> Result<Vec<(String, String)>, u8> {
    sets.iter()
        .map(|set| match set.split_once('=') {
            Some((key, value)) => Ok((key.trim().to_string(), value.trim().to_string())),
            None => {
                eprintln!("--set {set}: expected KEY=VALUE, such as --set joints.dry.friction=0.5");
                Err(WRONG_INPUT)
            }
        })
        .collect()
}

/// Reads a study of any kind, printing every mistake in it.
pub fn study(path: &Path, sets: &[(String, String)]) -> Result<Box<dyn LoadedStudy>, u8> {
    let text = read(path)?;
    read_study(&text, &path.display().to_string(), sets).map_err(|diagnostics| report(path, &diagnostics))
}

fn report(path: &Path, diagnostics: &[LocatedDiagnostic]) -> u8 {
    diagnostics.iter().for_each(|diagnostic| eprintln!("{diagnostic}"));
    let count = diagnostics.len();
    eprintln!("{}: {count} mistake{}; nothing was computed", path.display(), if count == 1 { "" } else { "s" });
    WRONG_INPUT
}
