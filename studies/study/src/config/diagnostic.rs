//! Diagnostics: mistakes in an input, each with its key, its place and advice.

use crate::config::characters::quoted;
use crate::config::origin::Origin;
use crate::config::synonyms::{key_elsewhere, nearest_name};
use std::fmt;

/// One mistake in a study, with its place.
#[derive(Debug, Clone, PartialEq, Eq, Hash)]
pub struct LocatedDiagnostic {
    /// Place of the key or value.
    pub origin: Origin,
    /// The dotted key; empty for syntax errors, which have no key.
    pub key: String,
    /// Description of the mistake.
    pub message: String,
    /// Advice, if possible.
    pub help: Option<String>,
    /// The case with the mistake, if other cases do not have it.
    pub case: Option<String>,
}

impl LocatedDiagnostic {
    /// Creates a mistake at a place.
    pub fn new(origin: &Origin, key: impl Into<String>, message: impl Into<String>) -> Self {
        LocatedDiagnostic { origin: origin.clone(), key: key.into(), message: message.into(), help: None, case: None }
    }

    /// Adds advice.
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(help.into());
        self
    }
}

impl fmt::Display for LocatedDiagnostic {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "{}: ", quoted(&self.origin.to_string()))?;
        // `--set KEY` has already named its key.
        if !self.key.is_empty() && !matches!(&self.origin, Origin::Set(key) if **key == *self.key) {
            write!(out, "{}: ", quoted(&self.key))?;
        }
        out.write_str(&quoted(&self.message))?;
        if let Some(help) = &self.help {
            write!(out, "\n  help: {}", quoted(help))?;
        }
        if let Some(case) = &self.case {
            write!(out, "\n  first in the case {}", quoted(case))?;
        }
        Ok(())
    }
}

impl std::error::Error for LocatedDiagnostic {}

/// Sorts mistakes in the order of the file, with the command line last.
pub fn sort(mistakes: &mut [LocatedDiagnostic]) {
    mistakes.sort_by_key(|mistake| match &mistake.origin {
        Origin::File { line, column, .. } => (*line, *column),
        Origin::Set(_) => (usize::MAX, 0),
        Origin::Value => (0, 0),
    });
}

/// Joins words as `"a", "b" or "c"`.
pub fn any_of<'a>(words: impl IntoIterator<Item = &'a str>) -> String {
    let words: Vec<_> = words.into_iter().map(|word| format!("\"{word}\"")).collect();
    match words.split_last() {
        Some((last, rest)) if !rest.is_empty() => format!("{} or {last}", rest.join(", ")),
        _ => words.concat(),
    }
}

/// Returns advice for a wrong name: the nearest valid name by meaning or spelling, a key of another table, or the list of all
/// names.
pub fn suggest(wrong: &str, names: &[&str], what: &str) -> String {
    match (nearest_name(wrong, names.iter().copied()), key_elsewhere(wrong)) {
        (Some(name), _) => format!("did you mean \"{name}\"?"),
        (None, Some(key)) => format!("did you mean {key}?"),
        (None, None) if names.is_empty() => format!("there are no {what}"),
        (None, None) => format!("{what}: {}", names.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_mistake_reads_place_key_message_help() {
        let origin = Origin::File { file: "a.toml".into(), line: 3, column: 5 };
        let mistake = LocatedDiagnostic::new(&origin, "scene.span", "is missing").help("add it");
        assert_eq!(mistake.to_string(), "a.toml:3:5: scene.span: is missing\n  help: add it");
        let mistake = LocatedDiagnostic::new(&Origin::Set("scene.span".into()), "scene.span", "-1 m is out of range");
        assert_eq!(mistake.to_string(), "--set scene.span: -1 m is out of range");
    }

    #[test]
    fn words_are_listed_with_or() {
        assert_eq!(any_of(["a"]), "\"a\"");
        assert_eq!(any_of(["a", "b", "c"]), "\"a\", \"b\" or \"c\"");
    }
}
