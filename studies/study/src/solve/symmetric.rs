//! The symmetric mechanism of a symmetric scene.
//!
//! If flow is associated, the mechanisms of one load are a convex set: the mirror image of a motion is a mechanism, and so is
//! the mean of both. If flow is not associated, or the scene is not exactly symmetric, the mean may not be a mechanism. It is
//! used only if its flow obeys the laws and it has the same power.

use crate::results::path_state::small;
use voussoir_core::certificate::{flow_residual, power_residual};
use voussoir_core::model::Assembly;
use voussoir_core::model::geometry::{Vec2, bounding_box, turned};
use voussoir_core::path::{Loading, PathProblem};

/// Relative distance up to which blocks are mirror images of each other, and motions are equal.
const SAME: f64 = 1e-9;

/// Returns the mirror image of each block about the vertical through the middle of the free blocks; `None` if a block has no
/// image. The ground is its own image.
fn images(assembly: &Assembly) -> Option<(f64, Vec<usize>)> {
    let free = |block: &usize| !assembly.bodies[*block].fixed;
    let blocks: Vec<usize> = (0..assembly.bodies.len()).filter(free).collect();
    let vertices = || blocks.iter().flat_map(|block| &assembly.bodies[*block].vertices);
    vertices().next()?;
    let (low, high) = bounding_box(vertices());
    let axis = (low.x + high.x) / 2.0;
    let near = SAME * assembly.size();
    let centroids: Vec<Vec2> = blocks.iter().map(|block| assembly.inertia(*block).centroid).collect();
    // The blocks are sorted by height, so that only a few at the same height are compared.
    let mut order: Vec<usize> = (0..blocks.len()).collect();
    order.sort_by(|a, b| centroids[*a].y.total_cmp(&centroids[*b].y));
    let mut images: Vec<usize> = (0..assembly.bodies.len()).collect();
    for (own, &block) in blocks.iter().enumerate() {
        let image = Vec2::new(2.0 * axis - centroids[own].x, centroids[own].y);
        let first = order.partition_point(|other| centroids[*other].y < image.y - near);
        let level = order[first..].iter().take_while(|other| centroids[**other].y <= image.y + near);
        let found = level.copied().find(|other| (centroids[*other] - image).norm() <= near)?;
        let (other, mass) = (blocks[found], |block: usize| assembly.inertia(block).mass);
        if (mass(other) - mass(block)).abs() > SAME * mass(block) {
            return None;
        }
        images[block] = other;
    }
    Some((axis, images))
}

/// Returns the mean of the rates of a path's bodies and their mirror image, if the mean is a mechanism of the same load with
/// the same forces; `None` if it is not, or if both motions are the same.
pub(super) fn symmetric(
    assembly: &Assembly,
    structure: &PathProblem,
    loading: &Loading,
    force: &[[f64; 2]],
    rates: &[[f64; 3]],
) -> Option<Vec<[f64; 3]>> {
    let (axis, images) = images(assembly)?;
    let mut mean = rates.to_vec();
    for (block, image) in images.iter().enumerate() {
        let (body, other) = (structure.body_of[block], structure.body_of[*image]);
        let pole = structure.bodies[body].pole;
        let seen = Vec2::new(2.0 * axis - pole.x, pole.y);
        let [x, y, spin] = rates[other];
        let v = Vec2::new(x, y) + turned(seen - structure.bodies[other].pole) * spin;
        for (mean, (own, mirrored)) in mean[body].iter_mut().zip(rates[body].iter().zip([-v.x, v.y, -spin])) {
            *mean = (own + mirrored) / 2.0;
        }
    }
    let largest = rates.iter().flatten().fold(0.0, |m: f64, v| m.max(v.abs()));
    let moved = mean.iter().flatten().zip(rates.iter().flatten()).any(|(a, b)| (a - b).abs() > SAME * largest);
    let flows = || small("path_flow", flow_residual(structure, force, &mean));
    let works = || small("path_power", power_residual(structure, loading, &mean));
    (moved && flows() && works()).then_some(mean)
}
