//! The answer of a limit solver in the form of a result, with its certificate.

use super::case_input::CaseInput;
use super::ours::is_ours;
use crate::results::convert::{field_entries, motion_entries};
use crate::results::thrust_line::thrust_line;
use crate::results::{CaseResult, NonAssociatedAnswer, ProofFields};
use crate::solve::load_entries::fill_entries;
use voussoir_core::certificate::{
    CentroidVelocity, Claim, ContactForce, NonAssociatedClaim, Verdict, certify, jumps, mechanism, motion_size,
};
use voussoir_core::law::FlowRule;
use voussoir_core::limit::{JointForce, LimitAnswer, LimitProblem, LimitQuestion, Status, Velocity};
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::model::{Assembly, Stage, StageLoads, Target};

/// Returns the certified result of one stage, and true if a field of the answer carries the loads at the start of the stage.
pub(super) fn certified(
    input: &CaseInput,
    stage: &Stage,
    (problem, loads): (&LimitProblem, &StageLoads),
    asked: LimitQuestion,
    (tag, mut solved): (&str, LimitAnswer),
) -> (CaseResult, bool) {
    // The certificate checks only the end of the interval that is nearer to the start; the other end depends on the solver.
    solved.feasible_interval = solved.feasible_interval.filter(|_| is_ours(tag));
    let assembly = input.assembly;
    let field = solved.field.as_ref().map(|forces| contact_forces(problem, forces));
    let ray = solved.ray.as_ref().map(|forces| contact_forces(problem, forces));
    let forces = solved.field.as_deref().unwrap_or_default();
    let fill = problem.fill_forces(forces, &loads.fill_bounds);
    let motion = scaled_motion(assembly, problem, &solved);
    let own = solved.non_associated.as_ref();
    let associated_motion =
        own.and_then(|own| own.associated_motion.as_ref()).map(|motion| body_velocities(assembly, problem, motion));
    let reading = if own.is_some() { FlowRule::NonAssociated } else { FlowRule::Associated };
    let (start, max) = match asked {
        LimitQuestion::Admissible(factor) => (factor, factor),
        LimitQuestion::Collapse { start, max } => (start, max),
    };
    let beside =
        |forces: &Vec<JointForce>| (contact_forces(problem, forces), problem.fill_forces(forces, &loads.fill_bounds));
    let associated_field = own.and_then(|own| own.associated_field.as_ref()).map(beside);
    let start_field = solved.start_field.as_ref().map(beside);
    let claim = Claim {
        hint: solved.status,
        target: max,
        factor: solved.factor,
        field_factor: solved.field_factor,
        start,
        field: field.as_deref(),
        start_field: start_field.as_ref().map(|(field, fill)| (&field[..], &fill[..])),
        fill: &fill,
        motion: motion.as_deref(),
        ray: ray.as_deref(),
        supports: None,
        feasible_interval: solved.feasible_interval,
        non_associated: own.map(|own| NonAssociatedClaim {
            proved_lower: own.proved_lower,
            lower_proof: own.lower_proof.as_ref(),
            search_is_trusted: is_ours(tag),
            associated_factor: own.associated_factor,
            associated_motion: associated_motion.as_deref(),
            associated_field: associated_field.as_ref().map(|(field, fill)| (&field[..], &fill[..])),
        }),
    };
    let Verdict { certificate, status, bounds, greatest, start_is_carried } =
        certify(assembly, loads, &claim, input.settings.tolerance);
    // The result contains only evidence of the proved status.
    let shows = |statuses: &[Status]| statuses.contains(&status);
    let believed = certificate.passed || is_ours(tag);
    let field = field.filter(|_| shows(&[Status::Stands, Status::Collapse, Status::Unbounded, Status::Open]));
    let field = field.filter(|_| believed || bounds[0] == Some(solved.field_factor));
    let motion = motion.filter(|_| shows(&[Status::Collapse, Status::NoEquilibrium, Status::Open]));
    let ray = ray.filter(|_| shows(&[Status::Unbounded]));
    let finite = |x: f64| x.is_finite().then_some(x);
    let mut notes = solved.notes;
    if status == Status::Stands && stage.target == Target::Collapse {
        notes.push(format!("no collapse up to factor_max = {}", stage.factor_max));
    }
    let [lower, upper] = bounds;
    let found = solved.factor.filter(|factor| own.is_some() && upper == Some(*factor) && believed);
    // No check proves that a mechanism is unique.
    let unique = solved.unique.filter(|unique| !unique || is_ours(tag));
    let result = CaseResult {
        status,
        load_factor: match status {
            Status::Collapse => solved.factor.or(lower),
            Status::Open => lower.or(found),
            _ => None,
        },
        bounds: (bounds != [None; 2]).then_some(bounds),
        greatest,
        flow_read_as: (problem.non_associated && own.is_none()).then(|| "associated".into()),
        feasible_interval: solved
            .feasible_interval
            .filter(|_| status == Status::NoEquilibrium)
            .map(|ends| ends.map(finite)),
        mechanism: motion.as_ref().and_then(|motion| mechanism(assembly, motion, unique, reading)),
        proof: ProofFields {
            field_factor: field.is_some().then_some(solved.field_factor),
            thrust_line: field.as_ref().and_then(|field| thrust_line(assembly, field)),
            fill: if field.is_some() { fill_entries(assembly, &fill, &loads.fill_bounds) } else { Vec::new() },
            field: field.as_deref().map(field_entries),
            ray: ray.as_deref().map(field_entries),
            motion: motion.map(|motion| motion_entries(assembly, motion)),
            associated_motion: associated_motion.map(|motion| motion_entries(assembly, motion)),
            space: None,
        },
        non_associated: NonAssociatedAnswer {
            associated_load_factor: own.and_then(|own| own.associated_factor).filter(|_| believed),
            bracket: own.map(|own| own.bracket.clone()).unwrap_or_default(),
            lower_proof: solved.non_associated.and_then(|own| own.lower_proof),
        },
        certificate,
        counters: solved.counters,
        notes,
        ..CaseResult::empty()
    };
    (result, start_is_carried)
}

/// Returns the velocities of all bodies; velocities that refute equilibrium without a factor are scaled to a greatest jump
/// of 1.
fn scaled_motion(assembly: &Assembly, problem: &LimitProblem, solved: &LimitAnswer) -> Option<Vec<CentroidVelocity>> {
    let mut motion = body_velocities(assembly, problem, solved.motion.as_ref()?);
    if (solved.status, solved.feasible_interval) == (Status::NoEquilibrium, None) {
        let largest = motion_size(&jumps(assembly, &motion), &motion);
        motion.iter_mut().flatten().for_each(|v| *v /= largest);
    }
    Some(motion)
}

/// Returns the forces at the two ends of every joint. Shear is divided in proportion to the normal forces, so that the force
/// at each end is in the cone of dry friction if the sum is.
pub(super) fn contact_forces(problem: &LimitProblem, forces: &[JointForce]) -> Vec<ContactForce> {
    let mut contacts = Vec::with_capacity(2 * forces.len());
    for (joint, force) in problem.joints.iter().zip(forces).filter(|(joint, _)| joint.fill.is_none()) {
        let sum = force.normal[0] + force.normal[1];
        let share = |end: usize| {
            if force.normal[0] >= 0.0 && force.normal[1] >= 0.0 && sum > 0.0 { force.normal[end] / sum } else { 0.5 }
        };
        let shears = [force.shear * share(0), force.shear - force.shear * share(0)];
        for (end, shear) in shears.into_iter().enumerate() {
            let force = [force.normal[end], shear];
            contacts.push(ContactForce { joint: joint.joint, point: joint.ends[end], force });
        }
    }
    contacts
}

/// Returns the velocity of every block at its centroid.
pub(super) fn body_velocities(
    assembly: &Assembly,
    problem: &LimitProblem,
    motion: &[Velocity],
) -> Vec<CentroidVelocity> {
    let velocity = |body: usize| match problem.group_of[body] {
        None => [0.0; 3],
        Some(group) => {
            let [x, y, omega] = motion[group];
            let v = Vec2::new(x, y) + turned(assembly.inertia(body).centroid - problem.pole) * omega;
            [v.x, v.y, omega]
        }
    };
    (0..assembly.bodies.len()).map(velocity).collect()
}
