//! Forces and motions in space as they are stored, and as the problem has them.

use crate::results::{SpaceFieldEntry, SpaceMotionEntry, SpaceProof};
use crate::study::SpaceCase;
use voussoir_core::certificate::{Mechanism, space_mechanism};
use voussoir_core::law::FlowRule;
use voussoir_core::space::{
    SpaceAssembly, SpaceBody, SpaceContact, SpaceField, SpaceProblem, SpaceVelocity, Vec3, velocity_at,
};

/// Least relative distance of the bounds of a collapse that a study can ask for. In space bounds come from an interior-point
/// method, whose last digits are lost where many mechanisms have nearly the same factor.
const GAP: f64 = 1e-8;

/// Returns the greatest relative distance of the bounds of a collapse, from the tolerance of the study.
pub(crate) fn gap_in_space(tolerance: f64) -> f64 {
    tolerance.max(GAP)
}

/// Converts forces to entries, one for each point of each contact of the problem.
pub(crate) fn field_entries(problem: &SpaceProblem, field: &SpaceField) -> Vec<SpaceFieldEntry> {
    let of_contact = |(contact, forces): (&SpaceContact, &Vec<[f64; 3]>)| {
        let entry = |(point, force): (&Vec3, &[f64; 3])| SpaceFieldEntry {
            joint: contact.contact,
            point: (point + problem.pole).into(),
            force: *force,
        };
        contact.inner.points.iter().zip(forces).map(entry).collect::<Vec<_>>()
    };
    problem.contacts.iter().zip(field).flat_map(of_contact).collect()
}

/// Converts velocities about the pole to entries at the centroids of all bodies.
pub(crate) fn motion_entries(
    space: &SpaceCase,
    problem: &SpaceProblem,
    motion: &[SpaceVelocity],
) -> Vec<SpaceMotionEntry> {
    let all: Vec<_> = problem.free.iter().map(|free| free.map_or([0.0; 6], |free| motion[free])).collect();
    entries_of_all(space, problem, &all)
}

/// Converts motions of all bodies, also those that the ground holds.
pub(crate) fn entries_of_all(
    space: &SpaceCase,
    problem: &SpaceProblem,
    motion: &[SpaceVelocity],
) -> Vec<SpaceMotionEntry> {
    let entry = |(index, body): (usize, &SpaceBody)| {
        let velocity = motion[index];
        let velocity = moved_pole(&velocity, &(space.assembly.centroid(index) - problem.pole));
        SpaceMotionEntry { body: body.name.clone(), velocity }
    };
    space.assembly.bodies.iter().enumerate().map(entry).collect()
}

/// Returns the same motion about a pole at an arm from the present one.
fn moved_pole(velocity: &SpaceVelocity, arm: &Vec3) -> SpaceVelocity {
    let v = velocity_at(velocity, arm);
    [v.x, v.y, v.z, velocity[3], velocity[4], velocity[5]]
}

/// Stored forces and velocities in the form of the problem.
pub(crate) struct StoredInSpace {
    pub field: Option<SpaceField>,
    /// Motions of the free bodies.
    pub motion: Option<Vec<SpaceVelocity>>,
    /// Motions of all bodies.
    pub of_all: Option<Vec<SpaceVelocity>>,
    pub associated_motion: Option<Vec<SpaceVelocity>>,
    pub ray: Option<SpaceField>,
}

impl StoredInSpace {
    /// Reads the entries of a result. An error names the first entry that is not at a point of its contact.
    pub(crate) fn read(space: &SpaceCase, problem: &SpaceProblem, proof: &SpaceProof) -> Result<Self, String> {
        let forces = |what: &str, entries: &Option<Vec<SpaceFieldEntry>>| {
            entries.as_ref().map(|entries| read_field(problem, what, entries)).transpose()
        };
        let all = |entries: &Option<Vec<SpaceMotionEntry>>| {
            entries.as_ref().map(|entries| read_motion(space, problem, entries))
        };
        let (of_all, associated) = (all(&proof.motion), all(&proof.associated_motion));
        let free = |all: &Vec<SpaceVelocity>| of_free(problem, all);
        let (motion, associated_motion) = (of_all.as_ref().map(free), associated.as_ref().map(free));
        Ok(StoredInSpace {
            field: forces("field", &proof.field)?,
            motion,
            of_all,
            associated_motion,
            ray: forces("ray", &proof.ray)?,
        })
    }
}

/// Selects the motions of the free bodies from a list for all bodies.
fn of_free(problem: &SpaceProblem, all: &[SpaceVelocity]) -> Vec<SpaceVelocity> {
    let kept = all.iter().zip(&problem.free).filter(|(_, free)| free.is_some());
    kept.map(|(own, _)| *own).collect()
}

/// Returns the mechanism of stored velocities, so that solving and verifying read the same numbers.
pub(crate) fn stored_mechanism(
    space: &SpaceCase,
    problem: &SpaceProblem,
    motion: &[SpaceMotionEntry],
    (unique, flow): (Option<bool>, FlowRule),
) -> Option<Mechanism> {
    let SpaceAssembly { bodies, contacts, .. } = &space.assembly;
    let names =
        |contact: usize| [contacts[contact].minus, contacts[contact].plus].map(|body| bodies[body].name.clone());
    let motion = of_free(problem, &read_motion(space, problem, motion));
    space_mechanism(problem, &names, &motion, unique, flow)
}

/// Greatest distance of a stored point from its contact point, as a share of the scene's size.
const SAME_POINT: f64 = 1e-9;

fn read_field(problem: &SpaceProblem, what: &str, entries: &[SpaceFieldEntry]) -> Result<SpaceField, String> {
    let mut rest = entries.iter();
    let mut field = Vec::with_capacity(problem.contacts.len());
    for contact in &problem.contacts {
        let mut forces = Vec::new();
        for point in &contact.inner.points {
            let there = |entry: &&SpaceFieldEntry| {
                let apart = (Vec3::from(entry.point) - problem.pole - point).norm();
                entry.joint == contact.contact && apart <= SAME_POINT * problem.length
            };
            let entry = rest.next().filter(there);
            let missing = || format!("{what}: the entries are not the points of the contacts in their order");
            forces.push(entry.ok_or_else(missing)?.force);
        }
        field.push(forces);
    }
    match rest.next() {
        None => Ok(field),
        Some(_) => Err(format!("{what}: there are more entries than points of contacts")),
    }
}

fn read_motion(space: &SpaceCase, problem: &SpaceProblem, entries: &[SpaceMotionEntry]) -> Vec<SpaceVelocity> {
    let about_pole = |(index, entry): (usize, &SpaceMotionEntry)| {
        moved_pole(&entry.velocity, &(problem.pole - space.assembly.centroid(index)))
    };
    entries.iter().enumerate().map(about_pole).collect()
}
