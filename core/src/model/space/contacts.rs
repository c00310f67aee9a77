//! Contacts of polyhedra: overlaps of coplanar faces that face each other.
//!
//! Two faces are in contact if their overlap is at least as large as the least area, and if their planes are within the
//! tolerance of each other at every corner of the overlap. The contact is in the plane halfway between them. Faces that
//! just miss this are returned as near misses.

use super::assembly::{Contact, SpaceAssembly};
use super::clip::overlap;
use super::hull::{area_and_perimeter, hull};
use super::patch::{Patch, patches};
use super::plane::Axes;
use super::polyhedron::Polyhedron;
use super::vector::Vec3;
use std::collections::HashSet;

/// Tolerances of the search \[m, m²\].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactTolerances {
    /// Greatest distance between the planes of two faces in contact, and least mean width of a contact \[m\].
    pub distance: f64,
    /// Least area of a contact \[m²\].
    pub area: f64,
    /// Greatest distance of a near miss \[m\].
    pub near: f64,
    /// Rounding of coordinates: points closer than this are one point \[m\].
    pub rounding: f64,
}

impl ContactTolerances {
    /// Returns the defaults for a scene of a size \[m\]. For 10 m they are the published settings of `compas_cra`: coplanar
    /// within 1e-4 m and at least 1e-6 m² large.
    pub fn of_size(size: f64) -> Self {
        Self::of_distance(1e-5 * size, size)
    }

    /// Returns the tolerances for a distance between planes and a size of the scene \[m\].
    pub fn of_distance(distance: f64, size: f64) -> Self {
        let rounding = crate::model::CONTACT_TOLERANCE * size;
        ContactTolerances { distance, area: 1e2 * distance * distance, near: 1e2 * distance, rounding }
    }
}

/// A body of the search.
#[derive(Debug, Clone, Copy)]
pub struct ContactBody<'a> {
    /// Its shape.
    pub shape: &'a Polyhedron,
    /// True if the ground holds it. Two such bodies have no contact.
    pub fixed: bool,
}

impl<'a> ContactBody<'a> {
    /// Returns the bodies of an assembly.
    pub fn all(assembly: &'a SpaceAssembly) -> Vec<Self> {
        assembly.bodies.iter().map(|body| ContactBody { shape: &body.shape, fixed: body.fixed }).collect()
    }
}

/// Two faces that face each other but are too far apart, or at too large an angle, to be in contact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NearMiss {
    /// Indices of the two bodies.
    pub bodies: [usize; 2],
    /// Indices of their faces.
    pub faces: [usize; 2],
    /// Least and greatest gap over the overlap; negative if the bodies overlap \[m\].
    pub gap: [f64; 2],
    /// Area of the overlap \[m²\].
    pub area: f64,
}

/// Result of a search.
#[derive(Debug, Clone, Default)]
pub struct FoundContacts {
    /// Contacts in the order of their bodies; the smaller index is minus. The law is index 0.
    pub contacts: Vec<Contact>,
    /// At most one near miss for a pair of bodies, the one with the largest area.
    pub near: Vec<NearMiss>,
}

/// Greatest angle between faces that face each other, as |n_a + n_b|: 11°. The joints of coarse models of curved vaults open
/// by up to 5°. Beyond it two faces only touch along an edge.
const GREATEST_ANGLE: f64 = 0.2;
/// Greatest distance of a near miss as a share of the root of its area. Faces further apart are not meant to touch.
const NEAR_SHARE: f64 = 0.1;

/// Returns the contacts of all pairs of bodies, without those between two fixed bodies.
pub fn find_contacts(bodies: &[ContactBody<'_>], tolerances: &ContactTolerances) -> FoundContacts {
    let parts: Vec<Vec<Patch>> =
        bodies.iter().map(|body| patches(body.shape, tolerances.distance, tolerances.rounding)).collect();
    let mut found = FoundContacts::default();
    for (minus, plus) in neighbours(bodies, tolerances.near) {
        if bodies[minus].fixed && bodies[plus].fixed {
            continue;
        }
        let (mut overlaps, near) = between([minus, plus], [&parts[minus], &parts[plus]], tolerances);
        merge(&mut overlaps, tolerances);
        found.contacts.extend(overlaps.into_iter().map(|overlap| overlap.contact(minus, plus)));
        found.near.extend(near);
    }
    found
}

/// Returns the near misses of an assembly between bodies that have no contact, for the default tolerances of its size.
pub fn near_misses(assembly: &SpaceAssembly) -> Vec<NearMiss> {
    let (low, high) = assembly.bounding_box();
    let mut near = find_contacts(&ContactBody::all(assembly), &ContactTolerances::of_size((high - low).norm())).near;
    let pair = |a: usize, b: usize| [a.min(b), a.max(b)];
    let joined: HashSet<[usize; 2]> =
        assembly.contacts.iter().map(|contact| pair(contact.minus, contact.plus)).collect();
    near.retain(|near| !joined.contains(&near.bodies));
    near
}

/// Returns the pairs of bodies whose boxes, enlarged by half a distance, meet; sorted. A negative distance makes them
/// smaller. Boxes are swept along the longest side of the scene.
pub(super) fn neighbours(bodies: &[ContactBody<'_>], distance: f64) -> Vec<(usize, usize)> {
    let grow = Vec3::repeat(distance / 2.0);
    let mut boxes: Vec<_> = bodies.iter().map(|body| body.shape.bounding_box()).enumerate().collect();
    boxes.iter_mut().for_each(|(_, (low, high))| (*low, *high) = (*low - grow, *high + grow));
    let infinite = Vec3::repeat(f64::INFINITY);
    let (low, high) =
        boxes.iter().fold((infinite, -infinite), |(low, high), (_, own)| (low.inf(&own.0), high.sup(&own.1)));
    let axis = (high - low).imax();
    boxes.sort_by(|a, b| a.1.0[axis].total_cmp(&b.1.0[axis]));
    let mut pairs = Vec::new();
    for (place, (i, own)) in boxes.iter().enumerate() {
        let following = boxes[place + 1..].iter().take_while(|(_, other)| other.0[axis] <= own.1[axis]);
        pairs.extend(following.filter(|(_, other)| meet(own, other)).map(|(j, _)| (*i.min(j), *i.max(j))));
    }
    pairs.sort_unstable();
    pairs
}

fn meet(one: &(Vec3, Vec3), other: &(Vec3, Vec3)) -> bool {
    (0..3).all(|axis| one.0[axis] <= other.1[axis] && other.0[axis] <= one.1[axis])
}

/// The overlap of two patches.
#[derive(Debug, Clone)]
struct Overlap {
    axes: Axes,
    points: Vec<Vec3>,
    area: f64,
}

impl Overlap {
    fn contact(self, minus: usize, plus: usize) -> Contact {
        let Axes { normal, tangents } = self.axes;
        Contact { minus, plus, points: self.points, normal, tangents, law: 0 }
    }
}

/// Returns the overlaps of two bodies, and the near miss with the largest area.
fn between(
    bodies: [usize; 2],
    parts: [&[Patch]; 2],
    tolerances: &ContactTolerances,
) -> (Vec<Overlap>, Option<NearMiss>) {
    let (mut overlaps, mut near) = (Vec::new(), None::<NearMiss>);
    for one in parts[0] {
        for other in parts[1].iter().filter(|other| may_touch(one, other, tolerances.near)) {
            let Some((overlap, gap)) = overlap_of(one, other, tolerances) else { continue };
            let distance = gap[0].abs().max(gap[1].abs());
            if distance <= tolerances.distance {
                overlaps.push(overlap);
            } else if distance <= tolerances.near.min(NEAR_SHARE * overlap.area.sqrt())
                && near.is_none_or(|near| near.area < overlap.area)
            {
                near = Some(NearMiss { bodies, faces: [one.face, other.face], gap, area: overlap.area });
            }
        }
    }
    (overlaps, near)
}

/// Returns true if two patches face each other and their boxes are within a distance.
fn may_touch(one: &Patch, other: &Patch, distance: f64) -> bool {
    let apart = (0..3).any(|axis| {
        one.bounds[0][axis] > other.bounds[1][axis] + distance || other.bounds[0][axis] > one.bounds[1][axis] + distance
    });
    !apart && (one.normal + other.normal).norm() <= GREATEST_ANGLE
}

/// Returns the overlap of two patches in the plane between them, with the least and the greatest gap \[m\]; `None` if it is
/// too small.
fn overlap_of(one: &Patch, other: &Patch, tolerances: &ContactTolerances) -> Option<(Overlap, [f64; 2])> {
    let axes = Axes::new((one.normal - other.normal).normalize());
    let flat = |patch: &Patch| patch.corners.iter().map(|corner| axes.flat(corner)).collect::<Vec<_>>();
    let mut window = flat(other);
    window.reverse();
    let common = overlap(&flat(one), &window, tolerances.rounding);
    if common.len() < 3 {
        return None;
    }
    let (mut gap, mut height) = ([f64::INFINITY, f64::NEG_INFINITY], 0.0);
    for point in &common {
        let base = axes.lifted(point, 0.0);
        let [below, above] = [one, other].map(|patch| patch.height_above(&base, &axes.normal));
        gap = [gap[0].min(above - below), gap[1].max(above - below)];
        height += (below + above) / 2.0;
    }
    height /= common.len() as f64;
    let points: Vec<Vec3> = common.iter().map(|point| axes.lifted(point, height)).collect();
    let points = hull(&points, &axes.normal, tolerances.rounding);
    let (area, perimeter) = area_and_perimeter(&points, &axes.normal);
    // The mean width of a convex polygon is about twice its area over its perimeter.
    let large = points.len() > 2 && area >= tolerances.area && 2.0 * area >= tolerances.distance * perimeter;
    large.then_some((Overlap { axes, points, area }, gap))
}

/// Replaces coplanar overlaps of two bodies by one if together they fill a convex polygon.
fn merge(overlaps: &mut Vec<Overlap>, tolerances: &ContactTolerances) {
    let mut merged: Vec<Overlap> = Vec::with_capacity(overlaps.len());
    while let Some(first) = overlaps.pop() {
        let (mut group, rest): (Vec<_>, Vec<_>) =
            overlaps.drain(..).partition(|other| coplanar(&first, other, tolerances.rounding));
        *overlaps = rest;
        group.push(first);
        match united(&group, tolerances.rounding) {
            Some(one) => merged.push(one),
            None => merged.extend(group),
        }
    }
    merged.reverse();
    *overlaps = merged;
}

fn coplanar(one: &Overlap, other: &Overlap, tolerance: f64) -> bool {
    let normal = one.axes.normal;
    normal.dot(&other.axes.normal) > 0.0
        && other.points.iter().all(|point| (point - one.points[0]).dot(&normal).abs() <= tolerance)
}

/// Returns the union of overlaps without common area if it is convex.
fn united(group: &[Overlap], tolerance: f64) -> Option<Overlap> {
    let [first, _, ..] = group else { return None };
    let points: Vec<Vec3> = group.iter().flat_map(|overlap| &overlap.points).copied().collect();
    let points = hull(&points, &first.axes.normal, tolerance);
    let (area, perimeter) = area_and_perimeter(&points, &first.axes.normal);
    let sum: f64 = group.iter().map(|overlap| overlap.area).sum();
    ((area - sum).abs() <= tolerance * perimeter).then_some(Overlap { axes: first.axes, points, area })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cuboid(low: [f64; 3], high: [f64; 3]) -> Polyhedron {
        Polyhedron::cuboid(&low.into(), &high.into())
    }

    fn find(shapes: &[Polyhedron], fixed: usize) -> FoundContacts {
        let bodies: Vec<_> =
            shapes.iter().enumerate().map(|(i, shape)| ContactBody { shape, fixed: i < fixed }).collect();
        find_contacts(&bodies, &ContactTolerances::of_size(10.0))
    }

    fn area(contact: &Contact) -> f64 {
        area_and_perimeter(&contact.points, &contact.normal).0
    }

    /// Returns a shape with its points turned about an axis and moved.
    fn turned(shape: &Polyhedron) -> Polyhedron {
        let turn = nalgebra::Rotation3::new(Vec3::new(0.4, -1.1, 0.7));
        let place = |point: &Vec3| turn * point + Vec3::new(3.0, -20.0, 7.0);
        Polyhedron { vertices: shape.vertices.iter().map(place).collect(), faces: shape.faces.clone() }
    }

    /// Cubes side by side, above each other and over a corner only: faces make contacts, edges and corners do not. The normal
    /// points from minus to plus, and the points are anticlockwise about it. A turn of the scene changes nothing.
    #[test]
    fn faces_make_contacts_and_edges_do_not() {
        let unit = |x: f64, y: f64, z: f64| cuboid([x, y, z], [x + 1.0, y + 1.0, z + 1.0]);
        let shapes = [unit(0.0, 0.0, 0.0), unit(1.0, 0.0, 0.0), unit(0.5, 0.25, 1.0), unit(-1.0, -1.0, 0.0)];
        let moved: Vec<Polyhedron> = shapes.iter().map(turned).collect();
        for shapes in [&shapes[..], &moved] {
            let found = find(shapes, 0);
            let pairs: Vec<_> = found.contacts.iter().map(|contact| (contact.minus, contact.plus)).collect();
            assert_eq!(pairs, [(0, 1), (0, 2), (1, 2)]);
            for (contact, exact) in found.contacts.iter().zip([1.0, 0.375, 0.375]) {
                assert!((area(contact) - exact).abs() < 1e-12 && contact.points.len() == 4);
                let outward = contact.points[0] - shapes[contact.minus].volume_and_centroid().1;
                assert!(outward.dot(&contact.normal) > 0.0);
            }
            assert!(found.near.is_empty());
        }
        assert_eq!(find(&shapes, 2).contacts.len(), 2, "two fixed bodies have no contact");
    }

    /// A tenon in a mortise: concave faces, whose triangles are merged if they fill a rectangle.
    #[test]
    fn a_tenon_touches_its_mortise_on_three_sides() {
        // A U and a T in the plane x z, extruded along y.
        let extruded = |outline: &[[f64; 2]]| {
            let n = outline.len();
            let point = |y: f64| move |[x, z]: &[f64; 2]| Vec3::new(*x, y, *z);
            let vertices = outline.iter().map(point(0.0)).chain(outline.iter().map(point(1.0))).collect();
            let mut faces: Vec<Vec<usize>> = vec![(0..n).collect(), (n..2 * n).rev().collect()];
            faces.extend((0..n).map(|k| vec![k, k + n, (k + 1) % n + n, (k + 1) % n]));
            Polyhedron { vertices, faces }
        };
        let u = [[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [2.0, 2.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
        let t = [[1.0, 1.0], [2.0, 1.0], [2.0, 2.0], [3.0, 2.0], [3.0, 3.0], [0.0, 3.0], [0.0, 2.0], [1.0, 2.0]];
        let shapes = [extruded(&u), extruded(&t)];
        shapes.iter().for_each(|shape| assert_eq!(shape.check(), Ok(())));
        for shapes in [shapes.clone(), shapes.map(|shape| turned(&shape))] {
            let found = find(&shapes, 1);
            assert_eq!(found.contacts.len(), 5);
            assert!(found.contacts.iter().all(|contact| (area(contact) - 1.0).abs() < 1e-12));
        }
        // Side by side the fronts of two U touch: triangles that fill no convex polygon stay apart.
        let behind = |shape: &Polyhedron| {
            let vertices = shape.vertices.iter().map(|vertex| vertex + Vec3::y()).collect();
            Polyhedron { vertices, faces: shape.faces.clone() }
        };
        let found = find(&[extruded(&u), behind(&extruded(&u))], 0);
        let sum: f64 = found.contacts.iter().map(area).sum();
        assert!(found.contacts.len() > 1 && (sum - 5.0).abs() < 1e-12, "{} {sum}", found.contacts.len());
    }

    /// Two blocks share a warped face: they touch at the four triangles about its mean, and nowhere else.
    #[test]
    fn a_common_warped_face_is_a_fan_of_contacts() {
        let mut low = cuboid([0.0; 3], [1.0; 3]);
        let mut high = cuboid([0.0, 0.0, 1.0], [1.0, 1.0, 2.0]);
        low.vertices[7].z += 0.2;
        high.vertices[3].z += 0.2;
        let found = find(&[low, high], 0);
        assert_eq!(found.contacts.len(), 4);
        assert!(found.contacts.iter().all(|contact| contact.points.len() == 3 && contact.normal.z > 0.9));
    }

    /// A gap of 0.5 mm in a scene of 10 m is a near miss and no contact; so is an overlap. A gap of 50 mm is neither.
    #[test]
    fn near_misses_are_reported() {
        let above = |gap: f64| find(&[cuboid([0.0; 3], [1.0; 3]), cuboid([0.0, 0.0, 1.0 + gap], [1.0, 1.0, 2.0])], 0);
        for gap in [5e-4, -5e-4] {
            let found = above(gap);
            assert!(found.contacts.is_empty());
            let [near] = found.near[..] else { panic!("{:?}", found.near) };
            assert!((near.gap[0] - gap).abs() < 1e-12 && (near.area - 1.0).abs() < 1e-12 && near.faces == [1, 0]);
        }
        assert_eq!((above(5e-5).contacts.len(), above(5e-5).near.len()), (1, 0));
        assert_eq!((above(0.05).contacts.len(), above(0.05).near.len()), (0, 0));
    }

    /// A wall of 60 courses of 50 blocks in stretcher bond has two contacts below each block and one beside it.
    #[test]
    fn a_large_wall_has_all_its_contacts() {
        let (courses, blocks) = (60, 50);
        let block = |k: usize| {
            let (course, place) = (k / blocks, k % blocks);
            let x = place as f64 + 0.5 * (course % 2) as f64;
            cuboid([x, 0.0, 0.3 * course as f64], [x + 1.0, 0.4, 0.3 * (course + 1) as f64])
        };
        let shapes: Vec<Polyhedron> = (0..courses * blocks).map(block).collect();
        let found = find(&shapes, 0);
        assert_eq!(found.contacts.len(), courses * (blocks - 1) + (courses - 1) * (2 * blocks - 1));
        assert!(found.near.is_empty());
    }
}
