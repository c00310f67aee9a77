//! Limit analysis of stages that move supports: rigid blocks without compliance, small displacements.
//!
//! Loads decide by themselves whether a stage stands: where supports are does not change them. How the blocks follow,
//! and with which forces, is asked of the solver; all settlements so far count together.

use super::case_input::CaseInput;
use super::limit_result::{body_velocities, contact_forces};
use crate::results::convert::field_entries;
use crate::results::thrust_line::thrust_line;
use crate::results::{CaseResult, DisplacementEntry};
use voussoir_core::certificate::{
    CentroidVelocity, Claim, Hinge, certify, jumps, largest_jump, mechanism, settlement_residuals,
};
use voussoir_core::law::FlowRule;
use voussoir_core::limit::{LimitProblem, LimitSolver, SettlementAnswer, Status};
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::model::{Assembly, Bond, Stage, StageLoads, Target};

/// Residual up to which a settlement is proved.
const PROVED: f64 = 1e-8;
/// Jumps below this share of the displacements are rounding.
const RIGID: f64 = 1e-10;

/// Whether a support has moved by the end of a stage.
pub(super) fn settles(stages: &[Stage], index: usize) -> bool {
    stages[..=index].iter().flat_map(|stage| &stage.settlements).any(|s| s.displacement.norm() + s.rotation.abs() > 0.0)
}

/// Motion of every held block at its centroid at the end of a stage; `None` of free ones. An error says which blocks are
/// bonded to supports that move apart.
fn supports(assembly: &Assembly, stages: &[Stage], index: usize) -> Result<Vec<Option<CentroidVelocity>>, String> {
    let groups = assembly.rigid_groups().0;
    // Motion as a rigid one seen at the origin.
    let mut own: Vec<Option<[f64; 3]>> = assembly.bodies.iter().map(|body| body.fixed.then_some([0.0; 3])).collect();
    for stage in &stages[..=index] {
        let factor = match stage.target {
            Target::Factor(factor) => factor,
            Target::Collapse => 1.0,
        };
        for settlement in &stage.settlements {
            let at_origin = settlement.displacement - turned(settlement.about) * settlement.rotation;
            if let Some(motion) = &mut own[settlement.body] {
                let moved = [at_origin.x, at_origin.y, settlement.rotation];
                (0..3).for_each(|i| motion[i] += factor * moved[i]);
            }
        }
    }
    // What is bonded to a support is part of it.
    let bonded = || assembly.joints.iter().filter(|joint| joint.bond == Bond::Bonded);
    loop {
        let mut changed = false;
        for joint in bonded().filter(|j| groups[j.minus].is_none() && groups[j.plus].is_none()) {
            match (own[joint.minus], own[joint.plus]) {
                (Some(a), None) => (own[joint.plus], changed) = (Some(a), true),
                (None, Some(b)) => (own[joint.minus], changed) = (Some(b), true),
                (Some(a), Some(b)) if a != b => {
                    let [a, b] = [joint.minus, joint.plus].map(|body| &assembly.bodies[body].name);
                    return Err(format!("\"{a}\" and \"{b}\" are bonded and would be moved apart"));
                }
                _ => {}
            }
        }
        if !changed {
            break;
        }
    }
    let at_centroid = |(body, motion): (usize, &Option<[f64; 3]>)| {
        motion.map(|[x, y, theta]| {
            let v = Vec2::new(x, y) + turned(assembly.inertia(body).centroid) * theta;
            [v.x, v.y, theta]
        })
    };
    Ok(own.iter().enumerate().map(at_centroid).collect())
}

/// Openings of both ends and slip that the supports alone cause at each joint of the problem.
fn openings(assembly: &Assembly, problem: &LimitProblem, supports: &[Option<CentroidVelocity>]) -> Vec<[f64; 3]> {
    let moved = |body: usize, point: Vec2| {
        supports[body].map_or(Vec2::zeros(), |[x, y, theta]| {
            Vec2::new(x, y) + turned(point - assembly.inertia(body).centroid) * theta
        })
    };
    let of = |joint: &voussoir_core::limit::LimitJoint| {
        let own = &assembly.joints[joint.joint];
        let apart = joint.ends.map(|end| moved(own.plus, end) - moved(own.minus, end));
        let slip = (apart[0] + apart[1]).dot(&joint.tangent) / 2.0;
        [apart[0].dot(&joint.normal), apart[1].dot(&joint.normal), slip]
    };
    problem.joints.iter().map(of).collect()
}

/// What is asked of a solver.
#[derive(Clone, Copy)]
pub(super) struct Settling<'a> {
    pub solver: &'a dyn LimitSolver,
    pub problem: &'a LimitProblem,
    pub loads: &'a StageLoads,
    /// Factor of the stage's loads.
    pub factor: f64,
}

/// Puts into the result of a stage that stands how its blocks have followed their supports: field, displacements and
/// residuals. Returns the hinges; where nothing is proved the stage is stalled.
pub(super) fn follow_supports(input: &CaseInput, index: usize, asked: Settling, result: &mut CaseResult) -> Vec<Hinge> {
    let found = followed(input, index, asked, result);
    found.unwrap_or_else(|why| {
        result.status = Status::Stalled;
        result.certificate.passed = false;
        result.certificate.failures.push(why.clone());
        result.notes.push(why);
        Vec::new()
    })
}

fn followed(input: &CaseInput, index: usize, asked: Settling, result: &mut CaseResult) -> Result<Vec<Hinge>, String> {
    let (assembly, problem) = (input.assembly, asked.problem);
    if problem.joints.iter().any(|joint| joint.fill.is_some()) {
        return Err("settlements of rigid blocks take no fill that presses: switch its resistance off".into());
    }
    let supports = supports(assembly, input.stages, index)?;
    let sum = |(a, b): (&[f64; 3], &[f64; 3])| std::array::from_fn(|i| a[i] + asked.factor * b[i]);
    let loads = problem.fixed.iter().zip(&problem.varying).map(sum).collect();
    let (field, motion, unique) = match asked.solver.settle(problem, &loads, &openings(assembly, problem, &supports)) {
        SettlementAnswer::Follows { field, motion, unique } => (field, motion, unique),
        SettlementAnswer::Refused(why) => return Err(why),
    };
    let field = contact_forces(problem, &field);
    let free = body_velocities(assembly, problem, &motion);
    let motion: Vec<CentroidVelocity> = supports.iter().zip(free).map(|(held, free)| held.unwrap_or(free)).collect();
    let claim = Claim {
        status: Status::Stands,
        factor: None,
        field_factor: asked.factor,
        start: asked.factor,
        field: Some(&field),
        fill: &[],
        motion: None,
        ray: None,
        feasible_interval: None,
        non_associated: None,
    };
    let (certificate, _) = certify(assembly, asked.loads, &claim, input.settings.tolerance);
    if !certificate.passed {
        return Err(certificate.failures.join("; "));
    }
    result.certificate.residuals.extend(certificate.residuals);
    for (name, value) in settlement_residuals(assembly, &field, &motion, &supports) {
        result.certificate.residuals.insert(name.into(), value);
        if value.is_nan() || value > PROVED {
            return Err(format!("{name}: {value:.3e} exceeds {PROVED:.1e}"));
        }
    }
    if problem.non_associated {
        result.flow_read_as = Some("associated".into());
        let note = "blocks follow their supports with associated flow: slip opens a joint by its friction angle";
        result.notes.push(note.into());
    }
    let name = |body: usize| assembly.bodies[body].name.clone();
    let entry = |(body, displacement): (usize, &CentroidVelocity)| DisplacementEntry {
        body: name(body),
        displacement: *displacement,
    };
    result.path.displacements = Some(motion.iter().enumerate().map(entry).collect());
    result.proof.thrust_line = thrust_line(assembly, &field);
    result.proof.field = Some(field_entries(&field));
    // Blocks that move as one have no hinges but rounding.
    let greatest = motion.iter().flatten().fold(0.0, |a: f64, v| a.max(v.abs()));
    if largest_jump(&jumps(assembly, &motion)) <= RIGID * greatest {
        return Ok(Vec::new());
    }
    let found = mechanism(assembly, &motion, unique, FlowRule::Associated);
    Ok(found.map_or_else(Vec::new, |found| found.hinges))
}
