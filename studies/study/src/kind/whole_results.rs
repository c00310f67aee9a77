//! The results of a whole study from the results of its cases.

use super::study_kind::{OwnResults, kind};
use crate::results::{CaseResult, Origin, StudyResults, Totals, words};
use crate::study::Study;

impl Study {
    /// Returns the results of the study from the results of its cases.
    pub fn results(&self, version: &str, cases: Vec<CaseResult>) -> StudyResults {
        let own = self.own_results(&cases);
        let totals = Totals::of(&cases);
        StudyResults { cases, ..self.results_without_cases(version, &totals, &own) }
    }

    /// Returns results without their cases.
    pub fn results_without_cases(&self, version: &str, totals: &Totals, own: &OwnResults) -> StudyResults {
        let ids: Vec<usize> = totals.ids().filter(|id| *id < self.count()).collect();
        StudyResults {
            study: self.name.clone(),
            version: version.into(),
            origin: Origin::here(&words(&self.resolved)),
            only_cases: (ids.len() < self.count()).then_some(ids),
            comparison: own.comparison.clone(),
            own: own.entries.clone(),
            ..StudyResults::default()
        }
    }

    /// Returns the additions of the study's kind to the results of the cases.
    pub fn own_results(&self, cases: &[CaseResult]) -> OwnResults {
        kind(&self.kind).map(|kind| kind.own_results(self, cases)).unwrap_or_default()
    }
}
