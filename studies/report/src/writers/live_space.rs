//! The data of a case in space for the script of a page, which turns the blocks and plays their mechanism.

use crate::figures::{MOVED, Moves};
use serde_json::{Value as Json, json};
use voussoir_core::space::Vec3;
use voussoir_study::results::CaseResult;
use voussoir_study::study::SpaceCase;

/// Scenes with more blocks are not drawn by the script.
pub(super) const BLOCKS: usize = 600;

/// Rounds to five digits.
fn digits(x: f64) -> f64 {
    format!("{x:.4e}").parse().unwrap_or(x)
}

fn three(vector: &Vec3) -> [f64; 3] {
    [vector.x, vector.y, vector.z].map(digits)
}

/// The data of a case; `None` if the scene is too large.
pub(super) fn space_data(space: &SpaceCase, result: &CaseResult) -> Option<Json> {
    let bodies = &space.assembly.bodies;
    if bodies.len() > BLOCKS {
        return None;
    }
    let (low, high) = space.assembly.bounding_box();
    let motion = result.proof.space.as_ref().and_then(|proof| proof.motion.as_deref());
    let scale = motion.and_then(|motion| Moves::new(&space.assembly, motion, MOVED * (high - low).norm()));
    let motion = motion.zip(scale.map(|moves| moves.scale));
    let scaled = |velocity: [f64; 6], scale: f64| velocity.map(|v| digits(v * scale));
    Some(json!({
        "id": result.label.id,
        "low": three(&low),
        "high": three(&high),
        "points": bodies.iter().map(|body| body.shape.vertices.iter().map(three).collect()).collect::<Vec<Vec<_>>>(),
        "faces": bodies.iter().map(|body| &body.shape.faces).collect::<Vec<_>>(),
        "fixed": bodies.iter().map(|body| body.fixed).collect::<Vec<_>>(),
        "centres": (0..bodies.len()).map(|body| three(&space.assembly.centroid(body))).collect::<Vec<_>>(),
        "motion": motion.map(|(motion, scale)| {
            motion.iter().map(|entry| scaled(entry.velocity, scale)).collect::<Vec<_>>()
        }),
    }))
}
