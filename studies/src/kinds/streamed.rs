//! Studies of very many cases as commands see them. What is held here does not grow with their number, unless a
//! caller asks for everything at once; `voussoir run` and `merge` hand results from file to file instead.

use super::case_study::HOW;
use super::kind::{CasesOf, LoadedStudy, RunOutput, RunRequest, StoredResults, Verification};
use crate::results::CaseResult;
use crate::solve::explain::explain_first;
use crate::solve::{Observer, side_by_side, solve_followed};
use crate::study::{Sweep, as_blocks};
use crate::verify::case::verify_case;
use crate::verify::repeat::differences;
use crate::writers::stream::{CsvStream, StreamedResults, write_json};
use rayon::prelude::*;
use serde_json::Value as Json;
use voussoir_core::limit::Status;

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
        as_blocks(&self.case(0).map_err(|wrong| wrong.iter().map(ToString::to_string).collect::<String>())?, &self.name)
    }

    fn cases(&self) -> Option<CasesOf<'_>> {
        Some(CasesOf::Streamed(self))
    }

    fn run(&self, request: &RunRequest, observer: &dyn Observer) -> RunOutput {
        let mut cases: Vec<CaseResult> = Vec::new();
        CasesOf::Streamed(self).solve(&request.wanted, request.jobs, observer, &mut |case| cases.push(case));
        let certified = cases.iter().all(|case| case.certificate.passed);
        let only = (cases.len() < self.count()).then(|| cases.iter().map(|case| case.label.id).collect());
        let head = StreamedResults {
            study: self.name.clone(),
            version: request.version.clone(),
            date: request.date.clone(),
            only_cases: only,
        };
        let mut json = Vec::new();
        let written = write_json(&mut json, &head, &mut cases.iter().cloned().map(Ok)).and_then(|()| csv(self, &cases));
        let (files, remarks) = match written {
            Ok(csv) => (vec![("results.json".into(), json), ("results.csv".into(), csv)], Vec::new()),
            Err(error) => (Vec::new(), vec![error.to_string()]),
        };
        RunOutput { files, table: String::new(), remarks, certified }
    }

    fn verify_stored(&self, stored: &StoredResults, observer: &dyn Observer) -> Result<Verification, String> {
        let json: Json = serde_json::from_str(stored.results).map_err(|error| error.to_string())?;
        let entries = json["cases"].as_array().ok_or("there is no list of cases")?;
        let mut found = Verification { cases: entries.len(), of: self.count(), how: HOW, ..Verification::default() };
        if json["study"] != self.name.as_str() {
            found.findings.push((0, format!("results of {}, study \"{}\"", json["study"], self.name)));
        }
        let read =
            |entry: &Json| serde_json::from_value::<CaseResult>(entry.clone()).map_err(|error| error.to_string());
        let results = entries.iter().map(read).collect::<Result<Vec<_>, _>>()?;
        observer.begins(entries.len());
        let again = |(entry, result): (&Json, &CaseResult)| self.differs(entry, result, observer);
        let pairs = entries.par_iter().zip(&results);
        let wrong: Vec<Vec<String>> = side_by_side(stored.jobs, || pairs.map(again).collect());
        let by_id = results.iter().zip(wrong).flat_map(|(case, wrong)| wrong.into_iter().map(|w| (case.label.id, w)));
        found.findings.extend(by_id);
        found.findings.extend(self.misplaced(&results, json.get("only_cases").is_none()));
        found.stalled = results.iter().filter(|case| case.status == Status::Stalled).count();
        let csv = csv(self, &results).map_err(|error| error.to_string())?;
        found.files = stored.altered([("results.csv", csv.as_slice())].into_iter());
        Ok(found)
    }
}

impl Sweep {
    /// What is wrong with a stored case, by itself and against solving again.
    fn differs(&self, entry: &Json, result: &CaseResult, observer: &dyn Observer) -> Vec<String> {
        let Ok(case) = self.case(result.label.id) else { return vec!["the study has no such case".into()] };
        let Some(again) = solve_followed(&case, observer) else { return vec!["the check was cancelled".into()] };
        match serde_json::to_value(again) {
            Ok(again) => verify_case(&case, result).into_iter().chain(differences(entry, &again)).collect(),
            Err(why) => vec![why.to_string()],
        }
    }

    /// Cases that are not in their order, twice there, or missing where all should be there.
    fn misplaced(&self, results: &[CaseResult], whole: bool) -> Vec<(usize, String)> {
        let (mut wrong, mut next) = (Vec::new(), 0);
        for id in results.iter().map(|case| case.label.id) {
            if id < next {
                wrong.push((id, "stands twice, or after a later case".into()));
            }
            wrong.extend((next..id).filter(|_| whole).map(|id| (id, "is missing".into())));
            next = next.max(id + 1);
        }
        wrong.extend((next..self.count()).filter(|_| whole).map(|id| (id, "is missing".into())));
        wrong
    }
}

/// The bytes of results.csv.
fn csv(sweep: &Sweep, cases: &[CaseResult]) -> std::io::Result<Vec<u8>> {
    let mut csv = CsvStream::new(Vec::new(), sweep.keys())?;
    for case in cases {
        csv.add(case)?;
    }
    csv.finish()
}
