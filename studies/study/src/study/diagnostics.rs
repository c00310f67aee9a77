//! The diagnostics of one case, collected while it is built.

use crate::config::diagnostic::LocatedDiagnostic;
use crate::config::document::Node;
use voussoir_core::plugin::Diagnostic;

/// Mistakes so far, each placed by its key in the study `root`.
#[derive(Debug)]
pub struct DiagnosticList<'a> {
    root: &'a Node,
    /// Mistakes so far.
    pub found: Vec<LocatedDiagnostic>,
}

impl<'a> DiagnosticList<'a> {
    /// Starts a list with earlier mistakes.
    pub fn new(root: &'a Node, found: Vec<LocatedDiagnostic>) -> Self {
        DiagnosticList { root, found }
    }

    /// Adds a mistake at a key, with advice.
    pub fn wrong(&mut self, key: &str, message: impl Into<String>, help: impl Into<String>) {
        self.found.push(LocatedDiagnostic::new(&self.root.place(key), key, message).help(help));
    }

    /// Adds diagnostics that have only a key.
    pub fn extend(&mut self, diagnostics: Vec<Diagnostic>) {
        self.found.extend(diagnostics.into_iter().map(|diagnostic| located(self.root, diagnostic)));
    }
}

/// Returns a diagnostic with the place of its key in the study `root`.
pub fn located(root: &Node, diagnostic: Diagnostic) -> LocatedDiagnostic {
    let origin = root.place(&diagnostic.path);
    LocatedDiagnostic { origin, key: diagnostic.path, message: diagnostic.message, help: diagnostic.help, case: None }
}
