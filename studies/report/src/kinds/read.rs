//! Reads a study of any kind.

use voussoir_study::config::diagnostic::{LocatedDiagnostic, suggest};
use voussoir_study::kind::{LoadedStudy, kind, kinds};
use voussoir_study::study::{ReadFile, StudyError, StudySource, no_files};

/// Reads a study of any kind. The error contains all mistakes. Arguments as for [`voussoir_study::file::load`].
pub fn read_study(text: &str, file: &str, sets: &[(String, String)]) -> Result<Box<dyn LoadedStudy>, StudyError> {
    read_source(StudySource::parse(text, file, sets)?)
}

/// Reads a study of any kind from its source.
pub fn read_source(source: StudySource) -> Result<Box<dyn LoadedStudy>, StudyError> {
    read_source_beside(source, &no_files)
}

/// Reads a study of any kind that may name other files; `read` opens them.
pub fn read_source_beside(source: StudySource, read: ReadFile) -> Result<Box<dyn LoadedStudy>, StudyError> {
    // An unknown kind is reported together with the other mistakes of a file with a scene.
    let kind = kind(source.kind()).or_else(|| kind("run"));
    match kind {
        Some(kind) => kind.read_beside(source, read),
        None => {
            let names: Vec<_> = kinds().iter().map(|entry| entry.tag).collect();
            let help = suggest(source.kind(), &names, "kinds available");
            let message = format!("there is no study kind \"{}\"", source.kind());
            Err(vec![LocatedDiagnostic::new(&source.root.place("kind"), "kind", message).help(help)].into())
        }
    }
}
