//! The findings of a check.

use crate::checks::repeat::shown;
use serde::Serialize;

/// A list of findings in words.
#[derive(Debug, Default)]
pub struct Findings(pub Vec<String>);

impl Findings {
    /// Adds `what` unless `fine` is true.
    pub fn expect(&mut self, fine: bool, what: &str) {
        if !fine {
            self.0.push(what.to_string());
        }
    }

    /// Adds a finding about an entry of results.json unless `fine` is true: its stored value, and the expected one with its
    /// source, such as "the stored motion gives".
    pub fn expect_entry(
        &mut self,
        fine: bool,
        entry: &str,
        (stored, source, expected): (impl Serialize, &str, impl Serialize),
    ) {
        if !fine {
            self.0.push(mismatch(entry, (stored, source, expected)));
        }
    }
}

/// The message for an entry with a wrong value: `load_factor is 700.0, but the stored forces give 698.0`.
pub fn mismatch(entry: &str, (stored, source, expected): (impl Serialize, &str, impl Serialize)) -> String {
    let value = |value| shown(&value);
    let (stored, expected) =
        (serde_json::to_value(stored).unwrap_or_default(), serde_json::to_value(expected).unwrap_or_default());
    format!("{entry} is {}, but {source} {}", value(stored), value(expected))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A message names the entry, its stored value, the source of the right value, and the right value.
    #[test]
    fn a_finding_says_what_was_found_and_what_was_expected() {
        let mut findings = Findings::default();
        findings.expect_entry(true, "load_factor", (1.0, "the stored forces give", 1.0));
        findings.expect_entry(false, "load_factor", (Some(700.0), "the stored forces give", Some(698.5)));
        findings.expect_entry(false, "variant", (None::<&str>, "the study has", Some("dry")));
        let expected =
            ["load_factor is 700.0, but the stored forces give 698.5", "variant is null, but the study has \"dry\""];
        assert_eq!(findings.0, expected);
    }
}
