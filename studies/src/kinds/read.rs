//! Reading a study of any kind.

use super::kind::{LoadedStudy, kind, kinds};
use crate::config::diagnostic::{LocatedDiagnostic, suggest};
use crate::study::StudySource;

/// Reads a study of any kind; every mistake at once. Arguments as of [`crate::study::load`].
pub fn read_study(
    text: &str,
    file: &str,
    sets: &[(String, String)],
) -> Result<Box<dyn LoadedStudy>, Vec<LocatedDiagnostic>> {
    read_study_beside(text, file, sets, &|_| Err("no other file can be read here".into()))
}

/// The same where the study may name other files; `neighbour` as of [`super::StudyKind::read_beside`].
pub fn read_study_beside(
    text: &str,
    file: &str,
    sets: &[(String, String)],
    neighbour: &dyn Fn(&str) -> Result<(String, String), String>,
) -> Result<Box<dyn LoadedStudy>, Vec<LocatedDiagnostic>> {
    let source = StudySource::parse(text, file, sets)?;
    // A kind that does not exist is one mistake among others of a file with a scene.
    let kind = kind(source.kind()).or_else(|| kind("run"));
    match kind {
        Some(kind) => kind.read_beside(source, neighbour),
        None => {
            let names: Vec<_> = kinds().iter().map(|entry| entry.tag).collect();
            let help = suggest(source.kind(), &names, "kinds available");
            let message = format!("there is no study kind \"{}\"", source.kind());
            Err(vec![LocatedDiagnostic::new(&source.root.place("kind"), "kind", message).help(help)])
        }
    }
}
