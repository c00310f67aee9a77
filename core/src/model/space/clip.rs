//! Convex parts of plane polygons, and the overlap of two of them.

use nalgebra::Vector2;

/// Point in a plane \[m\].
type Point = Vector2<f64>;

/// Returns the convex parts of a simple anticlockwise polygon: itself, or triangles. A corner that turns inwards by less than
/// `tolerance` \[m\] does not make it concave.
pub(super) fn convex_parts(polygon: &[Point], tolerance: f64) -> Vec<Vec<Point>> {
    if is_convex(polygon, tolerance) {
        return vec![polygon.to_vec()];
    }
    let mut triangles: Vec<usize> = Vec::new();
    earcut::Earcut::new().earcut(polygon.iter().map(|point| [point.x, point.y]), &[], &mut triangles);
    let part = |corners: &[usize]| {
        let mut triangle: Vec<Point> = corners.iter().map(|&corner| polygon[corner]).collect();
        if depth(triangle[0], triangle[1], triangle[2]) < 0.0 {
            triangle.reverse();
        }
        triangle
    };
    triangles.chunks(3).map(part).collect()
}

fn is_convex(polygon: &[Point], tolerance: f64) -> bool {
    let n = polygon.len();
    (0..n).all(|i| depth(polygon[i], polygon[(i + 1) % n], polygon[(i + 2) % n]) >= -tolerance)
}

/// Returns the distance of a point to the left of the line from a to b \[m\].
fn depth(a: Point, b: Point, point: Point) -> f64 {
    (b - a).perp(&(point - a)) / (b - a).norm().max(f64::MIN_POSITIVE)
}

/// Returns the overlap of two convex anticlockwise polygons (Sutherland and Hodgman). Corners within `tolerance` \[m\] of a
/// side of the window are on it, so that common sides and corners make no slivers. The result is empty without an overlap.
pub(super) fn overlap(subject: &[Point], window: &[Point], tolerance: f64) -> Vec<Point> {
    let mut kept = subject.to_vec();
    for (k, &a) in window.iter().enumerate() {
        let b = window[(k + 1) % window.len()];
        // A side shorter than the tolerance has no direction.
        if (b - a).norm() > tolerance {
            kept = cut(&kept, a, b, tolerance);
        }
        if kept.len() < 3 {
            return Vec::new();
        }
    }
    kept
}

/// Returns the part of a convex polygon to the left of the line from a to b.
fn cut(polygon: &[Point], a: Point, b: Point, tolerance: f64) -> Vec<Point> {
    let snapped = |point: &Point| Some(depth(a, b, *point)).filter(|depth| depth.abs() > tolerance).unwrap_or(0.0);
    let depths: Vec<f64> = polygon.iter().map(snapped).collect();
    let mut kept = Vec::with_capacity(polygon.len() + 1);
    for (i, &p) in polygon.iter().enumerate() {
        let next = (i + 1) % polygon.len();
        let (here, there) = (depths[i], depths[next]);
        if here >= 0.0 {
            kept.push(p);
        }
        if here * there < 0.0 {
            kept.push(p + (polygon[next] - p) * (here / (here - there)));
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    fn polygon(points: &[[f64; 2]]) -> Vec<Point> {
        points.iter().map(|&point| Point::from(point)).collect()
    }

    fn area(polygon: &[Point]) -> f64 {
        (1..polygon.len().max(2) - 1)
            .map(|i| (polygon[i] - polygon[0]).perp(&(polygon[i + 1] - polygon[0])) / 2.0)
            .sum()
    }

    const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]];

    /// The overlap of a polygon with itself, moved by 1e-12, has the corners of the polygon and no others.
    #[test]
    fn a_polygon_overlaps_itself() {
        let one = polygon(&SQUARE);
        let other: Vec<Point> = one.iter().map(|point| point + Point::new(1e-12, -1e-12)).collect();
        assert_eq!(overlap(&one, &other, 1e-9), one);
        let beside: Vec<Point> = one.iter().map(|point| point + Point::new(1.0 - 1e-12, 0.0)).collect();
        assert!(area(&overlap(&one, &beside, 1e-9)) < 1e-11);
        let half: Vec<Point> = one.iter().map(|point| point + Point::new(0.5, 0.0)).collect();
        assert!((area(&overlap(&one, &half, 1e-9)) - 0.5).abs() < 1e-15);
    }

    #[test]
    fn the_parts_of_a_concave_polygon_are_convex_and_fill_it() {
        let u =
            polygon(&[[0.0, 0.0], [3.0, 0.0], [3.0, 2.0], [2.0, 2.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]]);
        let parts = convex_parts(&u, 1e-9);
        assert!(parts.len() > 1 && parts.iter().all(|part| is_convex(part, 0.0)));
        assert!((parts.iter().map(|part| area(part)).sum::<f64>() - 5.0).abs() < 1e-14);
        assert_eq!(convex_parts(&polygon(&SQUARE), 1e-9).len(), 1);
    }
}
