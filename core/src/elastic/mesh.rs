//! Meshes of quadrilaterals with nodes at Gauss–Lobatto points.

use super::polygon::{is_convex_quadrilateral, triangles};
use super::quadrature::lobatto;
use crate::model::MeshDensity;
use crate::model::geometry::Vec2;
use std::collections::HashMap;

/// Returns the ends of n parts of \[0, 1\] whose sizes grow geometrically from both ends to the middle; the greatest
/// size is `grading` times the least. t\[n − i\] = 1 − t\[i\] holds to the last bit.
fn graded(n: usize, grading: f64) -> Vec<f64> {
    let steps = ((n - 1) / 2).max(1) as f64;
    let size = |i: usize| grading.powf(i.min(n - 1 - i) as f64 / steps);
    let total: f64 = (0..n).map(size).sum();
    let mut ends = vec![0.0; n + 1];
    for i in 0..n {
        ends[i + 1] = ends[i] + size(i) / total;
    }
    mirrored(ends)
}

/// Replaces the upper half of the values by one minus the lower half.
fn mirrored(mut t: Vec<f64>) -> Vec<f64> {
    let n = t.len() - 1;
    for i in 0..=n / 2 {
        t[n - i] = if 2 * i == n { 0.5 } else { 1.0 - t[i] };
    }
    t
}

/// Returns the positions of all nodes, given the element ends.
fn with_nodes(ends: &[f64], order: usize) -> Vec<f64> {
    let inner = lobatto(order + 1).0;
    let mut t = vec![ends[0]];
    for pair in ends.windows(2) {
        let middle = (pair[0] + pair[1]) / 2.0;
        t.extend(inner[1..order].iter().map(|x| middle + (pair[1] - pair[0]) / 2.0 * x));
        t.push(pair[1]);
    }
    mirrored(t)
}

fn half_divisions(density: &MeshDensity) -> usize {
    density.elements[0].max(density.elements[1]).div_ceil(2)
}

/// Grading of edges of polygons that are not quadrilaterals.
fn common_grading(density: &MeshDensity) -> f64 {
    density.grading[0].max(density.grading[1])
}

/// Returns the element boundaries along the edge from vertex `edge` to the next, as fractions from 0 to 1. They are
/// symmetric to the last bit, so that the reversed edge has the same boundaries.
pub fn edge_breaks(vertices: &[Vec2], density: &MeshDensity, edge: usize) -> Vec<f64> {
    if is_convex_quadrilateral(vertices) {
        graded(density.elements[edge % 2], density.grading[edge % 2])
    } else {
        graded(2 * half_divisions(density), common_grading(density))
    }
}

/// Returns the nodes of the mesh along the edge from vertex `edge` to the next, as fractions from 0 to 1.
pub fn edge_points(vertices: &[Vec2], density: &MeshDensity, edge: usize) -> Vec<f64> {
    with_nodes(&edge_breaks(vertices, density, edge), density.order)
}

/// A mesh of straight-sided quadrilaterals.
#[derive(Debug, Clone)]
pub struct Mesh {
    /// Positions of the nodes.
    pub nodes: Vec<Vec2>,
    /// Nodes of each element, (order + 1)², row by row: node (i, j) has the index i + (order + 1) j.
    pub elements: Vec<Vec<usize>>,
    /// Order of the elements.
    pub order: usize,
}

impl Mesh {
    /// Meshes a simple anticlockwise polygon. An error gives the reason why this is not possible.
    pub fn new(vertices: &[Vec2], density: &MeshDensity) -> Result<Mesh, String> {
        density.check()?;
        let mut mesh = Mesh { nodes: vertices.to_vec(), elements: Vec::new(), order: density.order };
        let mut sides = HashMap::new();
        if is_convex_quadrilateral(vertices) {
            let [u, v] = [0, 1].map(|i| with_nodes(&graded(density.elements[i], density.grading[i]), density.order));
            let complement = |t: &[f64]| t.iter().rev().copied().collect::<Vec<_>>();
            let places = [(u.as_slice(), complement(&u)), (v.as_slice(), complement(&v))];
            mesh.fill([0, 1, 2, 3], &places, &mut sides);
            return Ok(mesh);
        }
        let triangles = triangles(vertices).ok_or("the polygon cannot be cut into triangles")?;
        let k = half_divisions(density);
        let whole = with_nodes(&graded(2 * k, common_grading(density)), density.order);
        let half: Vec<f64> = whole[..=k * density.order].iter().map(|t| 2.0 * t).collect();
        let complement: Vec<f64> = half.iter().map(|t| 1.0 - t).collect();
        let mut middles = HashMap::new();
        for triangle in triangles {
            let corners = triangle.map(|i| vertices[i]);
            let centre = mesh.add((corners[0] + corners[1] + corners[2]) / 3.0);
            let middle = [0, 1, 2].map(|i| {
                let (a, b) = (triangle[i], triangle[(i + 1) % 3]);
                *middles.entry((a.min(b), a.max(b))).or_insert_with(|| mesh.add((vertices[a] + vertices[b]) / 2.0))
            });
            for i in 0..3 {
                // Both directions start at the vertex, so that each side is always traversed in the same sense.
                let corners = [triangle[i], middle[i], centre, middle[(i + 2) % 3]];
                let places = [(half.as_slice(), complement.clone()), (half.as_slice(), complement.clone())];
                mesh.fill(corners, &places, &mut sides);
            }
        }
        Ok(mesh)
    }

    fn add(&mut self, place: Vec2) -> usize {
        self.nodes.push(place);
        self.nodes.len() - 1
    }

    /// Meshes the quadrilateral of four nodes. `places` are the positions of nodes from corner 0 to 1 and from 0 to 3,
    /// with their complements to one; `sides` stores the nodes on sides.
    fn fill(
        &mut self,
        corners: [usize; 4],
        places: &[(&[f64], Vec<f64>); 2],
        sides: &mut HashMap<(usize, usize), Vec<usize>>,
    ) {
        let [a, b, c, d] = corners.map(|i| self.nodes[i]);
        let [(u, not_u), (v, not_v)] = places;
        let (columns, rows) = (u.len(), v.len());
        let at = |i: usize, j: usize| (a * not_u[i] + b * u[i]) * not_v[j] + (d * not_u[i] + c * u[i]) * v[j];
        let mut grid = vec![usize::MAX; columns * rows];
        let ends = [(0, 0), (columns - 1, 0), (columns - 1, rows - 1), (0, rows - 1)];
        for ((i, j), corner) in ends.into_iter().zip(corners) {
            grid[i + columns * j] = corner;
        }
        let along = |j: usize| (1..columns - 1).map(move |i| (i, j)).collect::<Vec<_>>();
        let across = |i: usize| (1..rows - 1).map(move |j| (i, j)).collect::<Vec<_>>();
        let four = [(0, 1, along(0)), (1, 2, across(columns - 1)), (3, 2, along(rows - 1)), (0, 3, across(0))];
        for (from, to, line) in four {
            let key = (corners[from], corners[to]);
            let nodes = sides.entry(key).or_insert_with(|| line.iter().map(|&(i, j)| self.add(at(i, j))).collect());
            line.iter().zip(nodes).for_each(|(&(i, j), node)| grid[i + columns * j] = *node);
        }
        for j in 1..rows - 1 {
            for i in 1..columns - 1 {
                grid[i + columns * j] = self.add(at(i, j));
            }
        }
        let p = self.order;
        for row in (0..rows - 1).step_by(p) {
            for column in (0..columns - 1).step_by(p) {
                let node = |k: usize| grid[column + k % (p + 1) + columns * (row + k / (p + 1))];
                self.elements.push((0..(p + 1) * (p + 1)).map(node).collect());
            }
        }
    }

    /// Returns the corners of an element, anticlockwise.
    pub fn corners(&self, element: usize) -> [Vec2; 4] {
        let (nodes, p) = (&self.elements[element], self.order);
        [0, p, (p + 1) * (p + 1) - 1, p * (p + 1)].map(|k| self.nodes[nodes[k]])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::geometry::{area_and_centroid, cross, edges};

    fn polygon(points: &[(f64, f64)]) -> Vec<Vec2> {
        points.iter().map(|&(x, y)| Vec2::new(x, y)).collect()
    }

    fn shapes() -> Vec<Vec<Vec2>> {
        vec![
            polygon(&[(0.0, 0.0), (2.0, 0.1), (1.7, 1.0), (0.2, 1.2)]),
            polygon(&[(0.0, 0.0), (1.0, 0.0), (0.0, 1.0)]),
            polygon(&[(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (1.0, 1.0), (1.0, 3.0), (0.0, 3.0)]),
            polygon(&[(0.0, 0.0), (2.0, 0.0), (2.5, 1.0), (1.0, 2.0), (-0.5, 1.0)]),
            polygon(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0), (3.0, 0.0), (3.0, 1.0), (0.0, 1.0)]),
            polygon(&[(0.0, 0.0), (2.0, 0.0), (1.0, 1.0), (0.0, 2.0)]),
        ]
    }

    /// Meshes are valid and conforming: elements fill the polygon, every corner is convex, no two nodes coincide, and
    /// each inner element side belongs to two elements.
    #[test]
    fn meshes_are_valid() {
        for (shape, order, grading) in shapes()
            .iter()
            .flat_map(|s| (1..=3).flat_map(move |p| [(s, p, [1.0; 2]), (s, p, [20.0; 2]), (s, p, [3.0, 50.0])]))
        {
            let density = MeshDensity { elements: [3, 4], order, grading };
            let mesh = Mesh::new(shape, &density).unwrap();
            let area: f64 = (0..mesh.elements.len()).map(|e| area_and_centroid(&mesh.corners(e)).0).sum();
            assert!((area - area_and_centroid(shape).0).abs() < 1e-13);
            let mut sides = HashMap::new();
            for e in 0..mesh.elements.len() {
                let c = mesh.corners(e);
                assert!((0..4).all(|i| cross(c[(i + 1) % 4] - c[i], c[(i + 2) % 4] - c[(i + 1) % 4]) > 0.0));
                let (nodes, p) = (&mesh.elements[e], order);
                let corners = [0, p, (p + 1) * (p + 1) - 1, p * (p + 1)].map(|k| nodes[k]);
                for i in 0..4 {
                    let (a, b) = (corners[i], corners[(i + 1) % 4]);
                    *sides.entry((a.min(b), a.max(b))).or_insert(0) += 1;
                }
            }
            let boundary: usize = (0..shape.len()).map(|e| edge_breaks(shape, &density, e).len() - 1).sum();
            assert_eq!(sides.values().filter(|&&n| n == 1).count(), boundary);
            assert!(sides.values().all(|&n| n <= 2));
            for (i, a) in mesh.nodes.iter().enumerate() {
                assert!(mesh.nodes[..i].iter().all(|b| (a - b).norm() > 1e-6));
            }
        }
    }

    /// The edges of a mesh have their nodes at `edge_points`, from either end, within rounding.
    #[test]
    fn edges_have_their_nodes() {
        for shape in shapes() {
            let density = MeshDensity { elements: [4, 6], order: 3, grading: [2.0, 7.0] };
            let mesh = Mesh::new(&shape, &density).unwrap();
            for (edge, (a, b)) in edges(&shape).enumerate() {
                let fractions = edge_points(&shape, &density, edge);
                let n = fractions.len() - 1;
                for (i, t) in fractions.iter().enumerate() {
                    assert!(2 * i == n || i < n - i || fractions[i] == 1.0 - fractions[n - i]);
                    let place = a * (1.0 - t) + b * *t;
                    assert!(mesh.nodes.iter().any(|node| (node - place).norm() < 1e-14));
                }
            }
        }
    }

    /// The greatest element along an edge is `grading` times the least and is in the middle.
    #[test]
    fn grading_is_the_ratio_of_sizes() {
        for n in 3..9 {
            let t = graded(n, 5.0);
            let size = |i: usize| t[i + 1] - t[i];
            assert!((size((n - 1) / 2) / size(0) - 5.0).abs() < 1e-12);
        }
        assert_eq!(graded(2, 5.0), [0.0, 0.5, 1.0]);
    }
}
