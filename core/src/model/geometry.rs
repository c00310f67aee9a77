//! Plane geometry of blocks: polygons as lists of vertices.

use nalgebra::Vector2;

/// A point or vector \[m\].
pub type Vec2 = Vector2<f64>;

/// Returns the z component of a × b.
pub fn cross(a: Vec2, b: Vec2) -> f64 {
    a.x * b.y - a.y * b.x
}

/// Returns `a` rotated by +90°.
pub fn turned(a: Vec2) -> Vec2 {
    Vec2::new(-a.y, a.x)
}

/// Returns the signed area \[m²\] of a polygon, positive anticlockwise, and its centroid \[m\]. The sums are relative
/// to the first vertex, so that a polygon far from the origin loses no digits.
pub fn area_and_centroid(vertices: &[Vec2]) -> (f64, Vec2) {
    let origin = vertices[0];
    let (mut twice_area, mut moment) = (0.0, Vec2::zeros());
    for pair in vertices[1..].windows(2) {
        let (a, b) = (pair[0] - origin, pair[1] - origin);
        let twice = cross(a, b);
        twice_area += twice;
        moment += (a + b) * (twice / 3.0);
    }
    (twice_area / 2.0, origin + moment / twice_area)
}

/// Iterates over the edges of a polygon; edge i starts at vertex i.
pub fn edges(vertices: &[Vec2]) -> impl Iterator<Item = (Vec2, Vec2)> + '_ {
    (0..vertices.len()).map(move |i| (vertices[i], vertices[(i + 1) % vertices.len()]))
}

/// Returns the lower left and upper right corner of the bounding box of points.
pub fn bounding_box<'a>(points: impl IntoIterator<Item = &'a Vec2>) -> (Vec2, Vec2) {
    let infinite = Vec2::repeat(f64::INFINITY);
    points.into_iter().fold((infinite, -infinite), |(low, high), p| (low.inf(p), high.sup(p)))
}

/// Returns the distance of `p` from the segment from `a` to `b`.
pub fn distance_to_segment(p: Vec2, a: Vec2, b: Vec2) -> f64 {
    let along = b - a;
    let s = ((p - a).dot(&along) / along.norm_squared()).clamp(0.0, 1.0);
    (p - a - along * s).norm()
}

/// Returns true if `p` is inside the polygon or within `tolerance` of its boundary.
pub fn contains(vertices: &[Vec2], p: Vec2, tolerance: f64) -> bool {
    if edges(vertices).any(|(a, b)| distance_to_segment(p, a, b) <= tolerance) {
        return true;
    }
    edges(vertices)
        .filter(|&(a, b)| (a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
        .count()
        % 2
        == 1
}

/// Returns true if an anticlockwise polygon never turns right at a vertex.
pub fn is_convex(vertices: &[Vec2]) -> bool {
    let n = vertices.len();
    (0..n).all(|i| {
        let (a, b, c) = (vertices[i], vertices[(i + 1) % n], vertices[(i + 2) % n]);
        cross(b - a, c - b) >= 0.0
    })
}

fn convex_parts(vertices: &[Vec2]) -> Vec<Vec<Vec2>> {
    if is_convex(vertices) {
        return vec![vertices.to_vec()];
    }
    let mut triangles: Vec<usize> = Vec::new();
    earcut::Earcut::new().earcut(vertices.iter().map(|v| [v.x, v.y]), &[], &mut triangles);
    triangles
        .chunks(3)
        .map(|t| {
            let mut triangle: Vec<_> = t.iter().map(|&i| vertices[i]).collect();
            if area_and_centroid(&triangle).0 < 0.0 {
                triangle.reverse();
            }
            triangle
        })
        .collect()
}

/// Clips the convex polygon `subject` by the convex polygon `window` (Sutherland and Hodgman), both anticlockwise.
fn clipped(subject: &[Vec2], window: &[Vec2]) -> Vec<Vec2> {
    let mut kept = subject.to_vec();
    for (a, b) in edges(window) {
        let depth = |p: Vec2| cross(b - a, p - a);
        let mut next = Vec::with_capacity(kept.len() + 1);
        for (p, q) in edges(&kept) {
            let (dp, dq) = (depth(p), depth(q));
            if dp >= 0.0 {
                next.push(p);
            }
            if (dp > 0.0 && dq < 0.0) || (dp < 0.0 && dq > 0.0) {
                next.push(p + (q - p) * (dp / (dp - dq)));
            }
        }
        kept = next;
        if kept.len() < 3 {
            return Vec::new();
        }
    }
    kept
}

/// Returns the depth of the overlap of two simple anticlockwise polygons \[m\]: the greatest mean width of the overlaps
/// of their convex parts (twice the area over the perimeter), 0 if they only touch.
pub fn overlap_depth(a: &[Vec2], b: &[Vec2]) -> f64 {
    let ((low_a, high_a), (low_b, high_b)) = (bounding_box(a), bounding_box(b));
    if (0..2).any(|i| high_a[i] <= low_b[i] || high_b[i] <= low_a[i]) {
        return 0.0;
    }
    let others = convex_parts(b);
    let mut depth: f64 = 0.0;
    for part in convex_parts(a) {
        for other in &others {
            let common = clipped(&part, other);
            if common.len() >= 3 {
                let perimeter: f64 = edges(&common).map(|(p, q)| (q - p).norm()).sum();
                if perimeter > 0.0 {
                    depth = depth.max(2.0 * area_and_centroid(&common).0 / perimeter);
                }
            }
        }
    }
    depth
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[(f64, f64)]) -> Vec<Vec2> {
        points.iter().map(|&(x, y)| Vec2::new(x, y)).collect()
    }

    #[test]
    fn area_and_centroid_of_a_trapezium_match_the_closed_form_far_from_the_origin() {
        let far = 1e6;
        let shape = polygon(&[(far, 0.0), (far + 3.0, 0.0), (far + 2.0, 1.0), (far, 1.0)]);
        let (area, centroid) = area_and_centroid(&shape);
        assert!((area - 2.5).abs() < 1e-12);
        assert!((centroid.x - far - 19.0 / 15.0).abs() < 1e-9 && (centroid.y - 7.0 / 15.0).abs() < 1e-12);
    }

    #[test]
    fn overlap_of_convex_and_concave_blocks() {
        let square = polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        let neighbour = polygon(&[(1.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0)]);
        assert_eq!(overlap_depth(&square, &neighbour), 0.0);
        let angle = polygon(&[(0.5, 1.0), (0.5, -1.0), (3.0, -1.0), (3.0, 3.0), (2.0, 3.0), (2.0, 1.0)]);
        assert!(overlap_depth(&square, &angle) > 0.1);
        let beside = polygon(&[(1.0, 1.0), (1.0, -1.0), (3.0, -1.0), (3.0, 3.0), (2.0, 3.0), (2.0, 1.0)]);
        assert!(overlap_depth(&square, &beside) < 1e-15);
    }

    #[test]
    fn points_in_and_on_a_polygon() {
        let square = polygon(&[(0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0)]);
        assert!(contains(&square, Vec2::new(0.5, 0.5), 0.0));
        assert!(contains(&square, Vec2::new(1.0, 0.3), 1e-12));
        assert!(!contains(&square, Vec2::new(1.1, 0.3), 1e-12));
    }
}
