//! Reading files and studies, and saying what is wrong with them.

use super::codes::{NO_ACCESS, WRONG_INPUT, complain};
use crate::config::diagnostic::LocatedDiagnostic;
use crate::config::limits::MAX_MISTAKES_PRINTED;
use crate::kinds::{LoadedStudy, read_source_beside};
use crate::serve::Session;
use crate::study::{StudySource, beside, read_bounded};
use std::path::Path;

/// Reads a file, or says why not.
pub fn read(path: &Path) -> Result<String, u8> {
    let bytes = read_bounded(path).map_err(|error| {
        complain(format_args!("voussoir: cannot read {}: {error}", path.display()));
        NO_ACCESS
    })?;
    // UTF-16 without a mark at its beginning is UTF-8 to the letter, with a zero beside each.
    if bytes.contains(&0) {
        complain(format_args!(
            "{}:1:1: this file holds zero bytes; save it as UTF-8, as TOML asks for (it may be in UTF-16)",
            path.display()
        ));
        return Err(WRONG_INPUT);
    }
    String::from_utf8(bytes).map_err(|error| {
        let (bytes, at) = (error.as_bytes(), error.utf8_error().valid_up_to());
        let (line, column) = (bytes[..at].iter().filter(|b| **b == b'\n').count() + 1, bytes[..at].iter().rev().take_while(|b| **b != b'\n').count() + 1);
        complain(format_args!(
            "{}:{line}:{column}: this byte is not UTF-8 (0x{:02x}); save the file as UTF-8, as TOML asks for (it may be in \
             Latin-1 or UTF-16)",
            path.display(),
            bytes[at]
        ));
        WRONG_INPUT
    })
}

/// Splits KEY=VALUE overrides.
pub fn overrides(sets: &[String]) -> Result<Vec<(String, String)>, u8> {
    sets.iter()
        .map(|set| match set.split_once('=') {
            Some((key, value)) => Ok((key.trim().to_string(), value.trim().to_string())),
            None => {
                complain(format_args!("--set {set}: expected KEY=VALUE, such as --set joints.dry.friction=0.5"));
                Err(WRONG_INPUT)
            }
        })
        .collect()
}

/// Reads a study of any kind, printing every mistake in it.
pub fn study(path: &Path, sets: &[(String, String)]) -> Result<Box<dyn LoadedStudy>, u8> {
    let text = read(path)?;
    let source = StudySource::parse_with(&text, &path.display().to_string(), sets, &beside(path));
    let study = source.and_then(|source| read_source_beside(source, &beside(path)));
    study.map_err(|diagnostics| report(path, diagnostics.mistakes()))
}

/// Reads a study to be looked at, printing every mistake in its first case.
pub fn session(path: &Path, sets: &[(String, String)]) -> Result<Session, u8> {
    let text = read(path)?;
    let source = StudySource::parse_with(&text, &path.display().to_string(), sets, &beside(path));
    source.and_then(Session::read).map_err(|diagnostics| report(path, diagnostics.mistakes()))
}

fn report(path: &Path, diagnostics: &[LocatedDiagnostic]) -> u8 {
    diagnostics.iter().take(MAX_MISTAKES_PRINTED).for_each(complain);
    let count = diagnostics.len();
    if count > MAX_MISTAKES_PRINTED {
        complain(format_args!("{}: {} more mistakes are not printed", path.display(), count - MAX_MISTAKES_PRINTED));
    }
    complain(format_args!(
        "{}: {count} mistake{}; nothing was computed",
        path.display(),
        if count == 1 { "" } else { "s" }
    ));
    WRONG_INPUT
}
