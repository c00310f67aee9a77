//! Reads files and studies.

use super::error::CliError;
use crate::serve::Session;
use std::path::Path;
use voussoir_core::plugin::nearest;
use voussoir_report::kinds::read_source_beside;
use voussoir_study::kind::LoadedStudy;
use voussoir_study::study::{StudySource, beside, read_bounded};

/// Reads a text file.
pub fn read(path: &Path) -> Result<String, CliError> {
    let bytes = read_bounded(path).map_err(|error| unreadable(path, &error))?;
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

/// The error for a study file that cannot be read, with the most similar name in its folder.
fn unreadable(path: &Path, error: &std::io::Error) -> CliError {
    let help = match error.kind() {
        _ if path.is_dir() => "; it is a folder: give the name of a study file".to_string(),
        std::io::ErrorKind::NotFound => did_you_mean(path, &|own| own.is_file()),
        _ => String::new(),
    };
    CliError::no_access(format_args!("voussoir: cannot read {}: {error}{help}", path.display()))
}

/// Suggests the most similar name in the folder of a path; `wanted` selects the entries.
pub fn did_you_mean(path: &Path, wanted: &dyn Fn(&Path) -> bool) -> String {
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path());
    let names: Vec<String> =
        entries.filter(|own| wanted(own)).filter_map(|own| Some(own.file_name()?.to_str()?.to_string())).collect();
    let wrong = path.file_name().unwrap_or_default().to_string_lossy();
    let near = nearest(&wrong, names.iter().map(String::as_str));
    near.map_or(String::new(), |name| format!("; did you mean {}?", path.with_file_name(name).display()))
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
