//! The convex hull of points in a plane.
//!
//! Data have repeated corners and points in the middle of a side. A hull with one tolerance on the cross product loses true
//! corners on them. Here points are merged first. The hull of the rest is exact. Then corners are dropped by their
//! distance to the chord of their neighbours, the nearest first.

use super::plane::Axes;
use super::predicate::orientation;
use super::vector::Vec3;
use nalgebra::Vector2;

/// A point with its coordinates in the plane \[m\].
#[derive(Debug, Clone, Copy)]
struct Corner {
    point: Vec3,
    flat: Vector2<f64>,
}

/// Returns the vertices of the convex hull of points in a plane, anticlockwise about its unit normal \[m\]. Points closer than
/// `tolerance` \[m\] are one point; a corner closer than `tolerance` to the chord of its neighbours is dropped. The vertices
/// are some of the points. Fewer than three vertices mean that the points are on a line.
pub fn hull(points: &[Vec3], normal: &Vec3, tolerance: f64) -> Vec<Vec3> {
    let axes = Axes::new(*normal);
    let mut corners = exact_hull(merged(points, &axes, tolerance));
    drop_by_chord(&mut corners, tolerance);
    corners.iter().map(|corner| corner.point).collect()
}

/// Returns the first point of each cluster, sorted by coordinates.
fn merged(points: &[Vec3], axes: &Axes, tolerance: f64) -> Vec<Corner> {
    let mut kept: Vec<Corner> = Vec::with_capacity(points.len());
    for point in points {
        let flat = axes.flat(point);
        if kept.iter().all(|other| (other.flat - flat).norm() > tolerance) {
            kept.push(Corner { point: *point, flat });
        }
    }
    kept.sort_by(|a, b| a.flat.x.total_cmp(&b.flat.x).then(a.flat.y.total_cmp(&b.flat.y)));
    kept
}

/// Returns the strict hull of sorted corners, anticlockwise from the first (Andrew's monotone chain, exact signs).
fn exact_hull(sorted: Vec<Corner>) -> Vec<Corner> {
    if sorted.len() < 3 {
        return sorted;
    }
    let mut chain = half(sorted.iter());
    chain.pop();
    let mut upper = half(sorted.iter().rev());
    upper.pop();
    chain.append(&mut upper);
    chain
}

fn half<'a>(corners: impl Iterator<Item = &'a Corner>) -> Vec<Corner> {
    let mut chain: Vec<Corner> = Vec::new();
    for corner in corners {
        while let [.., a, b] = chain[..]
            && orientation(a.flat, b.flat, corner.flat) <= 0.0
        {
            chain.pop();
        }
        chain.push(*corner);
    }
    chain
}

/// Drops corners until each is further than `tolerance` from the chord of its neighbours.
fn drop_by_chord(corners: &mut Vec<Corner>, tolerance: f64) {
    while corners.len() > 2 {
        let distances = (0..corners.len()).map(|i| (chord_distance(corners, i), i));
        match distances.min_by(|a, b| a.0.total_cmp(&b.0)) {
            Some((distance, i)) if distance <= tolerance => corners.remove(i),
            _ => return,
        };
    }
}

/// Returns the distance of a corner from the chord of its neighbours \[m\].
fn chord_distance(corners: &[Corner], i: usize) -> f64 {
    let n = corners.len();
    let (a, b, c) = (corners[(i + n - 1) % n].flat, corners[i].flat, corners[(i + 1) % n].flat);
    let chord = c - a;
    let along = (b - a).dot(&chord) / chord.norm_squared();
    // A corner beyond an end of the chord is as far as that end.
    (b - a - chord * along.clamp(0.0, 1.0)).norm()
}

/// Returns the signed area \[m²\] and the perimeter \[m\] of a plane polygon, anticlockwise about the unit normal.
pub(super) fn area_and_perimeter(polygon: &[Vec3], normal: &Vec3) -> (f64, f64) {
    let Some(first) = polygon.first() else { return (0.0, 0.0) };
    let fan = polygon[1..].windows(2).map(|pair| (pair[0] - first).cross(&(pair[1] - first)).dot(normal));
    let sides = (0..polygon.len()).map(|i| (polygon[(i + 1) % polygon.len()] - polygon[i]).norm());
    (fan.sum::<f64>() / 2.0, sides.sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    const TOLERANCE: f64 = 1e-9;

    fn place(points: &[(f64, f64)], axes: &Axes) -> Vec<Vec3> {
        points.iter().map(|&(x, y)| axes.lifted(&Vector2::new(x, y), 3.0)).collect()
    }

    /// A square with repeated corners (apart by 1e-11) and points in the middle of its sides, off by 1e-12, keeps its four
    /// corners in any order and plane; a corner 1e-5 m outside the side is kept too.
    #[test]
    fn repeated_and_collinear_points_cost_no_corner() {
        let square = [
            (0.0, 0.0),
            (0.5, -1e-12),
            (1.0, 0.0),
            (1.0 + 1e-11, 1e-11),
            (1.0, 0.3),
            (1.0, 1.0),
            (1.0, 1.0),
            (0.7, 1.0 + 1e-12),
            (0.0, 1.0),
            (1e-12, 0.5),
            (1e-11, 1e-11),
        ];
        for normal in [Vec3::z(), Vec3::new(1.0, 2.0, -2.0) / 3.0] {
            let axes = Axes::new(normal);
            for shift in 0..square.len() {
                let mut points = square.to_vec();
                points.rotate_left(shift);
                assert_eq!(hull(&place(&points, &axes), &normal, TOLERANCE).len(), 4, "{shift}");
                points.push((0.5, -1e-5));
                let found = hull(&place(&points, &axes), &normal, TOLERANCE);
                assert_eq!(found.len(), 5, "{shift}");
                let (area, perimeter) = area_and_perimeter(&found, &normal);
                assert!((area - 1.000_005).abs() < 1e-10 && (perimeter - 4.0).abs() < 1e-8, "{area} {perimeter}");
            }
        }
    }

    /// Points of a clockwise or interleaved circle give an anticlockwise polygon of all points.
    #[test]
    fn a_circle_keeps_all_its_points() {
        let n = 40;
        let angle = |k: usize| (k * 7 % n) as f64 / n as f64 * std::f64::consts::TAU;
        let circle: Vec<_> = (0..n).map(|k| (angle(k).cos(), angle(k).sin())).collect();
        let normal = Vec3::new(0.6, 0.0, 0.8);
        let found = hull(&place(&circle, &Axes::new(normal)), &normal, TOLERANCE);
        let area = area_and_perimeter(&found, &normal).0;
        let exact = n as f64 / 2.0 * (std::f64::consts::TAU / n as f64).sin();
        assert!(found.len() == n && (area - exact).abs() < 1e-12, "{} {area}", found.len());
    }

    #[test]
    fn points_on_a_line_have_no_hull() {
        let line: Vec<_> = (0..9).map(|k| Vec3::new(0.1, 0.2, 0.3) * f64::from(k)).collect();
        let normal = Vec3::new(2.0, -1.0, 0.0).normalize();
        assert!(hull(&line, &normal, TOLERANCE).len() < 3);
        assert!(hull(&[], &normal, TOLERANCE).is_empty());
    }
}
