//! Findings of the checks of a law.

use super::reproduce::reproduce;
use std::collections::BTreeMap;
use std::fmt;
use voussoir_core::plugin::{Card, PluginKind, Sample};

/// A promise that a law does not keep.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Name of the check.
    pub check: &'static str,
    /// Description of the violation.
    pub what: String,
    /// A study of `kind = "point"` that reproduces it, if a path leads to it.
    pub study: Option<String>,
}

/// Report of the checks of one law.
#[derive(Debug, Clone, PartialEq)]
pub struct Report {
    /// The law's tag.
    pub tag: String,
    /// Its kind.
    pub kind: PluginKind,
    /// Each check by name with the number of times it was made.
    pub done: BTreeMap<&'static str, usize>,
    /// Checks that were skipped, with the reason.
    pub left_out: Vec<String>,
    /// Findings; at most one for each check and sample.
    pub findings: Vec<Finding>,
}

impl Report {
    /// Returns true if the law conforms.
    pub fn passed(&self) -> bool {
        self.findings.is_empty()
    }

    /// Returns true if the check of this name has a finding.
    pub fn fails(&self, check: &str) -> bool {
        self.findings.iter().any(|finding| finding.check == check)
    }
}

impl fmt::Display for Report {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.passed() { "conforms" } else { "does not conform" };
        writeln!(out, "{} \"{}\" {verdict}", self.kind.describe(), self.tag)?;
        for (check, times) in &self.done {
            let word = if self.fails(check) { "FAILS" } else { "holds" };
            writeln!(out, "  {check:<20} {word}  {times} time{}", if *times == 1 { "" } else { "s" })?;
        }
        self.left_out.iter().try_for_each(|why| writeln!(out, "  not checked: {why}"))?;
        self.findings.iter().try_for_each(|finding| writeln!(out, "  {}: {}", finding.check, finding.what))
    }
}

/// Collects findings: the first one of each check in each sample.
pub struct Recorder<'a> {
    card: &'a Card,
    sample: Option<Sample>,
    report: Report,
    seen: Vec<&'static str>,
}

impl<'a> Recorder<'a> {
    pub(super) fn new(card: &'a Card) -> Self {
        let report = Report {
            tag: card.tag.into(),
            kind: card.kind,
            done: BTreeMap::new(),
            left_out: Vec::new(),
            findings: Vec::new(),
        };
        Recorder { card, sample: None, report, seen: Vec::new() }
    }

    /// Begins the checks of a sample.
    pub fn sample(&mut self, sample: &Sample) {
        self.sample = Some(*sample);
        self.seen.clear();
    }

    /// Begins the checks of the whole law.
    pub fn whole(&mut self) {
        self.sample = None;
        self.seen.clear();
    }

    /// Records a check.
    pub fn hold(&mut self, check: &'static str, holds: bool, what: impl FnOnce() -> String) {
        self.hold_on(check, holds, &[], what);
    }

    /// Records a check at the end of a path through gaps or strains.
    pub(super) fn hold_on(
        &mut self,
        check: &'static str,
        holds: bool,
        path: &[[f64; 6]],
        what: impl FnOnce() -> String,
    ) {
        *self.report.done.entry(check).or_default() += 1;
        if holds || self.seen.contains(&check) {
            return;
        }
        self.seen.push(check);
        let table = self.sample.map_or("", |sample| sample.table);
        let study = (!path.is_empty()).then(|| reproduce(self.card, check, table, path));
        let at = if table.is_empty() { String::new() } else { format!("; with {}", table.replace('\n', ", ")) };
        self.report.findings.push(Finding { check, what: what() + &at, study });
    }

    /// Records a check that fails.
    pub fn fail(&mut self, check: &'static str, what: String) {
        self.hold(check, false, || what);
    }

    /// Records a check that was skipped.
    pub fn leave_out(&mut self, why: &str) {
        if !self.report.left_out.iter().any(|known| known == why) {
            self.report.left_out.push(why.into());
        }
    }

    pub(super) fn report(self) -> Report {
        self.report
    }
}
