//! The findings of a check.

/// A list of findings in words.
#[derive(Debug, Default)]
pub(super) struct Findings(pub Vec<String>);

impl Findings {
    /// Adds `what` unless `fine` is true.
    pub fn expect(&mut self, fine: bool, what: &str) {
        if !fine {
            self.0.push(what.to_string());
        }
    }
}
