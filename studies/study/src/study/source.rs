//! The text of a study file, parsed, with the `--set KEY=VALUE` of the command line.

use super::error::StudyError;
use super::survey::{ReadFile, import, no_files};
use crate::config::diagnostic::LocatedDiagnostic;
use crate::config::document::{Node, Value, from_json, parse, parse_value};
use crate::config::documented_vehicles;
use crate::config::names::check_texts;
use crate::config::origin::Origin;
use crate::config::overlay::set;
use serde_json::Value as Json;

/// A study file as a tree of keys, and the mistakes so far.
#[derive(Debug, Clone)]
pub struct StudySource {
    /// The whole file.
    pub root: Node,
    /// Keys set on the command line, with their values.
    pub sets: Vec<(String, String)>,
    /// Mistakes so far.
    pub diagnostics: Vec<LocatedDiagnostic>,
}

impl StudySource {
    /// Reads a study file. `file` is its name in messages, `sets` the `--set KEY=VALUE` of the command line; a value that is not
    /// valid TOML is a text. The error contains syntax errors.
    pub fn parse(text: &str, file: &str, sets: &[(String, String)]) -> Result<Self, StudyError> {
        Self::parse_with(text, file, sets, &no_files)
    }

    /// Like [`StudySource::parse`]; `read` reads the files that the study names.
    pub fn parse_with(text: &str, file: &str, sets: &[(String, String)], read: ReadFile) -> Result<Self, StudyError> {
        let mut source = StudySource { root: parse(text, file)?, sets: sets.to_vec(), diagnostics: Vec::new() };
        for (path, value) in sets {
            let origin = Origin::Set(path.as_str().into());
            source.set(path, value_of(value, &origin), &origin);
        }
        source.complete(read)
    }

    /// Returns a study from a value that a program has made, with the tables and keys of a study file. Then `sets` are applied,
    /// keys and values in order. The error lists values that no study can contain.
    pub fn of_value(value: &Json, sets: &[(String, Json)]) -> Result<Self, StudyError> {
        let mut source = StudySource { root: from_json(value)?, sets: Vec::new(), diagnostics: Vec::new() };
        for (path, value) in sets {
            source.set(path, from_json(value)?, &Origin::Value);
        }
        source.complete(&no_files)
    }

    fn set(&mut self, path: &str, value: Node, origin: &Origin) {
        self.diagnostics.extend(set(&mut self.root, path, value, origin).err().map(|wrong| *wrong));
    }

    /// Adds documented vehicles and the points of files that the study names, and checks the name of the study. If a file cannot
    /// be read, the keys that it replaces would be missing too: only the mistake in the file is then reported.
    fn complete(mut self, read: ReadFile) -> Result<Self, StudyError> {
        documented_vehicles::add(&mut self.root);
        let before = self.diagnostics.len();
        import(&mut self.root, read, &mut self.diagnostics);
        if self.diagnostics.len() > before {
            return Err(self.diagnostics.into());
        }
        check_texts(&self.root, &mut self.diagnostics);
        if self.diagnostics.len() > before {
            return Err(self.diagnostics.into());
        }
        if let Some(node) = self.root.table().and_then(|table| table.get("name"))
            && let Some(wrong) = node.text().and_then(no_file_name)
        {
            self.diagnostics.push(LocatedDiagnostic::new(&node.origin, "name", wrong).help(FILE_NAME));
        }
        Ok(self)
    }

    /// Returns the tag of the study's kind.
    pub fn kind(&self) -> &str {
        kind_of(&self.root)
    }
}

/// Parses a value as TOML; other values are texts.
pub fn value_of(text: &str, origin: &Origin) -> Node {
    parse_value(text, origin)
        .or_else(|| parse_value(&format!("{text:?}"), origin))
        .unwrap_or_else(|| Node { value: Value::String(text.into()), origin: origin.clone() })
}

/// Returns the value of the key `kind`.
pub fn kind_of(root: &Node) -> &str {
    root.table().and_then(|table| table.get("kind")?.text()).unwrap_or("run")
}

/// Advice for a name that is not valid for a folder.
pub(crate) const FILE_NAME: &str = "results go into a folder of this name: use letters, digits, blanks, - and _";

/// Returns the reason why a study's name is not valid for a folder.
pub(crate) fn no_file_name(name: &str) -> Option<String> {
    let unfit = |c: char| c.is_control() || "/\\:*?\"<>|".contains(c);
    match name {
        "" => Some("is empty".into()),
        "." | ".." => Some(format!("\"{name}\" is no name of a folder")),
        _ if name.trim() != name => Some("begins or ends with a blank".into()),
        _ if name.starts_with('.') || name.ends_with('.') => Some("begins or ends with a point".into()),
        _ if name.len() > 200 => Some("is longer than 200 bytes".into()),
        _ => {
            name.chars().find(|c| unfit(*c)).map(|c| format!("holds {c:?}, which no folder's name can hold everywhere"))
        }
    }
}
