//! Limit analysis of stages that move supports: rigid blocks without compliance, small displacements.
//!
//! The loads alone decide if a stage stands: the positions of supports do not change them. The solver computes the motion of
//! the blocks and the forces; all settlements so far are added.

use super::case_input::CaseInput;
use super::limit_result::{body_velocities, contact_forces};
use crate::results::convert::{contact_force, field_entries};
use crate::results::thrust_line::thrust_line;
use crate::results::{CaseResult, DisplacementEntry, ProofFields};
use voussoir_core::certificate::{
    CentroidVelocity, Claim, ContactForce, Hinge, Verdict, certify, jumps, largest_jump, mechanism,
    settlement_residuals, support_motions,
};
use voussoir_core::law::FlowRule;
use voussoir_core::limit::{LimitProblem, LimitSolver, SettlementAnswer, Status};
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::model::{Assembly, Stage, StageLoads};

/// Residual up to which a settlement is proved.
const PROVED: f64 = 1e-8;
/// Jumps below this share of the displacements are rounding.
const RIGID: f64 = 1e-10;

/// Returns true if a support has moved by the end of a stage.
pub(super) fn settles(stages: &[Stage], index: usize) -> bool {
    stages[..=index].iter().flat_map(|stage| &stage.settlements).any(|s| s.displacement.norm() + s.rotation.abs() > 0.0)
}

/// Returns the openings of both ends and the slip that the supports alone cause at each joint of the problem.
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

/// Returns the motion of all blocks if all supports move as one body: all blocks have the same motion, and no joint moves.
fn common_motion(assembly: &Assembly, supports: &[Option<CentroidVelocity>]) -> Option<Vec<CentroidVelocity>> {
    let centroids = assembly.centroids();
    let (first, own) = supports.iter().enumerate().find_map(|(body, own)| own.map(|own| (body, own)))?;
    let at = |body: usize| {
        let v = Vec2::new(own[0], own[1]) + turned(centroids[body] - centroids[first]) * own[2];
        [v.x, v.y, own[2]]
    };
    let moved = own[0].hypot(own[1]) + own[2].abs() * assembly.size();
    let same = |(body, held): (usize, &Option<CentroidVelocity>)| {
        let Some(held) = held else { return true };
        let expected = at(body);
        let off = (0..3).map(|i| (held[i] - expected[i]).abs() * if i == 2 { assembly.size() } else { 1.0 });
        off.fold(0.0, f64::max) <= RIGID * moved
    };
    let one = supports.iter().enumerate().all(same);
    one.then(|| (0..supports.len()).map(|body| supports[body].unwrap_or_else(|| at(body))).collect())
}

/// The question to a solver.
#[derive(Clone, Copy)]
pub(super) struct Settling<'a> {
    pub solver: &'a dyn LimitSolver,
    pub problem: &'a LimitProblem,
    pub loads: &'a StageLoads,
    /// Factor of the stage's loads.
    pub factor: f64,
}

/// Adds field, displacements and residuals of the blocks due to their settlements to the result of a stage that stands.
/// Returns the hinges; if nothing is proved, the stage is stalled.
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

/// Returns the certified result of a stage in which no motion of the blocks is compatible with the motion of the supports.
fn blocked(
    input: &CaseInput,
    asked: Settling,
    ray: &[ContactForce],
    supports: &[Option<CentroidVelocity>],
    result: &mut CaseResult,
) -> Result<(), String> {
    let claim = Claim {
        hint: Status::NoEquilibrium,
        target: asked.factor,
        factor: None,
        field_factor: asked.factor,
        start: asked.factor,
        field: None,
        start_field: None,
        fill: &[],
        motion: None,
        ray: Some(ray),
        supports: Some(supports),
        feasible_interval: None,
        non_associated: None,
    };
    let Verdict { certificate, status, greatest, .. } =
        certify(input.assembly, asked.loads, &claim, input.settings.tolerance);
    if status != Status::NoEquilibrium {
        return Err(certificate.failures.join("; "));
    }
    result.status = status;
    result.greatest = greatest;
    result.certificate = certificate;
    result.proof = ProofFields { ray: Some(field_entries(ray)), ..ProofFields::default() };
    result.notes.push(
        "rigid blocks cannot follow their supports: no motion that the joints allow is compatible with the support \
             displacements, and forces would grow without bound; model deformable blocks or joints"
            .into(),
    );
    Ok(())
}

fn followed(input: &CaseInput, index: usize, asked: Settling, result: &mut CaseResult) -> Result<Vec<Hinge>, String> {
    let (assembly, problem) = (input.assembly, asked.problem);
    if problem.joints.iter().any(|joint| joint.fill.is_some()) {
        return Err(
            "settlements of rigid blocks do not support fill with resistance: remove scene.fill.resistance".into()
        );
    }
    let supports = support_motions(assembly, input.stages, index)?;
    let (field, motion, unique, flow) = match common_motion(assembly, &supports).zip(result.proof.field.as_deref()) {
        Some((motion, field)) => {
            // Joints that do not move obey any flow rule.
            let flow = if problem.non_associated { FlowRule::NonAssociated } else { FlowRule::Associated };
            (field.iter().map(contact_force).collect::<Vec<_>>(), motion, None, flow)
        }
        None => {
            let sum = |(a, b): (&[f64; 3], &[f64; 3])| std::array::from_fn(|i| a[i] + asked.factor * b[i]);
            let loads = problem.fixed.iter().zip(&problem.varying).map(sum).collect();
            let answer = asked.solver.settle(problem, &loads, &openings(assembly, problem, &supports));
            answer.check_form(problem)?;
            let (field, motion, unique, flow) = match answer {
                SettlementAnswer::Follows { field, motion, unique, flow } => (field, motion, unique, flow),
                SettlementAnswer::Blocked(ray) => {
                    return blocked(input, asked, &contact_forces(problem, &ray), &supports, result)
                        .map(|()| Vec::new());
                }
                SettlementAnswer::Refused(why) => return Err(why),
            };
            let free = body_velocities(assembly, problem, &motion);
            let all = supports.iter().zip(free).map(|(held, free)| held.unwrap_or(free)).collect();
            (contact_forces(problem, &field), all, unique, flow)
        }
    };
    let motion: Vec<CentroidVelocity> = motion;
    let claim = Claim {
        hint: Status::Stands,
        target: asked.factor,
        factor: None,
        field_factor: asked.factor,
        start: asked.factor,
        field: Some(&field),
        start_field: None,
        fill: &[],
        motion: None,
        ray: None,
        supports: None,
        feasible_interval: None,
        non_associated: None,
    };
    let Verdict { certificate, status, .. } = certify(assembly, asked.loads, &claim, input.settings.tolerance);
    if status != Status::Stands {
        return Err(certificate.failures.join("; "));
    }
    result.certificate.residuals.extend(certificate.residuals);
    for (name, value) in settlement_residuals(assembly, &field, &motion, &supports, flow) {
        result.certificate.residuals.insert(name.into(), value);
        if value.is_nan() || value > PROVED {
            return Err(format!("{name}: {value:.3e} exceeds {PROVED:.1e}"));
        }
    }
    if problem.non_associated {
        let (read, note) = match flow {
            FlowRule::Associated => (
                Some("associated".into()),
                "blocks follow their supports with associated flow: slip opens a joint by its friction angle",
            ),
            FlowRule::NonAssociated => (
                None,
                "blocks follow their supports: the state obeys equilibrium, the strengths and the laws' own flow, but it may \
                 not be unique; to find the state that the blocks reach, give the joints a stiffness and use a path solver",
            ),
        };
        result.flow_read_as = read;
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
    // Blocks that move as one body have no hinges except by rounding.
    let greatest = motion.iter().flatten().fold(0.0, |a: f64, v| a.max(v.abs()));
    if largest_jump(&jumps(assembly, &motion)) <= RIGID * greatest {
        return Ok(Vec::new());
    }
    let found = mechanism(assembly, &motion, unique, flow);
    Ok(found.map_or_else(Vec::new, |found| found.hinges))
}
