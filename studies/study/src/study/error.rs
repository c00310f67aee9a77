//! The errors of reading a study.

use crate::config::diagnostic::LocatedDiagnostic;
use std::path::PathBuf;
use std::{fmt, io};

/// The reason why a study cannot be read.
#[derive(Debug)]
#[non_exhaustive]
pub enum StudyError {
    /// Its file cannot be read.
    File {
        /// The file.
        path: PathBuf,
        /// The message of the operating system.
        error: io::Error,
    },
    /// All mistakes in the study, each with its place and key.
    Mistakes(Vec<LocatedDiagnostic>),
}

impl StudyError {
    /// Returns all mistakes in the study; empty if its file could not be read.
    pub fn mistakes(&self) -> &[LocatedDiagnostic] {
        match self {
            StudyError::File { .. } => &[],
            StudyError::Mistakes(mistakes) => mistakes,
        }
    }
}

impl fmt::Display for StudyError {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            StudyError::File { path, error } => write!(out, "cannot read {}: {error}", path.display()),
            StudyError::Mistakes(mistakes) => {
                let lines: Vec<String> = mistakes.iter().map(LocatedDiagnostic::to_string).collect();
                out.write_str(&lines.join("\n"))
            }
        }
    }
}

impl std::error::Error for StudyError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            StudyError::File { error, .. } => Some(error),
            StudyError::Mistakes(mistakes) => mistakes.first().map(|mistake| mistake as _),
        }
    }
}

impl From<Vec<LocatedDiagnostic>> for StudyError {
    fn from(mistakes: Vec<LocatedDiagnostic>) -> Self {
        StudyError::Mistakes(mistakes)
    }
}
