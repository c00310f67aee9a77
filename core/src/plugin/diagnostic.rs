//! Mistakes in an input, each at a key path. The reader of the file converts the path into file, line and column.

use std::fmt;

/// One mistake in a study.
#[derive(Debug, Clone, PartialEq, Eq)]
#[non_exhaustive]
pub struct Diagnostic {
    /// Dotted path from the study's root, list entries by index: `stages.1.loads.0.force`.
    pub path: String,
    /// Description of the mistake.
    pub message: String,
    /// Advice, if possible.
    pub help: Option<String>,
}

impl Diagnostic {
    /// Creates a mistake at `path`.
    pub fn new(path: impl Into<String>, message: impl Into<String>) -> Self {
        Diagnostic { path: path.into(), message: message.into(), help: None }
    }

    /// Adds a table in front of the path.
    pub fn below(mut self, table: &str) -> Self {
        self.path = format!("{table}.{}", self.path);
        self
    }

    /// Adds advice.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

impl fmt::Display for Diagnostic {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}: {}", self.path, self.message)?;
        self.help.iter().try_for_each(|help| write!(out, "\n  help: {help}"))
    }
}

impl std::error::Error for Diagnostic {}
