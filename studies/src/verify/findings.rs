//! What a check has found wrong.

/// Findings in words, one by one.
#[derive(Debug, Default)]
pub(super) struct Findings(pub Vec<String>);

impl Findings {
    /// Adds `what` unless it is fine.
    pub fn expect(&mut self, fine: bool, what: &str) {
        if !fine {
            self.0.push(what.to_string());
        }
    }
}
