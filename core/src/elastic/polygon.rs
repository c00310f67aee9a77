//! Decomposition of simple polygons into quadrilaterals: ear clipping gives triangles, and each triangle gives three
//! quadrilaterals around its centroid.

use crate::model::geometry::{Vec2, cross};

/// Sine of the least corner angle for the bilinear map; polygons with flatter corners are cut.
const LEAST_CORNER: f64 = 1e-3;

/// Returns true if one bilinear map can mesh the polygon: four corners, each clearly convex.
pub fn is_convex_quadrilateral(vertices: &[Vec2]) -> bool {
    vertices.len() == 4
        && (0..4).all(|i| {
            let (before, after) = (vertices[(i + 1) % 4] - vertices[i], vertices[(i + 2) % 4] - vertices[(i + 1) % 4]);
            cross(before, after) > LEAST_CORNER * before.norm() * after.norm()
        })
}

/// Returns twice the signed area of a triangle over its longest side squared, a measure of its shape.
fn quality(a: Vec2, b: Vec2, c: Vec2) -> f64 {
    let longest = (b - a).norm_squared().max((c - b).norm_squared()).max((a - c).norm_squared());
    cross(b - a, c - a) / longest
}

/// Returns true if p is in the closed triangle a, b, c, enlarged by rounding.
fn covers(a: Vec2, b: Vec2, c: Vec2, p: Vec2) -> bool {
    [(a, b), (b, c), (c, a)].iter().all(|&(from, to)| {
        let side = to - from;
        cross(side, p - from) >= -1e-12 * side.norm_squared()
    })
}

/// Returns triangles of a simple anticlockwise polygon as indices of vertices. Every vertex is a corner, also vertices
/// within a straight edge, so that triangles share whole edges. The ear with the best shape is cut first. `None` if
/// there is no ear, which cannot happen for a simple polygon.
pub fn triangles(vertices: &[Vec2]) -> Option<Vec<[usize; 3]>> {
    let mut rest: Vec<usize> = (0..vertices.len()).collect();
    let mut found = Vec::with_capacity(vertices.len());
    while rest.len() >= 3 {
        let n = rest.len();
        let corner = |i: usize| [rest[(i + n - 1) % n], rest[i], rest[(i + 1) % n]];
        let is_ear = |&(i, shape): &(usize, f64)| {
            let ear = corner(i);
            let [a, b, c] = ear.map(|v| vertices[v]);
            shape > 1e-9 && rest.iter().all(|v| ear.contains(v) || !covers(a, b, c, vertices[*v]))
        };
        let shape = |i: usize| {
            let [a, b, c] = corner(i).map(|v| vertices[v]);
            (i, quality(a, b, c))
        };
        let (best, _) = (0..n).map(shape).filter(is_ear).max_by(|a, b| a.1.total_cmp(&b.1))?;
        found.push(corner(best));
        rest.remove(best);
        if rest.len() == 2 {
            break;
        }
    }
    improve(vertices, &mut found);
    Some(found)
}

/// Flips diagonals as long as the worse of two triangles improves.
fn improve(vertices: &[Vec2], triangles: &mut [[usize; 3]]) {
    let shape = |t: [usize; 3]| quality(vertices[t[0]], vertices[t[1]], vertices[t[2]]);
    // Each flip improves the worse of two shapes, so the loop ends; the bound covers rounding only.
    for _ in 0..triangles.len() * triangles.len() + 1 {
        let mut flip = None;
        'search: for i in 0..triangles.len() {
            for j in 0..i {
                for k in 0..3 {
                    let (a, b, c) = (triangles[i][k], triangles[i][(k + 1) % 3], triangles[i][(k + 2) % 3]);
                    let Some(l) = (0..3).find(|&l| triangles[j][l] == b && triangles[j][(l + 1) % 3] == a) else {
                        continue;
                    };
                    let d = triangles[j][(l + 2) % 3];
                    let (one, other) = ([c, a, d], [d, b, c]);
                    let before = shape(triangles[i]).min(shape(triangles[j]));
                    if shape(one).min(shape(other)) > before * (1.0 + 1e-9) {
                        flip = Some((i, j, one, other));
                        break 'search;
                    }
                }
            }
        }
        let Some((i, j, one, other)) = flip else { break };
        triangles[i] = one;
        triangles[j] = other;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::geometry::area_and_centroid;

    fn polygon(points: &[(f64, f64)]) -> Vec<Vec2> {
        points.iter().map(|&(x, y)| Vec2::new(x, y)).collect()
    }

    /// Triangles are not flat, fill the polygon, and use every vertex, also vertices within a straight edge.
    #[test]
    fn triangles_fill_any_polygon() {
        let shapes = [
            polygon(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]),
            polygon(&[(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)]),
            polygon(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (3.0, 1.0), (0.0, 1.0)]),
            polygon(&[(0.0, 0.0), (2.0, 0.0), (1.0, 1.0), (0.0, 2.0)]),
            polygon(&[(0.0, 0.0), (3.0, 0.0), (3.0, 2.0), (2.0, 2.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)]),
        ];
        for shape in &shapes {
            let found = triangles(shape).unwrap();
            assert_eq!(found.len(), shape.len() - 2);
            let areas: Vec<f64> = found.iter().map(|t| area_and_centroid(&t.map(|i| shape[i])).0).collect();
            assert!(areas.iter().all(|&area| area > 1e-3));
            assert!((areas.iter().sum::<f64>() - area_and_centroid(shape).0).abs() < 1e-14);
        }
    }
}
