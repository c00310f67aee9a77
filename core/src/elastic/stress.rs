//! Stresses and displacements of a whole mesh, for pictures and files only.

use super::element::{Reference, stresses};
use super::mesh::Mesh;
use crate::law::PlaneElasticity;
use crate::model::geometry::Vec2;
use nalgebra::Matrix2;

/// A deformed mesh with its stresses, in world axes of the undeformed placement.
#[derive(Debug, Clone)]
pub struct Recovered {
    /// Positions of the nodes, undeformed \[m\].
    pub nodes: Vec<Vec2>,
    /// Nodes of each element in VTK's order: corners, then the nodes on sides 0→1, 1→2, 3→2, 0→3, then inner nodes row
    /// by row (cell types 9, 28 and 70 for orders 1, 2, 3). Type 28 has its sides in the order 0→1, 1→2, 2→3, 3→0,
    /// which is the same with one node each. Nodes of order 3 are Gauss–Lobatto points; type 70 assumes even spacing,
    /// which is visible only between nodes.
    pub elements: Vec<Vec<usize>>,
    /// Order of the elements.
    pub order: usize,
    /// Elastic displacement of each node, relative to the body's mean rigid motion \[m\].
    pub displacement: Vec<Vec2>,
    /// (σ_xx, σ_yy, σ_zz, σ_xy) at each node \[Pa\], positive in tension: the mean of the elements that share it.
    pub stress: Vec<[f64; 4]>,
    /// (σ_xx, σ_yy, σ_zz, σ_xy) at the centre of each element \[Pa\].
    pub element_stress: Vec<[f64; 4]>,
    /// Resultant of the given forces, \[F_x, F_y, moment about the centroid\] \[N, N m\]; zero in equilibrium.
    pub imbalance: [f64; 3],
}

/// Returns, in VTK's order, the positions in the row-by-row list of an element's nodes.
fn vtk_order(order: usize) -> Vec<usize> {
    let (p, n) = (order, order + 1);
    let mut places = vec![0, p, n * n - 1, n * p];
    places.extend(1..p);
    places.extend((1..p).map(|j| p + n * j));
    places.extend((1..p).map(|i| i + n * p));
    places.extend((1..p).map(|j| n * j));
    places.extend((1..p).flat_map(|j| (1..p).map(move |i| i + n * j)));
    places
}

/// Returns the stresses of a mesh with modulus 1.
pub fn recovered(mesh: &Mesh, reference: &Reference, elasticity: &PlaneElasticity, displacement: &[Vec2]) -> Recovered {
    let mut sums = vec![([0.0; 3], 0.0); mesh.nodes.len()];
    let mut element_stress = Vec::with_capacity(mesh.elements.len());
    for (index, nodes) in mesh.elements.iter().enumerate() {
        let local: Vec<Vec2> = nodes.iter().map(|&node| displacement[node]).collect();
        let (at_nodes, middle) = stresses(reference, &mesh.corners(index), &elasticity.stiffness, &local);
        for (node, stress) in nodes.iter().zip(at_nodes) {
            (0..3).for_each(|i| sums[*node].0[i] += stress[i]);
            sums[*node].1 += 1.0;
        }
        element_stress.push(elasticity.with_across(middle));
    }
    // Triangles of a cut polygon include every vertex, so every node has an element.
    let stress = sums.into_iter().map(|(sum, count)| elasticity.with_across(sum.map(|s| s / count))).collect();
    Recovered::with(mesh, displacement.to_vec(), stress, element_stress)
}

impl Recovered {
    /// Creates the result from displacements and stresses that are already known.
    pub(super) fn with(
        mesh: &Mesh,
        displacement: Vec<Vec2>,
        stress: Vec<[f64; 4]>,
        element_stress: Vec<[f64; 4]>,
    ) -> Self {
        let order = vtk_order(mesh.order);
        Recovered {
            nodes: mesh.nodes.clone(),
            elements: mesh.elements.iter().map(|nodes| order.iter().map(|&k| nodes[k]).collect()).collect(),
            order: mesh.order,
            displacement,
            stress,
            element_stress,
            imbalance: [0.0; 3],
        }
    }

    /// Transforms the result from unit size and modulus 1 to world axes.
    pub(super) fn placed(
        self,
        origin: Vec2,
        rotation: Matrix2<f64>,
        size: f64,
        modulus: f64,
        imbalance: [f64; 3],
    ) -> Self {
        let turn = |stress: [f64; 4]| {
            let [xx, yy, zz, xy] = stress.map(|s| s * modulus);
            let turned = rotation * Matrix2::new(xx, xy, xy, yy) * rotation.transpose();
            [turned[(0, 0)], turned[(1, 1)], zz, turned[(0, 1)]]
        };
        Recovered {
            nodes: self.nodes.iter().map(|x| origin + rotation * x * size).collect(),
            displacement: self.displacement.iter().map(|u| rotation * u * size).collect(),
            stress: self.stress.into_iter().map(turn).collect(),
            element_stress: self.element_stress.into_iter().map(turn).collect(),
            imbalance,
            ..self
        }
    }
}
