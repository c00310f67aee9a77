//! Reading a study of any kind.

use super::kind::{LoadedStudy, kind, kinds};
use crate::config::diagnostic::{LocatedDiagnostic, suggest};
use crate::study::{ReadFile, StudySource, no_files};

/// Reads a study of any kind; every mistake at once. Arguments as of [`crate::study::load`].
pub fn read_study(
    text: &str,
    file: &str,
    sets: &[(String, String)],
) -> Result<Box<dyn LoadedStudy>, Vec<LocatedDiagnostic>> {
    read_study_with(text, file, sets, &no_files)
}

/// As [`read_study`]; the files that the study names are read by `read`.
pub fn read_study_with(
    text: &str,
    file: &str,
    sets: &[(String, String)],
    read: ReadFile,
) -> Result<Box<dyn LoadedStudy>, Vec<LocatedDiagnostic>> {
    let source = StudySource::parse_with(text, file, sets, read)?;
    // A kind that does not exist is one mistake among others of a file with a scene.
    let kind = kind(source.kind()).or_else(|| kind("run"));
    match kind {
        Some(kind) => kind.read(source),
        None => {
            let names: Vec<_> = kinds().iter().map(|entry| entry.tag).collect();
            let help = suggest(source.kind(), &names, "kinds available");
            let message = format!("there is no study kind \"{}\"", source.kind());
            Err(vec![LocatedDiagnostic::new(&source.root.place("kind"), "kind", message).help(help)])
        }
    }
}
