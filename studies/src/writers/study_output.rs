//! What writers are given: the results and what they were computed from.

use crate::results::StudyResults;
use crate::study::{Output, Study};
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
    /// A study with results of some of its cases.
    pub fn new(study: &'a Study, results: &'a StudyResults) -> Self {
        let scene = |id: usize| {
            let case = &study.cases[id];
            SceneOutput { assembly: &case.assembly, stages: &case.stages, finite: case.solver.settings.finite }
        };
        StudyOutput {
            name: &study.name,
            results,
            scenes: results.cases.iter().map(|case| scene(case.label.id)).collect(),
            sweep_keys: study.cases.first().map(|case| case.parameters.keys().cloned().collect()).unwrap_or_default(),
            output: study.output.clone(),
        }
    }

    /// Assembly and stages of the case at this place in the list; `None` where they are missing.
    pub fn scene(&self, place: usize) -> Option<(&'a Assembly, &'a [Stage])> {
        self.scenes.get(place).map(|scene| (scene.assembly, scene.stages))
    }
}
