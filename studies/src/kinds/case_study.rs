//! Studies with a scene as commands see them: their cases are solved as their kind says, certified, and written by
//! all writers.

use super::kind::{LoadedStudy, RunOutput, RunRequest, Verification, kind};
use crate::results::{CaseLabel, CaseResult, StudyResults};
use crate::solve::Observer;
use crate::solve::explain::explain;
use crate::study::{Case, Study};
use crate::verify::verify;
use crate::writers::comparison::comparison_table;
use crate::writers::table::results_table;
use crate::writers::{StudyOutput, written};
use std::borrow::Cow;
use std::collections::BTreeMap;
use voussoir_core::limit::Status;

/// Cases that an interrupted run of the same study has finished.
fn finished([results, journal]: &[String; 2]) -> BTreeMap<usize, CaseResult> {
    let whole = serde_json::from_str::<StudyResults>(results).map(|results| results.cases).unwrap_or_default();
    // The last line of a killed run may be cut short: it does not parse and is done again.
    let lines = journal.lines().filter_map(|line| serde_json::from_str::<CaseResult>(line).ok());
    let done = whole.into_iter().chain(lines).filter(|case| case.status != Status::Stalled);
    done.map(|case| (case.label.id, case)).collect()
}

impl Study {
    /// The case that a result belongs to, as the study's kind finds it.
    pub fn case_of(&self, label: &CaseLabel) -> Option<Cow<'_, Case>> {
        kind(&self.kind)?.case(self, label)
    }

    /// Results of the study from those of its cases.
    pub fn results(&self, version: &str, cases: Vec<CaseResult>) -> StudyResults {
        let own = kind(&self.kind).map(|kind| kind.own_results(self, &cases)).unwrap_or_default();
        let (study, version) = (self.name.clone(), version.to_string());
        StudyResults { study, version, cases, comparison: own.comparison, own: own.other }
    }
}

impl LoadedStudy for Study {
    fn name(&self) -> &str {
        &self.name
    }

    fn count(&self) -> usize {
        self.cases.len()
    }

    fn resolved(&self) -> &toml::Value {
        &self.resolved
    }

    fn explain(&self) -> String {
        explain(self)
    }

    fn run(&self, request: &RunRequest, observer: &dyn Observer) -> RunOutput {
        let mut done = request.stored.as_ref().map(finished).unwrap_or_default();
        done.retain(|id, _| request.wanted.contains(id));
        let rest: Vec<usize> = request.wanted.iter().copied().filter(|id| !done.contains_key(id)).collect();
        observer.begins(rest.len());
        if let Some(kind) = kind(&self.kind) {
            let solved = kind.solve(self, &rest, request.jobs, observer);
            done.extend(solved.into_iter().map(|case| (case.label.id, case)));
        }
        let results = self.results(&request.version, done.into_values().collect());
        let cases: Vec<_> = results.cases.iter().filter_map(|case| self.case_of(&case.label)).collect();
        let output = StudyOutput::new(self, &results, &cases);
        let files = written(&output);
        let mut table = results_table(&output);
        if let Some(comparison) = &results.comparison {
            table += "\n";
            table += &comparison_table(comparison);
        }
        RunOutput { files, table, certified: results.cases.iter().all(|case| case.certificate.passed) }
    }

    fn verify(&self, results: &str) -> Result<Verification, String> {
        let results: StudyResults = serde_json::from_str(results).map_err(|error| error.to_string())?;
        let stalled = results.cases.iter().filter(|case| case.status == Status::Stalled).count();
        Ok(Verification { cases: results.cases.len(), stalled, findings: verify(self, &results) })
    }
}
