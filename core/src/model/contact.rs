//! Finding the joints of an assembly of polygons: overlaps of edges, not given by hand.

use super::assembly::Body;
use super::geometry::{Vec2, bounding_box, edges, overlap_depth};
use super::joints::{Bond, Gap, Joint};

/// Tolerance for overlap, gap and interpenetration, as a share of the scene's size.
pub const CONTACT_TOLERANCE: f64 = 1e-9;

/// Two bodies that overlap.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interpenetration {
    /// Indices of the two bodies.
    pub bodies: [usize; 2],
    /// How deep \[m\].
    pub depth: f64,
}

/// Pairs of bodies whose boxes, grown by `tolerance`, meet; sorted.
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

/// The overlap of edge a → b of the minus body with edge c → d of the plus body (both bodies
/// anticlockwise), as joint ends with n pointing out of minus. `None` where they do not lie on one
/// line, face the same way, or touch at a point only.
fn edge_overlap(a: Vec2, b: Vec2, c: Vec2, d: Vec2, tolerance: f64) -> Option<[Vec2; 2]> {
    let along = b - a;
    let length = along.norm();
    let along = along / length;
    let out = Vec2::new(along.y, -along.x);
    if (d - c).dot(&along) >= 0.0 || [c, d].iter().any(|p| (p - a).dot(&out).abs() > tolerance) {
        return None;
    }
    let place = |p: Vec2| (p - a).dot(&along);
    // Ends are vertices of the bodies themselves, so that congruent joints stay congruent.
    let (start, first) = if place(d) > 0.0 { (place(d), d) } else { (0.0, a) };
    let (end, last) = if place(c) < length { (place(c), c) } else { (length, b) };
    (end - start > tolerance).then_some([first, last])
}

/// Joints between bodies wherever an edge of one overlaps an edge of another, in the order of the
/// bodies (the smaller index is minus), and the pairs that overlap in area. `law` gives the law and
/// initial gap of a pair; joints between two fixed bodies are left out.
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
