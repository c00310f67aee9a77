//! The input of writers: the results, and the study that they were computed from.

use crate::output::columns::Labels;
use std::borrow::Cow;
use std::collections::{BTreeMap, BTreeSet};
use voussoir_core::limit::Status;
use voussoir_core::model::{Assembly, Stage};
use voussoir_study::results::{CaseResult, OptimumEntry, StudyResults, Totals, least_of};
use voussoir_study::study::{Case, Drawn, Output, Resolved, SpaceCase, Study, SweptKeys};

/// A study with its results.
#[derive(Debug, Clone)]
pub struct StudyOutput<'a> {
    /// Name of the study.
    pub name: &'a str,
    /// Results; if there are very many cases, only those that readers are shown.
    pub results: &'a StudyResults,
    /// Counts over all cases.
    pub totals: &'a Totals,
    /// The scene of each case, in the order of the results.
    pub scenes: Vec<SceneOutput<'a>>,
    /// Swept keys, outermost first.
    pub sweep_keys: Vec<String>,
    /// Units and descriptions of the swept keys, and of the keys that the study kind varies.
    pub keys: SweptKeys,
    /// The outputs that the study requests in addition to the results.
    pub output: Output,
    /// Ids of the cases that are drawn; `None` if all are drawn.
    pub drawn: Option<BTreeSet<usize>>,
    /// The study whose inputs are listed in pages.
    pub inputs: Option<&'a Study>,
}

/// The scene of a case.
#[derive(Debug, Clone, Copy)]
pub struct SceneOutput<'a> {
    /// Blocks and joints of a plane scene.
    pub assembly: &'a Assembly,
    /// The scene in space; `None` for a plane scene.
    pub space: Option<&'a SpaceCase>,
    /// Stages in order.
    pub stages: &'a [Stage],
    /// True if displacements are finite.
    pub finite: bool,
    /// The study file of this single case.
    pub resolved: &'a Resolved,
}

impl<'a> StudyOutput<'a> {
    /// Creates the input of writers. `cases` are the cases of the results, in the same order; `totals` are the counts
    /// over all cases.
    pub fn new(study: &'a Study, results: &'a StudyResults, totals: &'a Totals, cases: &'a [Cow<'a, Case>]) -> Self {
        let scene = |case: &'a Cow<'a, Case>| SceneOutput {
            assembly: &case.assembly,
            space: case.space.as_deref(),
            stages: &case.stages,
            finite: case.solver.settings.finite,
            resolved: &case.resolved,
        };
        let mut keys = study.swept_keys();
        keys.add_keys_of(cases.iter().map(Cow::as_ref));
        // Cases that a study kind creates have more keys than the other cases.
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

    /// The columns that identify cases in files.
    pub fn file_labels(&self) -> Labels<'_> {
        Labels { variants: true, ..self.page_labels() }
    }

    /// The columns that identify cases in pages.
    pub fn page_labels(&self) -> Labels<'_> {
        let any = |given: fn(&CaseResult) -> bool| self.results.cases.iter().any(given);
        Labels {
            swept: &self.sweep_keys,
            keys: &self.keys,
            variants: any(|case| case.label.variant.is_some()),
            scenes: self.totals.scenes,
            outputs: &self.totals.outputs,
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

    /// Returns true if a case is drawn.
    pub fn drawn(&self, id: usize) -> bool {
        self.drawn.as_ref().is_none_or(|drawn| drawn.contains(&id))
    }

    /// Assembly and stages of the case with this index; `None` if they are missing.
    pub fn scene(&self, place: usize) -> Option<(&'a Assembly, &'a [Stage])> {
        self.scenes.get(place).map(|scene| (scene.assembly, scene.stages))
    }
}

/// The cases that are drawn; `None` if all are drawn. For kinds that search: the cases that were found. Otherwise: the
/// least load factor of each variant, and its first case without a result.
pub fn drawn(figures: Drawn, results: &StudyResults) -> Option<BTreeSet<usize>> {
    if let Some(worsts) = &results.own.worsts {
        return Some(worsts.iter().map(|worst| worst.place.case).collect());
    }
    if let Some(optima) = &results.own.optima {
        let of = |own: &OptimumEntry| [own.case, own.best_finite.as_ref().map(|best| best.case)];
        return Some(optima.iter().flat_map(of).flatten().collect());
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
