//! Entries for the loads of a bridge by block, for checks by hand.

use crate::results::{FillEntry, LoadEntry, LoadOrigin};
use crate::study::Case;
use voussoir_core::model::geometry::{Vec2, cross};
use voussoir_core::model::{Assembly, FillReaction, PointForce, Stage, fill_bounds, fill_weights};
use voussoir_core::path::{PathProblem, fill_gravity};

/// Returns the weights of blocks and fill under the gravity of each stage that sets it, and the loads of each stage at
/// factor 1. Empty for scenes other than bridges; brief cases have no weights.
pub fn load_entries(case: &Case) -> Vec<LoadEntry> {
    let (assembly, stages) = (&case.assembly, &case.stages);
    let mut entries = Vec::new();
    if assembly.bridge.is_none() {
        return entries;
    }
    for stage in stages {
        if let Some(gravity) = stage.gravity.filter(|_| !case.brief) {
            let weights = (0..assembly.bodies.len()).filter(|body| !assembly.bodies[*body].fixed).map(|body| {
                let inertia = assembly.inertia(body);
                PointForce { body, point: inertia.centroid, force: gravity * inertia.mass }
            });
            gather(assembly, stage, LoadOrigin::Weight, &weights.collect::<Vec<_>>(), &mut entries);
            gather(assembly, stage, LoadOrigin::Fill, &fill_weights(assembly, gravity), &mut entries);
        }
        gather(assembly, stage, LoadOrigin::Load, &stage.forces, &mut entries);
    }
    entries
}

/// Adds forces by block: parallel forces as their resultant at its centre, others one by one.
fn gather(assembly: &Assembly, stage: &Stage, what: LoadOrigin, forces: &[PointForce], entries: &mut Vec<LoadEntry>) {
    let entry = |body: usize, resultant: Vec2, point: Vec2| LoadEntry {
        stage: stage.name.clone(),
        what,
        block: assembly.bodies[body].name.clone(),
        resultant: resultant.into(),
        point: point.into(),
    };
    for body in 0..assembly.bodies.len() {
        let own: Vec<_> = forces.iter().filter(|f| f.body == body && f.force != Vec2::zeros()).collect();
        let Some(first) = own.first() else { continue };
        let parallel = own.iter().all(|f| cross(first.force, f.force) == 0.0 && first.force.dot(&f.force) > 0.0);
        if !parallel || own.len() == 1 {
            entries.extend(own.iter().map(|f| entry(body, f.force, f.point)));
            continue;
        }
        let resultant: Vec2 = own.iter().map(|f| f.force).sum();
        let point = own.iter().map(|f| f.point * f.force.norm()).sum::<Vec2>() / resultant.norm();
        entries.push(entry(body, resultant, point));
    }
}

/// Converts forces of the fill to entries, with their bounds under a stage's gravity.
pub fn fill_entries(assembly: &Assembly, forces: &[f64], bounds: &[[f64; 2]]) -> Vec<FillEntry> {
    let reactions = assembly.fill_reactions().iter().zip(forces).zip(bounds);
    let entry = |((reaction, force), bounds): ((&FillReaction, &f64), &[f64; 2])| FillEntry {
        block: assembly.bodies[reaction.body].name.clone(),
        point: reaction.point.into(),
        direction: reaction.direction.into(),
        force: *force,
        bounds: *bounds,
    };
    reactions.map(entry).collect()
}

/// Returns the forces of the fill at the contact points of a path.
pub fn path_fill(assembly: &Assembly, problem: &PathProblem, stages: &[Stage], forces: &[[f64; 2]]) -> Vec<FillEntry> {
    let bounds = fill_bounds(assembly, fill_gravity(stages).unwrap_or_default());
    let mut fill: Vec<f64> = bounds.iter().map(|bounds| bounds[0]).collect();
    for (contact, force) in problem.contacts.iter().zip(forces) {
        if let Some(index) = contact.joint.checked_sub(assembly.joints.len()) {
            fill[index] += force[0];
        }
    }
    fill_entries(assembly, &fill, &bounds)
}
