//! The data that are needed to solve a case, without its study.

use crate::study::{Case, SelectedSolver, SpaceCase};
use voussoir_core::model::{Assembly, Stage};
use voussoir_core::path::PathSettings;

/// One case with all data for its solution.
#[derive(Debug, Clone, Copy)]
pub struct CaseInput<'a> {
    /// Blocks and joints.
    pub assembly: &'a Assembly,
    /// The scene in space with its loads; `None` for a plane scene.
    pub space: Option<&'a SpaceCase>,
    /// Stages in order.
    pub stages: &'a [Stage],
    /// The solver of the case.
    pub solver: &'a SelectedSolver,
    /// The limit solver of each stage, by index; `None` if the stage does not name one.
    pub of_stages: &'a [Option<SelectedSolver>],
    /// True if the points of a path are requested.
    pub curve: bool,
    /// Number of states of a path that are kept.
    pub states: usize,
    /// Greatest number of numbers in the states of a path for which the states and the witnesses of its end are kept; 0 keeps
    /// none.
    pub stored_numbers: usize,
    /// Settings of a path solver; the tolerance is also the greatest relative gap between bounds.
    pub settings: &'a PathSettings,
}

impl<'a> CaseInput<'a> {
    /// Returns the input of a case of a study.
    pub fn of(case: &'a Case) -> Self {
        CaseInput {
            assembly: &case.assembly,
            space: case.space.as_deref(),
            stages: &case.stages,
            solver: &case.solver.solver,
            of_stages: &case.solver.of_stages,
            curve: case.output_curve,
            states: case.output_states,
            stored_numbers: case.output_path_proofs,
            settings: &case.solver.settings,
        }
    }
}
