//! Forces and motions as they are written.

use super::entries::{FieldEntry, MotionEntry};
use voussoir_core::certificate::{CentroidVelocity, ContactForce};
use voussoir_core::model::Assembly;

/// Contact forces as they are written.
pub fn field_entries(forces: &[ContactForce]) -> Vec<FieldEntry> {
    forces.iter().map(|c| FieldEntry { joint: c.joint, point: c.point.into(), force: c.force }).collect()
}

/// A contact force from its entry.
pub fn contact_force(entry: &FieldEntry) -> ContactForce {
    ContactForce { joint: entry.joint, point: entry.point.into(), force: entry.force }
}

/// Velocities of all bodies as they are written.
pub fn motion_entries(assembly: &Assembly, motion: Vec<CentroidVelocity>) -> Vec<MotionEntry> {
    let name = |body: usize| assembly.bodies[body].name.clone();
    motion.into_iter().enumerate().map(|(body, velocity)| MotionEntry { body: name(body), velocity }).collect()
}
