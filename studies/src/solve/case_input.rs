//! What is needed to solve a case, without the study that it came from.

use crate::study::{Case, SelectedSolver};
use voussoir_core::model::{Assembly, Stage};
use voussoir_core::path::PathSettings;

/// One case, ready to be solved.
#[derive(Debug, Clone, Copy)]
pub struct CaseInput<'a> {
    /// Blocks and joints.
    pub assembly: &'a Assembly,
    /// Stages in order.
    pub stages: &'a [Stage],
    /// Which solver.
    pub solver: &'a SelectedSolver,
    /// Which limit solver answers a stage that names its own, by index.
    pub of_stages: &'a [Option<SelectedSolver>],
    /// Whether the points of a path are asked for.
    pub curve: bool,
    /// How many states of a path are kept.
    pub states: usize,
    /// Most numbers in the states of a path for which they are kept with the witnesses that prove its end; 0 keeps none.
    pub stored_numbers: usize,
    /// What a path solver is told; its tolerance is the greatest relative gap between bounds too.
    pub settings: &'a PathSettings,
}

impl<'a> CaseInput<'a> {
    /// What a case of a study asks for.
    pub fn of(case: &'a Case) -> Self {
        CaseInput {
            assembly: &case.assembly,
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
