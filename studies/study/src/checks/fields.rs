//! Reads stored forces and motions, and checks that they fit the scene and contain finite numbers.

use crate::results::path_state::motion_of_body;
use crate::results::{CaseResult, FieldEntry, FillEntry, MotionEntry};
use voussoir_core::certificate::{CentroidVelocity, ContactForce};
use voussoir_core::model::Assembly;
use voussoir_core::model::geometry::{Vec2, distance_to_segment};
use voussoir_core::path::PathProblem;

/// Relative difference up to which recomputed numbers count as equal.
pub const EQUAL: f64 = 1e-9;

/// Returns true if two numbers are equal except for rounding; NaN is equal to nothing.
pub fn close(a: f64, b: f64) -> bool {
    a == b || (a - b).abs() <= EQUAL * a.abs().max(b.abs())
}

/// Returns the contact forces of a stored field, or the reason why it is not valid.
pub fn contacts(assembly: &Assembly, field: &[FieldEntry]) -> Result<Vec<ContactForce>, String> {
    let size = assembly.size();
    field
        .iter()
        .map(|entry| {
            let joint = assembly.joints.get(entry.joint).ok_or(format!("field: there is no joint {}", entry.joint))?;
            let point = Vec2::from(entry.point);
            // The comparison is false for NaN.
            let on_joint = distance_to_segment(point, joint.ends[0], joint.ends[1]) <= EQUAL * size;
            if !on_joint || !entry.force.iter().all(|f| f.is_finite()) {
                return Err(format!("field: a force of joint {} does not act on that joint", entry.joint));
            }
            Ok(ContactForce { joint: entry.joint, point, force: entry.force })
        })
        .collect()
}

/// Returns the forces of a stored field and of its fill at the contact points of a path's problem, in their order.
pub fn path_forces(
    assembly: &Assembly,
    problem: &PathProblem,
    entries: &[FieldEntry],
    fill: &[FillEntry],
) -> Result<Vec<[f64; 2]>, String> {
    let forces = contacts(assembly, entries)?;
    let (joints, beside): (Vec<_>, Vec<_>) = problem.contacts.iter().partition(|c| c.joint < assembly.joints.len());
    let same = forces.len() == joints.len()
        && forces
            .iter()
            .zip(joints)
            .all(|(f, c)| f.joint == c.joint && (f.point - c.position).norm() <= 1e-9 * problem.length);
    if !same {
        return Err("field: there must be one force for each contact point of the study, in its order".into());
    }
    // Contact points of the fill are last. A field that balances the live load alone has no forces of the fill.
    let pressed = beside.iter().map(|c| {
        let entry = fill.get(c.joint - assembly.joints.len());
        [entry.map_or(0.0, |entry| entry.force - entry.bounds[0]), 0.0]
    });
    Ok(forces.iter().map(|f| f.force).chain(pressed).collect())
}

/// Rigid motions of a path's bodies from the stored displacements of the blocks.
pub fn path_motion(
    assembly: &Assembly,
    problem: &PathProblem,
    result: &CaseResult,
    finite: bool,
) -> Result<Vec<[f64; 3]>, String> {
    let displaced = result.path.displacements.as_ref().ok_or("displacements is missing")?;
    if displaced.len() != assembly.bodies.len() {
        return Err("displacements: there must be one entry for each block".into());
    }
    let mut motion = vec![[0.0; 3]; problem.bodies.len()];
    for (block, entry) in displaced.iter().enumerate() {
        let name = &assembly.bodies[block].name;
        if entry.body != *name {
            return Err(format!(
                "displacements: entry {block} belongs to \"{}\", but this block is called \"{name}\"",
                entry.body
            ));
        }
        motion[problem.body_of[block]] = motion_of_body(assembly, problem, block, entry.displacement, finite);
    }
    Ok(motion)
}

/// Returns the velocities of a stored motion, one for each body, or the reason why it is not valid.
pub fn velocities(assembly: &Assembly, motion: &[MotionEntry]) -> Result<Vec<CentroidVelocity>, String> {
    if motion.len() != assembly.bodies.len() {
        return Err("motion: there must be one velocity for each block".into());
    }
    assembly
        .bodies
        .iter()
        .zip(motion)
        .map(|(body, entry)| {
            let fine = body.name == entry.body && entry.velocity.iter().all(|v| v.is_finite());
            fine.then_some(entry.velocity).ok_or(format!(
                "motion: the entry of \"{}\" is not finite or has the name \"{}\"",
                body.name, entry.body
            ))
        })
        .collect()
}
