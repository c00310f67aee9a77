//! The place of a key or value: in a file, on the command line, or in a value of a program.

use std::fmt;
use std::sync::Arc;

/// Place of a key or value.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub enum Origin {
    /// In a file; lines and columns count from 1, columns in characters.
    File {
        /// Name of the file, as it was given.
        file: Arc<str>,
        /// Line, from 1.
        line: usize,
        /// Column, from 1.
        column: usize,
    },
    /// On the command line, as `--set KEY=…`.
    Set(Arc<str>),
    /// In a value that a program has made; its key gives the position.
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
