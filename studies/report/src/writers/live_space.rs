//! The data of a case in space for the script of a page, which turns the blocks and plays their mechanism.

use serde_json::{Value as Json, json};
use voussoir_core::space::Vec3;
use voussoir_study::results::CaseResult;
use voussoir_study::study::SpaceCase;

/// Scenes with more blocks are not drawn by the script.
pub(super) const BLOCKS: usize = 600;
/// Greatest displacement that the script shows, as a share of the scene's size.
const MOVED: f64 = 0.12;

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
    let centres: Vec<Vec3> = bodies.iter().map(|body| body.shape.volume_and_centroid().1).collect();
    let motion = result.proof.space.as_ref().and_then(|proof| proof.motion.as_deref());
    let mut fastest = 0.0_f64;
    for ((body, centre), entry) in bodies.iter().zip(&centres).zip(motion.unwrap_or_default()) {
        let [x, y, z, a, b, c] = entry.velocity;
        let speed = |point: &Vec3| (Vec3::new(x, y, z) + Vec3::new(a, b, c).cross(&(point - centre))).norm();
        fastest = body.shape.vertices.iter().map(speed).fold(fastest, f64::max);
    }
    let scale = MOVED * (high - low).norm() / fastest;
    let scaled = |velocity: [f64; 6]| velocity.map(|v| digits(v * scale));
    let motion = motion.filter(|_| fastest > 0.0);
    Some(json!({
        "id": result.label.id,
        "low": three(&low),
        "high": three(&high),
        "points": bodies.iter().map(|body| body.shape.vertices.iter().map(three).collect()).collect::<Vec<Vec<_>>>(),
        "faces": bodies.iter().map(|body| &body.shape.faces).collect::<Vec<_>>(),
        "fixed": bodies.iter().map(|body| body.fixed).collect::<Vec<_>>(),
        "centres": centres.iter().map(three).collect::<Vec<_>>(),
        "motion": motion.map(|motion| motion.iter().map(|entry| scaled(entry.velocity)).collect::<Vec<_>>()),
    }))
}
