//! The text of a study file, read and with the `--set KEY=VALUE` of the command line in it.

use super::error::StudyError;
use super::survey::{ReadFile, import, no_files};
use crate::config::diagnostic::LocatedDiagnostic;
use crate::config::document::{Node, Value, from_json, parse, parse_value};
use crate::config::documented_vehicles;
use crate::config::names::check_texts;
use crate::config::origin::Origin;
use crate::config::overlay::set;
use serde_json::Value as Json;

/// A study file as a tree of keys, and what was found wrong with it so far.
#[derive(Debug, Clone)]
pub struct StudySource {
    /// The whole file.
    pub root: Node,
    /// Keys set on the command line, with their values.
    pub sets: Vec<(String, String)>,
    /// Found wrong so far.
    pub diagnostics: Vec<LocatedDiagnostic>,
}

impl StudySource {
    /// Reads a study file. `file` is its name in messages, `sets` the `--set KEY=VALUE` of the command line;
    /// a value that is no TOML is taken as text. Errors are those of syntax.
    pub fn parse(text: &str, file: &str, sets: &[(String, String)]) -> Result<Self, StudyError> {
        Self::parse_with(text, file, sets, &no_files)
    }

    /// As [`StudySource::parse`]; the files that the study names are read by `read`.
    pub fn parse_with(text: &str, file: &str, sets: &[(String, String)], read: ReadFile) -> Result<Self, StudyError> {
        let mut source = StudySource { root: parse(text, file)?, sets: sets.to_vec(), diagnostics: Vec::new() };
        for (path, value) in sets {
            let origin = Origin::Set(path.as_str().into());
            source.set(path, value_of(value, &origin), &origin);
        }
        source.complete(read)
    }

    /// A study from a value that a program has made, with the tables and keys of a study file; then `sets`, keys
    /// and values in order. Errors are values that no study can hold.
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

    /// The same with what it names besides: documented vehicles, and points of files; and with what is wrong with its name.
    /// What a file lacks would be missing in the study too: then that is all that is said.
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

    /// The tag of the study's kind.
    pub fn kind(&self) -> &str {
        kind_of(&self.root)
    }
}

/// A value as TOML, or else as text.
pub(crate) fn value_of(text: &str, origin: &Origin) -> Node {
    parse_value(text, origin)
        .or_else(|| parse_value(&format!("{text:?}"), origin))
        .unwrap_or_else(|| Node { value: Value::String(text.into()), origin: origin.clone() })
}

/// The word after `kind`.
pub fn kind_of(root: &Node) -> &str {
    root.table().and_then(|table| table.get("kind")?.text()).unwrap_or("run")
}

/// What to do about a name that is none of a folder.
pub(super) const FILE_NAME: &str = "results go into a folder of this name: use letters, digits, blanks, - and _";

/// Why a study's name cannot be that of a folder beside others.
pub(super) fn no_file_name(name: &str) -> Option<String> {
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
