//! The symmetric member of the mechanisms of a symmetric scene.
//!
//! Mechanisms of one load are a convex set where flow is associated: with a motion its mirror image is one, and so is
//! the mean of both. Where flow is not associated, or the scene is not symmetric after all, the mean may be none: it
//! is taken only if it flows as the laws say and has the same power.

use crate::results::path_state::small;
use voussoir_core::certificate::{flow_residual, power_residual};
use voussoir_core::model::Assembly;
use voussoir_core::model::geometry::{Vec2, bounding_box, turned};
use voussoir_core::path::{Loading, PathProblem};

/// Relative distance up to which blocks count as each other's mirror images, and motions as the same.
const SAME: f64 = 1e-9;

/// For each block its mirror image about the vertical through the middle of the free blocks; `None` where one has
/// none. The ground is its own.
fn images(assembly: &Assembly) -> Option<(f64, Vec<usize>)> {
    let free = |block: &usize| !assembly.bodies[*block].fixed;
    let blocks: Vec<usize> = (0..assembly.bodies.len()).filter(free).collect();
    let vertices = || blocks.iter().flat_map(|block| &assembly.bodies[*block].vertices);
    vertices().next()?;
    let (low, high) = bounding_box(vertices());
    let axis = (low.x + high.x) / 2.0;
    let near = SAME * assembly.size();
    let centroids: Vec<Vec2> = blocks.iter().map(|block| assembly.inertia(*block).centroid).collect();
    // Sorted by height, a block's image is among the few at its own height.
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

/// The mean of rates of a path's bodies and their mirror image, where that is a mechanism of the same load on the
/// same forces; `None` where it is not, or is the same motion.
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
