//! Blocks of a scene that overlap.

use voussoir_core::model::geometry::bounding_box;
use voussoir_core::model::{Body, Bond, Gap, find_joints};
use voussoir_core::plugin::Diagnostic;

/// Reports blocks that overlap, with the key of their table.
pub(super) fn overlap(bodies: &[Body], key: &str) -> Option<Diagnostic> {
    let (low, high) = bounding_box(bodies.iter().flat_map(|body| &body.vertices));
    let (_, overlaps) = find_joints(bodies, (high - low).norm(), |_, _| (Bond::Bonded, Gap::default()));
    let worst = overlaps.into_iter().max_by(|a, b| a.depth.total_cmp(&b.depth))?;
    let [a, b] = worst.bodies.map(|body| &bodies[body].name);
    Some(Diagnostic::new(key, format!("blocks \"{a}\" and \"{b}\" overlap by {:.3e} m", worst.depth)))
}
