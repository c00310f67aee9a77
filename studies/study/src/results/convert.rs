//! Converts forces and motions to entries of results, and back.

use super::entries::{FieldEntry, MotionEntry};
use voussoir_core::certificate::{CentroidVelocity, ContactForce};
use voussoir_core::model::Assembly;

/// Converts contact forces to entries.
pub fn field_entries(forces: &[ContactForce]) -> Vec<FieldEntry> {
    forces.iter().map(|c| FieldEntry { joint: c.joint, point: c.point.into(), force: c.force }).collect()
}

/// Converts an entry to a contact force.
pub fn contact_force(entry: &FieldEntry) -> ContactForce {
    ContactForce { joint: entry.joint, point: entry.point.into(), force: entry.force }
}

/// Converts the velocities of all bodies to entries.
pub fn motion_entries(assembly: &Assembly, motion: Vec<CentroidVelocity>) -> Vec<MotionEntry> {
    let name = |body: usize| assembly.bodies[body].name.clone();
    motion.into_iter().enumerate().map(|(body, velocity)| MotionEntry { body: name(body), velocity }).collect()
}
