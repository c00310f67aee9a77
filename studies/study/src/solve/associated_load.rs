//! The load of limit analysis with associated flow as an upper bound of a path.
//!
//! If displacements are small and joints have no strength except friction, every state of a path is an admissible field of
//! rigid blocks, for any flow and stiffness. So no state is above the associated load (static theorem). With strengths this
//! holds only for fields at the path's own points, which limit analysis does not have.

use super::case_input::CaseInput;
use super::limit::asked_of_solvers;
use super::statics::resists_by_friction_alone;
use crate::results::MotionEntry;
use crate::study::SelectedSolver;
use voussoir_core::limit::{LimitProblem, LimitQuestion, Status};
use voussoir_core::model::{Target, stage_loads};

/// The greatest factor of the last stage with associated flow.
#[derive(Debug, Clone)]
pub(crate) struct AssociatedLoad {
    /// The upper bound that a mechanism proves.
    pub factor: f64,
    /// Size of the constant loads divided by the size of the growing loads.
    pub unit: f64,
    /// True if all joints have associated flow, so that an elastic path ends at this load.
    pub associated: bool,
    /// The mechanism of that load.
    pub motion: Vec<MotionEntry>,
}

/// Returns the associated load of a case whose path has small displacements. `None` if it is not an upper bound or was not
/// proved.
pub(crate) fn associated_load(input: &CaseInput) -> Option<AssociatedLoad> {
    let (assembly, index) = (input.assembly, input.stages.len().checked_sub(1)?);
    let stage = &input.stages[index];
    let falls = matches!(stage.target, Target::Factor(factor) if factor <= 0.0);
    if input.settings.finite || falls || !resists_by_friction_alone(assembly) {
        return None;
    }
    let loads = stage_loads(assembly, input.stages);
    let mut problem = LimitProblem::new(assembly, &loads[index]).ok()?;
    let [fixed, varying] = [&problem.fixed, &problem.varying].map(|wrenches| problem.magnitude(wrenches));
    if varying == 0.0 {
        return None;
    }
    let yields = (0..assembly.bodies.len()).any(|body| !assembly.bodies[body].fixed && assembly.yields(body));
    let associated = !problem.non_associated && !yields;
    problem.non_associated = false;
    let posed = CaseInput { solver: &SelectedSolver::Auto, of_stages: &[], ..*input };
    let asked = LimitQuestion::Collapse { start: 0.0, max: f64::INFINITY };
    let (answer, _) = asked_of_solvers(&posed, index, (&problem, &loads[index]), asked);
    let factor = answer.bounds?[1].filter(|_| answer.status == Status::Collapse)?;
    let motion = answer.proof.motion.unwrap_or_default();
    Some(AssociatedLoad { factor, unit: fixed / varying, associated, motion })
}
