//! What writers are given: the results and what they were computed from.

use super::columns::Labels;
use crate::results::{CaseResult, StudyResults, Totals, least_of};
use crate::study::{Case, Drawn, Output, Resolved, Study, SweptKeys};
use serde_json::Value as Json;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use voussoir_core::limit::Status;
use voussoir_core::model::{Assembly, Stage};

/// A study with its results.
#[derive(Debug, Clone)]
pub struct StudyOutput<'a> {
    /// Name of the study.
    pub name: &'a str,
    /// Results; of very many cases only those that readers are shown.
    pub results: &'a StudyResults,
    /// Counts over all cases.
    pub totals: &'a Totals,
    /// Where each case comes from, in the order of the results.
    pub scenes: Vec<SceneOutput<'a>>,
    /// Swept keys, outermost first.
    pub sweep_keys: Vec<String>,
    /// Units and words of the swept keys, and of those that the study kind varies.
    pub keys: SweptKeys,
    /// What is wanted besides the results.
    pub output: Output,
    /// Ids of the cases that are drawn, where not all are.
    pub drawn: Option<BTreeSet<usize>>,
    /// The study whose inputs a page lists.
    pub inputs: Option<&'a Study>,
}

/// The scene of a case.
#[derive(Debug, Clone, Copy)]
pub struct SceneOutput<'a> {
    /// Blocks and joints.
    pub assembly: &'a Assembly,
    /// Stages in order.
    pub stages: &'a [Stage],
    /// Whether displacements are finite.
    pub finite: bool,
    /// The case's own study file.
    pub resolved: &'a Resolved,
}

impl<'a> StudyOutput<'a> {
    /// A study with the results that readers are shown; `cases` are those of the results, in their order, and `totals`
    /// the counts over all cases.
    pub fn new(study: &'a Study, results: &'a StudyResults, totals: &'a Totals, cases: &'a [Cow<'a, Case>]) -> Self {
        let scene = |case: &'a Cow<'a, Case>| SceneOutput {
            assembly: &case.assembly,
            stages: &case.stages,
            finite: case.solver.settings.finite,
            resolved: &case.resolved,
        };
        let mut keys = study.swept_keys();
        keys.add_keys_of(cases.iter().map(Cow::as_ref));
        // Cases that a kind makes have more keys than the other cases.
        let swept = results.cases.iter().map(|case| &case.label.parameters).max_by_key(|own| own.len());
        StudyOutput {
            name: &study.name,
            results,
            totals,
            scenes: cases.iter().map(scene).collect(),
            sweep_keys: swept.map(|parameters| parameters.keys().cloned().collect()).unwrap_or_default(),
            keys,
            output: study.output.clone(),
            drawn: drawn(study.output.figures, results),
            inputs: Some(study),
        }
    }

    /// The columns of files that tell cases apart.
    pub fn file_labels(&self) -> Labels<'_> {
        Labels { variants: true, ..self.page_labels() }
    }

    /// The columns of pages that tell cases apart.
    pub fn page_labels(&self) -> Labels<'_> {
        let any = |given: fn(&CaseResult) -> bool| self.results.cases.iter().any(given);
        Labels {
            swept: &self.sweep_keys,
            keys: &self.keys,
            variants: any(|case| case.label.variant.is_some()),
            scenes: self.totals.scenes,
        }
    }

    /// The title of a case: `strathmashie, case 3, associated, rise = 2.99 m`.
    pub fn case_title(&self, case: &CaseResult) -> String {
        let mut parts = vec![self.name.to_string(), format!("case {}", case.label.id)];
        parts.extend(case.label.variant.clone());
        parts.extend(case.label.scene.clone());
        parts.extend(Some(self.keys.text(&case.label.parameters)).filter(|text| !text.is_empty()));
        parts.join(", ")
    }

    /// Whether a case is drawn.
    pub fn drawn(&self, id: usize) -> bool {
        self.drawn.as_ref().is_none_or(|drawn| drawn.contains(&id))
    }

    /// Assembly and stages of the case at this place in the list; `None` where they are missing.
    pub fn scene(&self, place: usize) -> Option<(&'a Assembly, &'a [Stage])> {
        self.scenes.get(place).map(|scene| (scene.assembly, scene.stages))
    }
}

/// The cases that are drawn, where not all are: of kinds that search those they found, else the least load factor of
/// each variant and its first case without an answer.
pub(crate) fn drawn(figures: Drawn, results: &StudyResults) -> Option<BTreeSet<usize>> {
    for found in ["worsts", "optima"] {
        let Some(entries) = results.own.get(found).and_then(Json::as_array) else { continue };
        let of = |entry: &Json| [entry["case"].as_u64(), entry["best_finite"]["case"].as_u64()];
        return Some(entries.iter().flat_map(of).flatten().map(|id| id as usize).collect());
    }
    (figures == Drawn::Worst).then(|| {
        let mut alike: BTreeMap<_, Vec<&CaseResult>> = BTreeMap::new();
        for case in &results.cases {
            alike.entry((&case.label.variant, case.status == Status::Stalled)).or_default().push(case);
        }
        let worst = |cases: &Vec<&CaseResult>| least_of(cases.iter().copied()).unwrap_or(cases[0]).label.id;
        alike.values().map(worst).collect()
    })
}
