//! The description of a load that is carried: forces of joints, zone of thrust, reserve, permissible limit state.

use super::case_input::CaseInput;
use super::limit::asked_of_solvers;
use crate::results::CaseResult;
use crate::results::carried::{CarriedLoad, ReserveEntry, ReserveFlow, joint_entries, permissible};
use crate::results::convert::contact_force;
use crate::study::{Case, SelectedSolver, ZoneOfThrust};
use voussoir_core::certificate::ContactForce;
use voussoir_core::limit::{LimitProblem, LimitQuestion, Status};
use voussoir_core::model::{StageLoads, Target, stage_loads};
use voussoir_solvers::limit::{thrust_zone, zone_costs_little};

/// Returns the description of the load of a case that stands.
pub(crate) fn carried_load(case: &Case, result: &CaseResult) -> CarriedLoad {
    let last = case.stages.len() - 1;
    if !is_asked(case, result) {
        return CarriedLoad::default();
    }
    let field: Vec<ContactForce> = result.proof.field.iter().flatten().map(contact_force).collect();
    let mut carried = CarriedLoad { joints: joint_entries(&case.assembly, &field), ..CarriedLoad::default() };
    let loads = stage_loads(&case.assembly, &case.stages).swap_remove(last);
    let Ok(mut problem) = LimitProblem::new(&case.assembly, &loads) else { return carried };
    let flow = if problem.non_associated { ReserveFlow::ReadAsAssociated } else { ReserveFlow::Associated };
    problem.non_associated = false;
    let factor = match case.stages[last].target {
        Target::Factor(factor) => Some(factor),
        Target::Collapse => result.proof.field_factor,
    };
    // The zone of displaced blocks is different and is not computed.
    if let Some(factor) = factor.filter(|_| !case.solver.settings.finite) {
        add_zone(case, (&problem, factor), &mut carried);
    }
    carried.reserve = reserve(case, (&problem, &loads), flow);
    carried.permissible = carried.reserve.as_ref().and_then(|reserve| permissible(&case.assembly, reserve));
    carried
}

/// Returns true if a result must describe its load.
pub(crate) fn is_asked(case: &Case, result: &CaseResult) -> bool {
    case.output_joints
        && case.space.is_none()
        && !case.brief
        && result.status == Status::Stands
        && result.certificate.passed
}

/// Adds the interval of eccentricities to each joint, if it is requested or cheap to compute.
fn add_zone(case: &Case, (problem, factor): (&LimitProblem, f64), carried: &mut CarriedLoad) {
    let wanted = match case.output_zone {
        ZoneOfThrust::Never => false,
        ZoneOfThrust::Cheap => zone_costs_little(problem),
        ZoneOfThrust::Always => true,
    };
    if !wanted {
        return;
    }
    let at = |(fixed, varying): (&[f64; 3], &[f64; 3])| std::array::from_fn(|i| fixed[i] + factor * varying[i]);
    let loads = problem.fixed.iter().zip(&problem.varying).map(at).collect();
    for (joint, zone) in problem.joints.iter().zip(thrust_zone(problem, &loads)) {
        if let Some(entry) = carried.joints.iter_mut().find(|entry| entry.joint == joint.joint) {
            entry.zone = zone;
        }
    }
}

/// Returns the reserve of the last stage. `None` if the stage has no growing loads, or if its target factor is not positive.
fn reserve(case: &Case, (problem, loads): (&LimitProblem, &StageLoads), flow: ReserveFlow) -> Option<ReserveEntry> {
    let last = case.stages.len() - 1;
    let stage = &case.stages[last];
    let target = match stage.target {
        Target::Factor(factor) if factor > 0.0 => factor,
        _ => return None,
    };
    if problem.magnitude(&problem.varying) == 0.0 {
        return None;
    }
    let input = CaseInput { solver: &SelectedSolver::Auto, of_stages: &[], ..CaseInput::of(case) };
    let question = LimitQuestion::Collapse { start: 0.0, max: f64::INFINITY };
    let (found, _) = asked_of_solvers(&input, last, (problem, loads), question);
    Some(ReserveEntry {
        stage: stage.name.clone(),
        target,
        status: found.status,
        factor: found.load_factor,
        bounds: found.bounds,
        flow,
    })
}
