//! What writers are given: the results and what they were computed from.

use crate::results::StudyResults;
use crate::study::{Case, Output, Study};
use std::borrow::Cow;
use voussoir_core::model::{Assembly, Stage};

/// A study with its results.
#[derive(Debug, Clone)]
pub struct StudyOutput<'a> {
    /// Name of the study.
    pub name: &'a str,
    /// Results, one per case.
    pub results: &'a StudyResults,
    /// Where each case comes from, in the order of the results.
    pub scenes: Vec<SceneOutput<'a>>,
    /// Swept keys, outermost first.
    pub sweep_keys: Vec<String>,
    /// What is wanted besides the results.
    pub output: Output,
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
}

impl<'a> StudyOutput<'a> {
    /// A study with results of some of its cases; `cases` are those of the results, in their order.
    pub fn new(study: &'a Study, results: &'a StudyResults, cases: &'a [Cow<'a, Case>]) -> Self {
        let scene = |case: &'a Cow<'a, Case>| SceneOutput {
            assembly: &case.assembly,
            stages: &case.stages,
            finite: case.solver.settings.finite,
        };
        let swept = results.cases.first().map(|case| &case.label.parameters);
        StudyOutput {
            name: &study.name,
            results,
            scenes: cases.iter().map(scene).collect(),
            sweep_keys: swept.map(|parameters| parameters.keys().cloned().collect()).unwrap_or_default(),
            output: study.output.clone(),
        }
    }

    /// Whether a case is drawn: of an envelope only the worst places are.
    pub fn drawn(&self, id: usize) -> bool {
        let Some(worsts) = self.results.own.get("worsts").and_then(serde_json::Value::as_array) else { return true };
        worsts.iter().any(|worst| worst["case"].as_u64() == Some(id as u64))
    }

    /// Assembly and stages of the case at this place in the list; `None` where they are missing.
    pub fn scene(&self, place: usize) -> Option<(&'a Assembly, &'a [Stage])> {
        self.scenes.get(place).map(|scene| (scene.assembly, scene.stages))
    }
}
