//! Scenes in space: sound blocks and contacts, the same each time, independently of units and of the order of laws.

use super::findings::Recorder;
use std::collections::BTreeSet;
use voussoir_core::model::Catalogue;
use voussoir_core::space::{Contact, SpaceAssembly, SpaceFill, Vec3};

/// Greatest error of coordinates and unit vectors, as a share of the size of the scene.
const SAME: f64 = 1e-9;

/// Checks the blocks and contacts of an assembly in space.
pub(super) fn check(recorder: &mut Recorder, assembly: &SpaceAssembly) {
    let wrong = mistake(assembly);
    recorder.hold("geometry", wrong.is_none(), || wrong.unwrap_or_default());
}

/// Returns the first mistake in an assembly.
fn mistake(assembly: &SpaceAssembly) -> Option<String> {
    let names: BTreeSet<&str> = assembly.bodies.iter().map(|body| body.name.as_str()).collect();
    if assembly.bodies.is_empty() {
        return Some("it has no blocks".into());
    }
    if names.len() < assembly.bodies.len() {
        return Some("two blocks have the same name".into());
    }
    for body in &assembly.bodies {
        let of = |what: &str| Some(format!("block \"{}\" {what}", body.name));
        if body.material >= assembly.catalogue.materials.len() {
            return of("has a material that is not in the catalogue");
        }
        if !body.shape.vertices.iter().flatten().all(|x| x.is_finite()) {
            return of("has a corner that is not finite");
        }
        let fits = |corner: &usize| *corner < body.shape.vertices.len();
        if !body.shape.faces.iter().all(|face| face.len() > 2 && face.iter().all(fits)) {
            return of("has a face without three corners");
        }
        if body.shape.volume_and_centroid().0 <= 0.0 {
            return of("has no volume, or faces that point inwards");
        }
    }
    let carries = |fill: &SpaceFill| fill.body < assembly.bodies.len() && fill.mass >= 0.0 && fill.mass.is_finite();
    if !assembly.fill.iter().all(carries) {
        return Some("some fill is on no block, or has no mass".into());
    }
    let contacts = assembly.contacts.iter().enumerate();
    contacts
        .into_iter()
        .find_map(|(index, contact)| Some(format!("contact {index} {}", mistake_in_contact(assembly, contact)?)))
}

fn mistake_in_contact(assembly: &SpaceAssembly, contact: &Contact) -> Option<&'static str> {
    let Contact { minus, plus, points, normal, tangents: [s, t], law } = contact;
    if minus == plus || [minus, plus].iter().any(|body| **body >= assembly.bodies.len()) {
        return Some("does not join two blocks");
    }
    if assembly.bodies[*minus].fixed && assembly.bodies[*plus].fixed {
        return Some("joins two supports");
    }
    if *law >= assembly.catalogue.laws.len() {
        return Some("has a law that is not in the catalogue");
    }
    let frame = [normal.norm() - 1.0, s.norm() - 1.0, normal.dot(s), (normal.cross(s) - t).norm()];
    if frame.iter().any(|error| error.abs() > SAME || error.is_nan()) {
        return Some("has a frame (n, s, t) that is not orthonormal and right-handed");
    }
    let (low, high) = assembly.bounding_box();
    let size = (high - low).norm();
    if points.len() < 3 || points.iter().any(|point| (point - points[0]).dot(normal).abs() > SAME * size) {
        return Some("is not a plane polygon");
    }
    let area: Vec3 = (1..points.len() - 1).map(|k| (points[k] - points[0]).cross(&(points[k + 1] - points[0]))).sum();
    let convex = (0..points.len()).all(|k| {
        let [a, b, c] = [0, 1, 2].map(|next| points[(k + next) % points.len()]);
        (b - a).cross(&(c - b)).dot(normal) >= -SAME * size * size
    });
    (area.dot(normal) <= 0.0 || !convex).then_some("is not a convex polygon anticlockwise about its normal")
}

/// Returns all data of blocks and contacts in words, with materials and laws by name.
pub(super) fn described(assembly: &SpaceAssembly) -> Vec<String> {
    let Catalogue { materials, laws } = &assembly.catalogue;
    let bodies = assembly.bodies.iter().map(|body| {
        let material = materials.get(body.material).map(|(name, _)| name);
        format!("{} {:?} {material:?} {}", body.name, body.shape, body.fixed)
    });
    let contacts = assembly.contacts.iter().map(|contact| {
        let law = laws.get(contact.law).map(|(name, _)| name);
        format!("{} {} {:?} {:?} {law:?}", contact.minus, contact.plus, contact.points, contact.normal)
    });
    let fill = assembly.fill.iter().map(|fill| format!("{} {:?} {:?}", fill.body, fill.point, fill.mass));
    bodies.chain(contacts).chain(fill).collect()
}

/// Returns all lengths of an assembly, in a fixed order \[m\].
pub(super) fn lengths(assembly: &SpaceAssembly) -> Vec<f64> {
    let corners = assembly.bodies.iter().flat_map(|body| &body.shape.vertices);
    let points = assembly.contacts.iter().flat_map(|contact| &contact.points);
    let fill = assembly.fill.iter().map(|fill| &fill.point);
    corners.chain(points).chain(fill).flatten().copied().collect()
}
