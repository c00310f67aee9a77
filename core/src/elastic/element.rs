//! One finite element: its map, stiffness and stresses, always for modulus 1 and width 1.
//!
//! Displacement elements (orders 2 and 3): K = ∫ Bᵀ D B dA with (order + 1)² Gauss points, where D is the operator of
//! the plane problem.
//!
//! Order 1 (Pian & Sumihara 1984, eq. 25): σ = P β, H = ∫ Pᵀ S P dA, G = ∫ Pᵀ B dA, K = Gᵀ H⁻¹ G, β = H⁻¹ G u, with S =
//! D⁻¹. P has the three uniform stresses and two linear ones, t₁ ⊗ t₁ η and t₃ ⊗ t₃ ξ, along the mean axes t₁, t₃ of
//! the element.

use super::quadrature::{gauss, lagrange, lagrange_slopes, lobatto};
use crate::law::Plane;
use crate::model::geometry::Vec2;
use nalgebra::{DMatrix, Matrix2, Matrix3, Matrix5, SMatrix, SVector, Vector3};

/// Shape functions at one point of the reference square \[−1, 1\]².
#[derive(Debug, Clone)]
pub struct ShapeValues {
    /// N of each node.
    pub values: Vec<f64>,
    /// ∂N/∂ξ and ∂N/∂η of each node.
    pub slopes: Vec<[f64; 2]>,
    /// Coordinates (ξ, η) of the point.
    pub place: [f64; 2],
    /// Weight of the quadrature; 0 if it is not a quadrature point.
    pub weight: f64,
}

/// Data of elements of one order that do not depend on their shape.
#[derive(Debug, Clone)]
pub struct Reference {
    pub order: usize,
    /// Node coordinates in one direction.
    pub nodes: Vec<f64>,
    /// Quadrature points, (order + 1)².
    pub points: Vec<ShapeValues>,
}

impl Reference {
    /// Creates the data of elements of this order, with (order + 1)² Gauss points.
    pub fn new(order: usize) -> Self {
        let nodes = lobatto(order + 1).0;
        let mut reference = Reference { order, nodes, points: Vec::new() };
        let (places, weights) = gauss(order + 1);
        for (eta, w) in places.iter().zip(&weights) {
            for (xi, v) in places.iter().zip(&weights) {
                let point = reference.at([*xi, *eta]);
                reference.points.push(ShapeValues { weight: v * w, ..point });
            }
        }
        reference
    }

    /// Returns the shape functions at a point.
    pub fn at(&self, place: [f64; 2]) -> ShapeValues {
        let [along, across] = place.map(|x| (lagrange(&self.nodes, x), lagrange_slopes(&self.nodes, x)));
        let n = self.nodes.len();
        let pairs = || (0..n * n).map(move |k| (k % n, k / n));
        ShapeValues {
            values: pairs().map(|(i, j)| along.0[i] * across.0[j]).collect(),
            slopes: pairs().map(|(i, j)| [along.1[i] * across.0[j], along.0[i] * across.1[j]]).collect(),
            place,
            weight: 0.0,
        }
    }
}

/// The bilinear map of an element: returns the position and the Jacobian ∂x_i/∂ξ_j.
pub fn bilinear(corners: &[Vec2; 4], [xi, eta]: [f64; 2]) -> (Vec2, Matrix2<f64>) {
    let [a, b, c, d] = corners;
    let place = (a * (1.0 - xi) + b * (1.0 + xi)) * ((1.0 - eta) / 4.0)
        + (d * (1.0 - xi) + c * (1.0 + xi)) * ((1.0 + eta) / 4.0);
    let along = ((b - a) * (1.0 - eta) + (c - d) * (1.0 + eta)) / 4.0;
    let across = ((d - a) * (1.0 - xi) + (c - b) * (1.0 + xi)) / 4.0;
    (place, Matrix2::from_columns(&[along, across]))
}

/// Returns ∇N of each node and the determinant of the Jacobian.
fn gradients(corners: &[Vec2; 4], shape: &ShapeValues) -> (Vec<Vec2>, f64) {
    let (_, jacobian) = bilinear(corners, shape.place);
    let determinant = jacobian.determinant();
    let (j, d) = (jacobian, determinant);
    let gradient = |[along, across]: &[f64; 2]| {
        Vec2::new((j[(1, 1)] * along - j[(1, 0)] * across) / d, (j[(0, 0)] * across - j[(0, 1)] * along) / d)
    };
    (shape.slopes.iter().map(gradient).collect(), determinant)
}

/// Returns ∫ N_a dA and ∫ N_a x dA of each node: the contribution of the element to M R.
pub fn inertia(reference: &Reference, corners: &[Vec2; 4]) -> Vec<(f64, Vec2)> {
    let mut sums = vec![(0.0, Vec2::zeros()); reference.nodes.len().pow(2)];
    for point in &reference.points {
        let (place, jacobian) = bilinear(corners, point.place);
        let area = point.weight * jacobian.determinant();
        for (sum, value) in sums.iter_mut().zip(&point.values) {
            sum.0 += value * area;
            sum.1 += place * (value * area);
        }
    }
    sums
}

/// Returns the stiffness of the element, with rows and columns (x, y) per node.
pub fn stiffness(reference: &Reference, corners: &[Vec2; 4], d: &Matrix3<f64>) -> DMatrix<f64> {
    if reference.order == 1 {
        let hybrid = Hybrid::new(reference, corners, d);
        let k = hybrid.coupling.transpose() * hybrid.stresses_from_displacements();
        return DMatrix::from_fn(8, 8, |i, j| 0.5 * (k[(i, j)] + k[(j, i)]));
    }
    let count = reference.nodes.len().pow(2);
    let mut k = DMatrix::zeros(2 * count, 2 * count);
    // Terms that vanish for an isotropic material are separate: mirrored elements then stay mirrored to the last bit.
    let other = [d.m11, d.m22].map(|direct| direct - (d.m12 + 2.0 * d.m33));
    for point in &reference.points {
        let (gradient, determinant) = gradients(corners, point);
        let area = point.weight * determinant;
        for b in 0..count {
            let h = gradient[b] * area;
            for a in 0..=b {
                let g = gradient[a];
                let (xx, yy, xy) = (g.x * h.x, g.y * h.y, g.x * h.y + g.y * h.x);
                let both = d.m33 * (xx + yy);
                k[(2 * a, 2 * b)] += (d.m12 + d.m33) * xx + both + (other[0] * xx + d.m13 * xy);
                k[(2 * a + 1, 2 * b + 1)] += (d.m12 + d.m33) * yy + both + (other[1] * yy + d.m23 * xy);
                let shear = d.m13 * xx + d.m23 * yy;
                k[(2 * a, 2 * b + 1)] += d.m12 * g.x * h.y + d.m33 * g.y * h.x + shear;
                k[(2 * a + 1, 2 * b)] += d.m12 * g.y * h.x + d.m33 * g.x * h.y + shear;
            }
        }
    }
    k.fill_lower_triangle_with_upper_triangle();
    k
}

/// Returns B of each quadrature point, (ε_xx, ε_yy, γ_xy) from (x, y) per node, with its share of the area. These are
/// strains of the displacements, which a yielding material needs. For orders 2 and 3 they are the strains of
/// [`stiffness`]. For order 1 in plane strain the dilatation is replaced by its mean over the element, half in each
/// direction, so that volume-preserving flow does not lock (Nagtegaal, Parks & Rice 1974, Comput. Methods Appl. Mech.
/// Engng 4, 153–177; Hughes 1980, Int. J. Numer. Methods Eng. 15, 1413–1418). This element is too stiff in bending,
/// like all bilinear displacements.
pub fn strain_operators(reference: &Reference, corners: &[Vec2; 4], plane: Plane) -> Vec<(DMatrix<f64>, f64)> {
    let mut all: Vec<(DMatrix<f64>, f64)> = Vec::with_capacity(reference.points.len());
    for point in &reference.points {
        let (gradient, determinant) = gradients(corners, point);
        let mut b = DMatrix::zeros(3, 2 * gradient.len());
        for (a, g) in gradient.iter().enumerate() {
            b[(0, 2 * a)] = g.x;
            b[(1, 2 * a + 1)] = g.y;
            b[(2, 2 * a)] = g.y;
            b[(2, 2 * a + 1)] = g.x;
        }
        all.push((b, point.weight * determinant));
    }
    if reference.order == 1 && plane == Plane::Strain {
        let area: f64 = all.iter().map(|(_, weight)| weight).sum();
        let columns = all[0].0.ncols();
        let mean: Vec<f64> =
            (0..columns).map(|j| all.iter().map(|(b, w)| (b[(0, j)] + b[(1, j)]) * w).sum::<f64>() / area).collect();
        for (b, _) in &mut all {
            for (j, mean) in mean.iter().enumerate() {
                let correction = 0.5 * (mean - b[(0, j)] - b[(1, j)]);
                b[(0, j)] += correction;
                b[(1, j)] += correction;
            }
        }
    }
    all
}

/// Returns K of strains from [`strain_operators`].
pub fn stiffness_of_strains(operators: &[(DMatrix<f64>, f64)], d: &Matrix3<f64>) -> DMatrix<f64> {
    let columns = operators[0].0.ncols();
    let mut k = DMatrix::zeros(columns, columns);
    for (b, weight) in operators {
        k += b.transpose() * (d * *weight) * b;
    }
    k
}

/// The hybrid-stress element of Pian and Sumihara.
struct Hybrid {
    /// H⁻¹.
    inverse: Matrix5<f64>,
    /// G.
    coupling: SMatrix<f64, 5, 8>,
    /// t₁ ⊗ t₁ and t₃ ⊗ t₃ as (xx, yy, xy).
    modes: [[f64; 3]; 2],
}

impl Hybrid {
    fn new(reference: &Reference, corners: &[Vec2; 4], d: &Matrix3<f64>) -> Self {
        let (_, middle) = bilinear(corners, [0.0, 0.0]);
        let modes = [0, 1].map(|i| {
            let t = middle.column(i).normalize();
            [t[0] * t[0], t[1] * t[1], t[0] * t[1]]
        });
        let mut hybrid = Hybrid { inverse: Matrix5::zeros(), coupling: SMatrix::zeros(), modes };
        let compliance = d.try_inverse().unwrap_or(Matrix3::repeat(f64::NAN));
        let mut h = Matrix5::zeros();
        for point in &reference.points {
            let (gradient, determinant) = gradients(corners, point);
            let area = point.weight * determinant;
            let p = hybrid.field(point.place);
            let mut b = SMatrix::<f64, 3, 8>::zeros();
            for (a, g) in gradient.iter().enumerate() {
                b[(0, 2 * a)] = g.x;
                b[(1, 2 * a + 1)] = g.y;
                b[(2, 2 * a)] = g.y;
                b[(2, 2 * a + 1)] = g.x;
            }
            h += p.transpose() * compliance * p * area;
            hybrid.coupling += p.transpose() * b * area;
        }
        // H is positive definite for any convex element. A failure gives NaN in the residual that checks every
        // solution.
        hybrid.inverse = h.cholesky().map_or(Matrix5::repeat(f64::NAN), |c| c.inverse());
        hybrid
    }

    /// Returns P at a point.
    fn field(&self, [xi, eta]: [f64; 2]) -> SMatrix<f64, 3, 5> {
        let [one, three] = self.modes;
        SMatrix::from_fn(|i, j| match j {
            3 => one[i] * eta,
            4 => three[i] * xi,
            _ => f64::from(i == j),
        })
    }

    fn stresses_from_displacements(&self) -> SMatrix<f64, 5, 8> {
        self.inverse * self.coupling
    }
}

/// Returns the stresses (xx, yy, xy) at the nodes and the centre of the element from the displacements of its nodes.
/// Orders 2 and 3: extrapolated from order × order Gauss points, where derivatives are most accurate (Barlow 1976, Int.
/// J. Numer. Methods Eng. 10, 243–251). Order 1: the stresses of the hybrid element.
pub fn stresses(
    reference: &Reference,
    corners: &[Vec2; 4],
    d: &Matrix3<f64>,
    displacement: &[Vec2],
) -> (Vec<[f64; 3]>, [f64; 3]) {
    let grid: Vec<[f64; 2]> =
        reference.nodes.iter().flat_map(|&eta| reference.nodes.iter().map(move |&xi| [xi, eta])).collect();
    if reference.order == 1 {
        let hybrid = Hybrid::new(reference, corners, d);
        let u = SVector::<f64, 8>::from_fn(|i, _| displacement[i / 2][i % 2]);
        let beta = hybrid.stresses_from_displacements() * u;
        let at = |place: [f64; 2]| <[f64; 3]>::from(hybrid.field(place) * beta);
        return (grid.into_iter().map(at).collect(), at([0.0, 0.0]));
    }
    let sampling = gauss(reference.order).0;
    let sample = |place: [f64; 2]| {
        let (gradient, _) = gradients(corners, &reference.at(place));
        let sum = gradient.iter().zip(displacement).fold(Matrix2::zeros(), |sum, (g, u)| sum + u * g.transpose());
        <[f64; 3]>::from(d * Vector3::new(sum.m11, sum.m22, sum.m12 + sum.m21))
    };
    let samples: Vec<[f64; 3]> =
        sampling.iter().flat_map(|&eta| sampling.iter().map(move |&xi| [xi, eta])).map(sample).collect();
    let at = |[xi, eta]: [f64; 2]| {
        let (along, across) = (lagrange(&sampling, xi), lagrange(&sampling, eta));
        let mut stress = [0.0; 3];
        for (k, sample) in samples.iter().enumerate() {
            let factor = along[k % sampling.len()] * across[k / sampling.len()];
            (0..3).for_each(|i| stress[i] += factor * sample[i]);
        }
        stress
    };
    (grid.into_iter().map(at).collect(), at([0.0, 0.0]))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::{Elasticity, PlaneElasticity};

    const CORNERS: [[f64; 2]; 4] = [[0.0, 0.0], [2.0, 0.2], [1.7, 1.1], [-0.1, 0.9]];

    /// Each element has exactly three motions without energy, and a uniform strain has the energy ½ σ·ε A: for both
    /// plane states and every order, on a distorted element.
    #[test]
    fn rigid_motions_and_uniform_strains() {
        let corners = CORNERS.map(Vec2::from);
        let area = crate::model::geometry::area_and_centroid(&corners).0;
        for (order, plane) in [1, 2, 3].iter().flat_map(|&p| [(p, Plane::Strain), (p, Plane::Stress)]) {
            let reference = Reference::new(order);
            let d = PlaneElasticity::new(&Elasticity::isotropic(1.0, 0.3), plane).stiffness;
            let k = stiffness(&reference, &corners, &d);
            let values = k.clone().symmetric_eigenvalues();
            let zero = values.iter().filter(|v| v.abs() < 1e-12).count();
            assert_eq!((zero, values.min() > -1e-12), (3, true), "order {order}");
            let strain = Matrix2::new(1.0, 0.4, -0.1, -0.5);
            let place = |k: usize| {
                let n = order + 1;
                bilinear(&corners, [reference.nodes[k % n], reference.nodes[k / n]]).0
            };
            let nodes: Vec<Vec2> = (0..reference.nodes.len().pow(2)).map(|k| strain * place(k)).collect();
            let u = nalgebra::DVector::from_fn(k.nrows(), |i, _| nodes[i / 2][i % 2]);
            let stress = d * Vector3::new(1.0, -0.5, 0.3);
            let energy = 0.5 * area * (stress[0] * 1.0 + stress[1] * -0.5 + stress[2] * 0.3);
            assert!((0.5 * u.dot(&(&k * &u)) - energy).abs() < 1e-13, "order {order}");
            let (at_nodes, middle) = stresses(&reference, &corners, &d, &nodes);
            for found in at_nodes.iter().chain([&middle]) {
                assert!((0..3).all(|i| (found[i] - stress[i]).abs() < 1e-13), "order {order}: {found:?} {stress:?}");
            }
        }
    }
}
