//! Studies of very many cases as commands see them. What is held here does not grow with their number, unless a
//! caller asks for everything at once; `voussoir run`, `merge` and `verify` hand results from file to file instead.

use super::kind::{CasesOf, LoadedStudy, RunOutput, RunRequest, StoredResults, Verification};
use super::verify_streamed::verify;
use crate::results::{CaseResult, Origin, words};
use crate::solve::Observer;
use crate::solve::explain::explain_first;
use crate::study::{Sweep, as_blocks};
use crate::writers::results_text::{ResultsHead, ResultsText, case_text};
use crate::writers::streamed_tables::{StreamedTable, wanted};
use serde_json::Map;

impl LoadedStudy for Sweep {
    fn name(&self) -> &str {
        &self.name
    }

    fn count(&self) -> usize {
        Sweep::count(self)
    }

    fn resolved(&self) -> &toml::Value {
        &self.resolved
    }

    fn notes(&self) -> Vec<String> {
        self.notes.clone()
    }

    fn explain(&self) -> String {
        explain_first(&self.name, &self.kind, self.count(), self.case(0).ok().as_ref())
    }

    fn as_blocks(&self) -> Result<String, String> {
        as_blocks(&self.case(0).map_err(|wrong| wrong.to_string())?, &self.name)
    }

    fn cases(&self) -> Option<CasesOf<'_>> {
        Some(CasesOf::Streamed(self))
    }

    fn run(&self, request: &RunRequest, observer: &dyn Observer) -> RunOutput {
        let mut cases: Vec<CaseResult> = Vec::new();
        CasesOf::Streamed(self).solve(&request.wanted, request.jobs, observer, &mut |case| cases.push(case));
        let certified = cases.iter().all(|case| case.certificate.passed);
        let only = (cases.len() < self.count()).then(|| cases.iter().map(|case| case.label.id).collect());
        let head = ResultsHead {
            study: self.name.clone(),
            version: request.version.clone(),
            origin: Origin::here(&words(&self.resolved)),
            date: request.date.clone(),
            only_cases: only,
            files: wanted(self).into_iter().map(String::from).collect(),
        };
        let (files, remarks) = match files(self, &head, &cases) {
            Ok(files) => (files, Vec::new()),
            Err(error) => (Vec::new(), vec![error.to_string()]),
        };
        RunOutput { files, remarks, certified, ..RunOutput::default() }
    }

    fn verify_stored(&self, stored: &StoredResults, observer: &dyn Observer) -> Result<Verification, String> {
        verify(self, stored, observer)
    }
}

/// results.json and the tables that are wanted, by name.
fn files(sweep: &Sweep, head: &ResultsHead, cases: &[CaseResult]) -> std::io::Result<Vec<(String, Vec<u8>)>> {
    let mut json = ResultsText::begin(Vec::new(), head)?;
    cases.iter().try_for_each(|case| json.add(&case_text(case)?))?;
    let json = ("results.json".to_string(), json.finish(None, &Map::new())?);
    let whole = |name: &'static str| {
        let mut table = StreamedTable::new(name, Vec::new(), sweep)?;
        cases.iter().try_for_each(|case| table.add(case))?;
        Ok((name.to_string(), table.finish()?))
    };
    std::iter::once(Ok(json)).chain(wanted(sweep).into_iter().map(whole)).collect()
}
