//! The diagnostics of one case, gathered while it is built.

use crate::config::diagnostic::LocatedDiagnostic;
use crate::config::document::Node;
use voussoir_core::issue::Issue;

/// What was found wrong so far, each placed by its key in the study `root`.
#[derive(Debug)]
pub struct DiagnosticList<'a> {
    root: &'a Node,
    /// Found so far.
    pub found: Vec<LocatedDiagnostic>,
}

impl<'a> DiagnosticList<'a> {
    /// A list that begins with what was found before.
    pub fn new(root: &'a Node, found: Vec<LocatedDiagnostic>) -> Self {
        DiagnosticList { root, found }
    }

    /// Adds what is wrong at a key and what to do about it.
    pub fn wrong(&mut self, key: &str, message: impl Into<String>, help: impl Into<String>) {
        self.found.push(LocatedDiagnostic::new(&self.root.place(key), key, message).help(help));
    }

    /// Adds diagnostics that know their key only.
    pub fn extend(&mut self, issues: Vec<Issue>) {
        self.found.extend(issues.into_iter().map(|issue| located(self.root, issue)));
    }
}

/// A diagnostic with the place of its key in the study `root`.
pub fn located(root: &Node, issue: Issue) -> LocatedDiagnostic {
    let origin = root.place(&issue.path);
    LocatedDiagnostic { origin, key: issue.path, message: issue.message, help: issue.help, case: None }
}
