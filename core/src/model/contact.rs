//! Finds the joints of an assembly of polygons from overlapping edges.

use super::assembly::Body;
use super::geometry::{Vec2, bounding_box, edges, overlap_depth};
use super::joints::{Bond, Gap, Joint};

/// Tolerance of overlap, gap and interpenetration, relative to the size of the scene.
pub const CONTACT_TOLERANCE: f64 = 1e-9;

/// Two bodies whose areas overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interpenetration {
    /// Indices of the two bodies.
    pub bodies: [usize; 2],
    /// Depth of the overlap \[m\].
    pub depth: f64,
}

/// Returns the pairs of bodies whose bounding boxes, enlarged by `tolerance`, meet; sorted.
fn neighbours(bodies: &[Body], tolerance: f64) -> Vec<(usize, usize)> {
    let grow = Vec2::repeat(tolerance);
    let mut boxes: Vec<_> = bodies
        .iter()
        .enumerate()
        .filter(|(_, body)| !body.vertices.is_empty())
        .map(|(index, body)| {
            let (low, high) = bounding_box(&body.vertices);
            (index, low - grow, high + grow)
        })
        .collect();
    boxes.sort_by(|a, b| a.1.x.total_cmp(&b.1.x));
    let mut pairs = Vec::new();
    for (place, (i, low, high)) in boxes.iter().enumerate() {
        for (j, other_low, other_high) in boxes[place + 1..].iter().take_while(|other| other.1.x <= high.x) {
            if other_low.y <= high.y && low.y <= other_high.y {
                pairs.push((*i.min(j), *i.max(j)));
            }
        }
    }
    pairs.sort_unstable();
    pairs
}

/// Returns the overlap of edge a → b of the minus body with edge c → d of the plus body (both bodies anticlockwise) as
/// joint ends, with n pointing out of minus. `None` if the edges are not on one line, face the same way, or share only
/// a point.
fn edge_overlap(a: Vec2, b: Vec2, c: Vec2, d: Vec2, tolerance: f64) -> Option<[Vec2; 2]> {
    let along = b - a;
    let length = along.norm();
    let along = along / length;
    let out = Vec2::new(along.y, -along.x);
    if (d - c).dot(&along) >= 0.0 || [c, d].iter().any(|p| (p - a).dot(&out).abs() > tolerance) {
        return None;
    }
    let place = |p: Vec2| (p - a).dot(&along);
    // Use vertices of the bodies as ends, so that congruent joints stay congruent.
    let (start, first) = if place(d) > 0.0 { (place(d), d) } else { (0.0, a) };
    let (end, last) = if place(c) < length { (place(c), c) } else { (length, b) };
    (end - start > tolerance).then_some([first, last])
}

/// Returns a joint for every overlap of an edge of one body with an edge of another, in the order of the bodies (the
/// smaller index is minus), and the pairs of bodies whose areas overlap. `law` gives the law and initial gap of a pair;
/// joints between two fixed bodies are left out.
pub fn find_joints(
    bodies: &[Body],
    size: f64,
    law: impl Fn(usize, usize) -> (Bond, Gap),
) -> (Vec<Joint>, Vec<Interpenetration>) {
    let tolerance = CONTACT_TOLERANCE * size;
    let (mut joints, mut overlaps) = (Vec::new(), Vec::new());
    for (minus, plus) in neighbours(bodies, tolerance) {
        let (one, other) = (&bodies[minus], &bodies[plus]);
        let depth = overlap_depth(&one.vertices, &other.vertices);
        if depth > tolerance {
            overlaps.push(Interpenetration { bodies: [minus, plus], depth });
            continue;
        }
        if one.fixed && other.fixed {
            continue;
        }
        for (a, b) in edges(&one.vertices) {
            for (c, d) in edges(&other.vertices) {
                if let Some(ends) = edge_overlap(a, b, c, d, tolerance) {
                    let (bond, gap) = law(minus, plus);
                    joints.push(Joint { minus, plus, ends, bond, gap });
                }
            }
        }
    }
    (joints, overlaps)
}
