//! Blocks and joints that every solver can read.

use super::findings::Recorder;
use std::collections::BTreeSet;
use voussoir_core::model::geometry::{Vec2, area_and_centroid};
use voussoir_core::model::{Assembly, Bond, Joint, crosses_itself};

/// Checks the blocks and joints of an assembly.
pub(super) fn check(recorder: &mut Recorder, assembly: &Assembly) {
    let wrong = mistake(assembly);
    recorder.hold("geometry", wrong.is_none(), || wrong.unwrap_or_default());
}

/// Returns the first mistake in an assembly.
fn mistake(assembly: &Assembly) -> Option<String> {
    let width = assembly.width;
    if !(width.is_finite() && width > 0.0) {
        return Some(format!("its width is {width}"));
    }
    if assembly.bodies.is_empty() {
        return Some("it has no blocks".into());
    }
    let names: BTreeSet<&str> = assembly.bodies.iter().map(|body| body.name.as_str()).collect();
    if names.len() < assembly.bodies.len() {
        return Some("two blocks have the same name".into());
    }
    let blocks = (0..assembly.bodies.len()).find_map(|body| mistake_in_block(assembly, body));
    blocks.or_else(|| {
        assembly
            .joints
            .iter()
            .enumerate()
            .find_map(|(index, joint)| Some(format!("joint {index} {}", mistake_in_joint(assembly, joint)?)))
    })
}

fn mistake_in_block(assembly: &Assembly, index: usize) -> Option<String> {
    let body = &assembly.bodies[index];
    let of = |what: &str| Some(format!("block \"{}\" {what}", body.name));
    if body.material >= assembly.catalogue.materials.len() {
        return of("has a material that is not in the catalogue");
    }
    if body.vertices.is_empty() {
        return if body.fixed { None } else { of("has no shape and is not fixed") };
    }
    if !body.vertices.iter().all(finite) {
        return of("has a corner that is not finite");
    }
    if area_and_centroid(&body.vertices).0 <= 0.0 {
        return of("has corners in clockwise order, or no area");
    }
    if crosses_itself(&body.vertices) { of("has edges that cross") } else { None }
}

fn mistake_in_joint(assembly: &Assembly, joint: &Joint) -> Option<&'static str> {
    let known = |body: usize| body < assembly.bodies.len();
    if !known(joint.minus) || !known(joint.plus) || joint.minus == joint.plus {
        return Some("does not join two blocks");
    }
    if matches!(joint.bond, Bond::Law(law) if law >= assembly.catalogue.laws.len()) {
        return Some("has a law that is not in the catalogue");
    }
    if !joint.ends.iter().all(finite) || joint.height() <= 0.0 {
        return Some("has no height, or ends that are not finite");
    }
    // The plus block is on the side of the normal.
    let (normal, _) = joint.frame();
    let beyond = |body: usize| {
        let corners = &assembly.bodies[body].vertices;
        (!corners.is_empty()).then(|| (area_and_centroid(corners).1 - joint.middle()).dot(&normal))
    };
    if beyond(joint.plus).is_some_and(|side| side <= 0.0) && beyond(joint.minus).is_some_and(|side| side >= 0.0) {
        return Some("has a normal that points into its minus block");
    }
    None
}

fn finite(point: &Vec2) -> bool {
    point.iter().all(|x| x.is_finite())
}
