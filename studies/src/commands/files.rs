//! Reads files and studies.

use super::error::CliError;
use crate::kinds::{LoadedStudy, read_source_beside};
use crate::serve::Session;
use crate::study::{StudySource, beside, read_bounded};
use std::path::Path;

/// Reads a text file.
pub fn read(path: &Path) -> Result<String, CliError> {
    let bytes = read_bounded(path)
        .map_err(|error| CliError::no_access(format_args!("voussoir: cannot read {}: {error}", path.display())))?;
    // UTF-16 without a byte order mark: ASCII letters in it are the same bytes as in UTF-8, each with a zero byte
    // beside it.
    if bytes.contains(&0) {
        return Err(CliError::wrong_input(format_args!(
            "{}:1:1: this file holds zero bytes; save it as UTF-8, as TOML asks for (it may be in UTF-16)",
            path.display()
        )));
    }
    String::from_utf8(bytes).map_err(|error| {
        let (bytes, at) = (error.as_bytes(), error.utf8_error().valid_up_to());
        let (line, column) = (bytes[..at].iter().filter(|b| **b == b'\n').count() + 1, bytes[..at].iter().rev().take_while(|b| **b != b'\n').count() + 1);
        CliError::wrong_input(format_args!(
            "{}:{line}:{column}: this byte is not UTF-8 (0x{:02x}); save the file as UTF-8, as TOML asks for (it may be in \
             Latin-1 or UTF-16)",
            path.display(),
            bytes[at]
        ))
    })
}

/// Splits KEY=VALUE overrides.
pub fn overrides(sets: &[String]) -> Result<Vec<(String, String)>, CliError> {
    sets.iter()
        .map(|set| match set.split_once('=') {
            Some((key, value)) => Ok((key.trim().to_string(), value.trim().to_string())),
            None => Err(CliError::wrong_input(format_args!(
                "--set {set}: expected KEY=VALUE, such as --set joints.dry.friction=0.5"
            ))),
        })
        .collect()
}

/// Reads a study of any kind.
///
/// # Errors
/// All mistakes in the study.
pub fn study(path: &Path, sets: &[(String, String)]) -> Result<Box<dyn LoadedStudy>, CliError> {
    let text = read(path)?;
    let source = StudySource::parse_with(&text, &path.display().to_string(), sets, &beside(path));
    let study = source.and_then(|source| read_source_beside(source, &beside(path)));
    study.map_err(|mistakes| CliError::of_study(path, &text, &mistakes))
}

/// Reads a study for interactive use.
///
/// # Errors
/// All mistakes in its first case.
pub fn session(path: &Path, sets: &[(String, String)]) -> Result<Session, CliError> {
    let text = read(path)?;
    let source = StudySource::parse_with(&text, &path.display().to_string(), sets, &beside(path));
    source.and_then(Session::read).map_err(|mistakes| CliError::of_study(path, &text, &mistakes))
}
