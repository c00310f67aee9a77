//! The diagnostics of one case, gathered while it is built.

use crate::config::diagnostic::LocatedDiagnostic;
use crate::config::document::Node;
use voussoir_core::plugin::Diagnostic;

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
    pub fn extend(&mut self, diagnostics: Vec<Diagnostic>) {
        self.found.extend(diagnostics.into_iter().map(|diagnostic| located(self.root, diagnostic)));
    }
}

/// A diagnostic with the place of its key in the study `root`.
pub fn located(root: &Node, diagnostic: Diagnostic) -> LocatedDiagnostic {
    let origin = root.place(&diagnostic.path);
    LocatedDiagnostic { origin, key: diagnostic.path, message: diagnostic.message, help: diagnostic.help, case: None }
}
