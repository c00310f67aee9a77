//! Where a key or value was written: a place in a file, the command line, or a value of a program.

use std::fmt;
use std::sync::Arc;

/// Where something was written.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Origin {
    /// In a file; line and column count from 1, columns in characters.
    File {
        /// Its name as it was given.
        file: Arc<str>,
        /// From 1.
        line: usize,
        /// From 1.
        column: usize,
    },
    /// On the command line, as `--set KEY=…`.
    Set(Arc<str>),
    /// In a value that a program has made; its key says where.
    Value,
}

impl fmt::Display for Origin {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Origin::File { file, line, column } => write!(out, "{file}:{line}:{column}"),
            Origin::Set(key) => write!(out, "--set {key}"),
            Origin::Value => write!(out, "study"),
        }
    }
}
