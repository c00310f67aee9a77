//! The proof of a motion of rigid blocks that follow moving supports. The supports have their prescribed motion, joints
//! move along the flow of their laws, and the work of the field on every joint equals the dissipation. With associated
//! flow and an admissible field no motion has less potential energy (weak duality). With the laws' own flow this is one
//! state of possibly several.

use super::limit::{ContactForce, idle_power, largest_jump, support_integral};
use super::mechanism::{CentroidVelocity, Jump, jumps};
use crate::law::{Facet, FlowRule, YieldPolygon};
use crate::model::geometry::{Vec2, turned};
use crate::model::{Assembly, Bond, Joint, Stage, Target};

/// Returns the motion of every held block at its centroid at the end of stage `index`; `None` for free blocks.
///
/// # Errors
///
/// Names the blocks that are bonded to supports that move apart.
pub fn support_motions(
    assembly: &Assembly,
    stages: &[Stage],
    index: usize,
) -> Result<Vec<Option<CentroidVelocity>>, String> {
    let groups = assembly.rigid_groups().0;
    // Rigid motion about the origin.
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
    // A block bonded to a support is part of it.
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

/// Returns the residuals by name. `settlement_supports` is the distance of held blocks from their prescribed motion,
/// relative to the greatest displacement. `settlement_flow` is the greatest jump that is not a flow, relative to the
/// greatest jump or a millionth of the greatest displacement. `settlement_gap` is the work of the field on all joints
/// that is not dissipated, relative to the sum of |force| × greatest jump. `supports` is the motion of every held
/// block, `None` for free blocks. With the laws' own flow jumps are combinations of flow directions, and the gap is the
/// power of the flow on the distance of the field from the yield surface.
pub fn settlement_residuals(
    assembly: &Assembly,
    field: &[ContactForce],
    motion: &[CentroidVelocity],
    supports: &[Option<CentroidVelocity>],
    flow: FlowRule,
) -> [(&'static str, f64); 3] {
    let size = |v: &CentroidVelocity| v[0].hypot(v[1]).max(v[2].abs() * assembly.size());
    let greatest = motion.iter().map(size).fold(f64::MIN_POSITIVE, f64::max);
    let held = motion.iter().zip(supports).filter_map(|(v, own)| own.map(|own| [0, 1, 2].map(|i| v[i] - own[i])));
    let off = held.map(|v| size(&v)).fold(0.0, f64::max) / greatest;
    let jumps = jumps(assembly, motion);
    let largest = largest_jump(&jumps).max(1e-6 * greatest);
    let facets: Vec<Vec<Facet>> =
        assembly.catalogue.laws.iter().map(|(_, law)| law.facets().unwrap_or_default()).collect();
    let polygons: Vec<YieldPolygon> = facets.iter().map(|facets| YieldPolygon::of(facets)).collect();
    // Supports may overlap each other: their joint is part of the ground.
    let counts =
        |joint: &Joint| joint.bond == Bond::Bonded || supports[joint.minus].is_none() || supports[joint.plus].is_none();
    let (impossible, gap) = match flow {
        FlowRule::Associated => undissipated(assembly, &polygons, field, &jumps, counts),
        FlowRule::NonAssociated => idle_power(assembly, (&facets, &polygons), field, (&jumps, largest), counts),
    };
    let forces: f64 = field.iter().map(|contact| contact.force[0].hypot(contact.force[1])).sum();
    [
        ("settlement_supports", off),
        ("settlement_flow", impossible / largest),
        ("settlement_gap", gap / (forces * largest).max(f64::MIN_POSITIVE)),
    ]
}

/// Returns the greatest jump that is not an associated flow, and the work of the field on the joints that is not
/// dissipated.
fn undissipated(
    assembly: &Assembly,
    polygons: &[YieldPolygon],
    field: &[ContactForce],
    jumps: &[Jump],
    counts: impl Fn(&Joint) -> bool,
) -> (f64, f64) {
    let mut work: Vec<f64> = vec![0.0; jumps.len()];
    for contact in field {
        let (joint, jump) = (&assembly.joints[contact.joint], &jumps[contact.joint]);
        let along = joint.ends[1] - joint.ends[0];
        let share = (contact.point - joint.ends[0]).dot(&along) / along.norm_squared();
        let open = jump.open[0] + share * (jump.open[1] - jump.open[0]);
        work[contact.joint] += contact.force[0] * open + contact.force[1] * jump.slip;
    }
    let (mut impossible, mut gap) = (0.0f64, 0.0);
    for ((joint, jump), work) in assembly.joints.iter().zip(jumps).zip(&work).filter(|((joint, _), _)| counts(joint)) {
        let Bond::Law(law) = joint.bond else {
            impossible = impossible.max(jump.size());
            continue;
        };
        let polygon = &polygons[law];
        for open in jump.open {
            impossible = impossible.max(polygon.impossible([open, jump.slip]));
        }
        let dissipated = support_integral(&polygon.vertices, jump) * joint.height() * assembly.width;
        gap += (work + dissipated).abs();
    }
    (impossible, gap)
}
