//! Blocks whose interiors intersect.
//!
//! Two convex polyhedra are apart if the normal of a face of one of them, or the product of an edge of each, separates
//! them (Gottschalk, Lin & Manocha 1996, SIGGRAPH). The least overlap over these directions is the depth by which one
//! block must be moved out of the other.

use super::assembly::SpaceAssembly;
use super::contacts::{ContactBody, ContactTolerances, neighbours};
use super::patch::patches;
use super::polyhedron::Polyhedron;
use super::vector::Vec3;

/// Two blocks whose interiors intersect.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SpaceOverlap {
    /// Indices of the bodies.
    pub bodies: [usize; 2],
    /// Least distance by which one must move to leave the other \[m\].
    pub depth: f64,
}

/// Result of the search for blocks that intersect.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct FoundOverlaps {
    /// Pairs of convex bodies, in order.
    pub pairs: Vec<SpaceOverlap>,
    /// Bodies that are not convex and so near to another body that an overlap is possible; they are not checked.
    pub unchecked: Vec<usize>,
}

/// Returns the bodies of an assembly that intersect by more than the distance within which faces are in contact. Two
/// supports may intersect.
pub fn find_overlaps(assembly: &SpaceAssembly) -> FoundOverlaps {
    let (low, high) = assembly.bounding_box();
    let tolerances = ContactTolerances::of_size((high - low).norm());
    let bodies = ContactBody::all(assembly);
    let convex: Vec<Option<Convex>> = bodies.iter().map(|body| Convex::new(body.shape, &tolerances)).collect();
    let mut found = FoundOverlaps::default();
    // Boxes that only touch cannot belong to blocks that intersect.
    for (a, b) in neighbours(&bodies, -tolerances.distance) {
        if bodies[a].fixed && bodies[b].fixed {
            continue;
        }
        if let (Some(one), Some(other)) = (&convex[a], &convex[b]) {
            let depth = one.depth(other, tolerances.distance);
            found.pairs.extend(depth.map(|depth| SpaceOverlap { bodies: [a, b], depth }));
        } else {
            found.unchecked.extend([a, b].into_iter().filter(|&body| convex[body].is_none()));
        }
    }
    found.unchecked.sort_unstable();
    found.unchecked.dedup();
    found
}

/// A convex polyhedron.
struct Convex<'a> {
    corners: &'a [Vec3],
    normals: Vec<Vec3>,
    /// Different directions of its edges.
    edges: Vec<Vec3>,
}

/// Sine of the angle below which directions are parallel.
const PARALLEL: f64 = 1e-9;

impl<'a> Convex<'a> {
    /// Returns `None` if a corner is outside of a face by more than the distance within which faces are in contact.
    fn new(shape: &'a Polyhedron, tolerances: &ContactTolerances) -> Option<Self> {
        let patches = patches(shape, tolerances.distance, tolerances.rounding);
        let inside = |corner: &Vec3| {
            patches.iter().all(|patch| (corner - patch.origin).dot(&patch.normal) <= tolerances.distance)
        };
        shape.vertices.iter().all(inside).then(|| Convex {
            corners: &shape.vertices,
            normals: patches.iter().map(|patch| patch.normal).collect(),
            edges: edge_directions(shape),
        })
    }

    /// Returns the depth of the intersection; `None` if a direction separates the bodies up to a tolerance \[m\].
    fn depth(&self, other: &Convex<'_>, tolerance: f64) -> Option<f64> {
        let crossed = self.edges.iter().flat_map(|a| other.edges.iter().map(move |b| a.cross(b)));
        let crossed = crossed.filter_map(|axis| axis.try_normalize(PARALLEL));
        let axes = self.normals.iter().chain(&other.normals).copied().chain(crossed);
        let mut least = f64::INFINITY;
        for axis in axes {
            let ([a, b], [c, d]) = (self.extent(&axis), other.extent(&axis));
            least = least.min((b - c).min(d - a));
            if least <= tolerance {
                return None;
            }
        }
        Some(least)
    }

    fn extent(&self, axis: &Vec3) -> [f64; 2] {
        let along = self.corners.iter().map(|corner| corner.dot(axis));
        along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], x| [low.min(x), high.max(x)])
    }
}

fn edge_directions(shape: &Polyhedron) -> Vec<Vec3> {
    let mut directions: Vec<Vec3> = Vec::new();
    for face in &shape.faces {
        for (k, &from) in face.iter().enumerate() {
            let to = face[(k + 1) % face.len()];
            // Each edge belongs to two faces, which run along it in opposite directions.
            let Some(direction) = (shape.vertices[to] - shape.vertices[from]).try_normalize(0.0).filter(|_| from < to)
            else {
                continue;
            };
            if directions.iter().all(|known| known.cross(&direction).norm() > PARALLEL) {
                directions.push(direction);
            }
        }
    }
    directions
}

#[cfg(test)]
mod tests {
    use super::super::assembly::SpaceBody;
    use super::*;

    fn cuboid(low: [f64; 3], high: [f64; 3]) -> Polyhedron {
        Polyhedron::cuboid(&low.into(), &high.into())
    }

    fn turned(mut shape: Polyhedron, axis: Vec3, angle: f64, by: Vec3) -> Polyhedron {
        let turn = nalgebra::Rotation3::from_axis_angle(&nalgebra::Unit::new_normalize(axis), angle);
        shape.vertices.iter_mut().for_each(|vertex| *vertex = turn * *vertex + by);
        shape
    }

    fn overlaps(shapes: &[Polyhedron]) -> FoundOverlaps {
        let body = |(i, shape): (usize, &Polyhedron)| SpaceBody {
            name: i.to_string(),
            shape: shape.clone(),
            material: 0,
            fixed: false,
        };
        let bodies = shapes.iter().enumerate().map(body).collect();
        find_overlaps(&SpaceAssembly { bodies, ..SpaceAssembly::default() })
    }

    /// Cubes that share a face, an edge or a corner do not intersect; moved into each other by 1 cm they do, by 1 cm.
    #[test]
    fn cubes_intersect_by_the_distance_they_are_moved() {
        let unit = || cuboid([0.0; 3], [1.0; 3]);
        for step in [Vec3::x(), Vec3::new(1.0, 1.0, 0.0), Vec3::new(1.0, 1.0, 1.0), Vec3::new(1.0, 0.3, 0.2)] {
            for (into, depth) in [(0.0, None), (0.01, Some(0.01)), (1e-9, None)] {
                let moved = turned(unit(), Vec3::z(), 0.0, step - Vec3::repeat(into));
                let turn = |shape| turned(shape, Vec3::new(0.3, 1.0, -0.7), 0.9, Vec3::new(5.0, 1.0, 2.0));
                let found = overlaps(&[turn(unit()), turn(moved)]);
                assert_eq!(found.pairs.len(), usize::from(depth.is_some()), "{step:?} {into}");
                assert!(found.pairs.iter().all(|pair| (pair.depth - depth.unwrap_or(0.0)).abs() < 1e-12), "{found:?}");
            }
        }
    }

    /// Two bars that cross edge over edge are separated by the product of their edges only: a bar turned by 45° about its
    /// axis has the edge at half its diagonal.
    #[test]
    fn crossed_edges_separate_bars() {
        let bar = || cuboid([-0.5, -0.5, -3.0], [0.5, 0.5, 3.0]);
        let quarter = std::f64::consts::FRAC_PI_4;
        let one = turned(turned(bar(), Vec3::z(), quarter, Vec3::zeros()), Vec3::x(), 2.0 * quarter, Vec3::zeros());
        for (distance, meets) in [(2f64.sqrt() + 1e-3, false), (2f64.sqrt() - 1e-2, true)] {
            let other = turned(
                turned(bar(), Vec3::z(), quarter, Vec3::zeros()),
                Vec3::y(),
                2.0 * quarter,
                Vec3::z() * distance,
            );
            let found = overlaps(&[one.clone(), other]);
            assert_eq!(found.pairs.len(), usize::from(meets), "{distance}: {found:?}");
            assert!(found.pairs.iter().all(|pair| (pair.depth - 1e-2).abs() < 1e-12));
        }
    }

    /// A block in the hollow of a concave one does not intersect it and is not reported; the concave block is.
    #[test]
    fn concave_blocks_are_not_checked() {
        let u = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [2.0, 2.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let point = |y: f64| move |[x, z]: &[f64; 2]| Vec3::new(*x, y, *z);
        let vertices = u.iter().map(point(0.0)).chain(u.iter().map(point(1.0))).collect();
        let mut faces: Vec<Vec<usize>> = vec![(0..8).collect(), (8..16).rev().collect()];
        faces.extend((0..8).map(|k| vec![k, k + 8, (k + 1) % 8 + 8, (k + 1) % 8]));
        let hollow = Polyhedron { vertices, faces };
        let found = overlaps(&[cuboid([1.0, 0.0, 1.0], [2.0, 1.0, 3.0]), hollow, cuboid([9.0; 3], [10.0; 3])]);
        assert_eq!((found.pairs.len(), found.unchecked), (0, vec![1]));
    }
}
