//! Faces of polyhedra as plane convex patches.

use super::clip::convex_parts;
use super::plane::Axes;
use super::polyhedron::Polyhedron;
use super::vector::Vec3;

/// A plane convex part of a face.
#[derive(Debug, Clone)]
pub(super) struct Patch {
    /// Index of the face.
    pub face: usize,
    /// Corners, anticlockwise from outside \[m\].
    pub corners: Vec<Vec3>,
    /// A point of its plane \[m\].
    pub origin: Vec3,
    /// Unit normal, outward.
    pub normal: Vec3,
    /// Lowest and highest corner of its box \[m\].
    pub bounds: [Vec3; 2],
}

impl Patch {
    fn new(face: usize, corners: Vec<Vec3>, origin: Vec3, normal: Vec3) -> Self {
        let infinite = Vec3::repeat(f64::INFINITY);
        let bounds = corners.iter().fold([infinite, -infinite], |[low, high], p| [low.inf(p), high.sup(p)]);
        Patch { face, corners, origin, normal, bounds }
    }

    /// Returns the height of its plane along a direction at a point, seen from that point \[m\]. The direction is within a few
    /// degrees of its normal or of the opposite.
    pub fn height_above(&self, point: &Vec3, direction: &Vec3) -> f64 {
        (self.origin - point).dot(&self.normal) / direction.dot(&self.normal)
    }
}

/// Returns the patches of all faces. A face that is plane within `flat` \[m\] is itself if it is convex, or triangles. A face
/// that is more warped is a fan of triangles about the mean of its corners, as for volumes: two blocks that share such a
/// face share its triangles. `tolerance` \[m\] is the rounding of coordinates.
pub(super) fn patches(shape: &Polyhedron, flat: f64, tolerance: f64) -> Vec<Patch> {
    let mut patches = Vec::with_capacity(shape.faces.len());
    for (index, face) in shape.faces.iter().enumerate() {
        if face.len() > 3 && shape.warp(face) > flat {
            patches.extend(fan(shape, index));
        } else {
            patches.extend(plane_parts(shape, index, tolerance));
        }
    }
    patches
}

fn fan(shape: &Polyhedron, index: usize) -> impl Iterator<Item = Patch> + '_ {
    let face = &shape.faces[index];
    let mean = shape.face_mean(face);
    (0..face.len()).filter_map(move |k| {
        let (a, b) = (shape.vertices[face[k]], shape.vertices[face[(k + 1) % face.len()]]);
        let normal = (a - mean).cross(&(b - mean)).try_normalize(0.0)?;
        Some(Patch::new(index, vec![mean, a, b], mean, normal))
    })
}

fn plane_parts(shape: &Polyhedron, index: usize, tolerance: f64) -> Vec<Patch> {
    let face = &shape.faces[index];
    let Some(normal) = shape.area_vector(face).try_normalize(0.0) else { return Vec::new() };
    let (axes, origin) = (Axes::new(normal), shape.face_mean(face));
    let corners: Vec<Vec3> = face.iter().map(|&corner| shape.vertices[corner]).collect();
    let flat: Vec<_> = corners.iter().map(|corner| axes.flat(corner)).collect();
    let parts = convex_parts(&flat, tolerance);
    if let [_] = parts[..] {
        return vec![Patch::new(index, corners, origin, normal)];
    }
    let height = normal.dot(&origin);
    let lifted = |part: Vec<_>| part.iter().map(|point| axes.lifted(point, height)).collect();
    parts.into_iter().map(|part| Patch::new(index, lifted(part), origin, normal)).collect()
}
