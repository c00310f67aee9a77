//! A shape: the mesh of a placed polygon in its own frame with its factorisation, for modulus 1, width 1 and area 1
//! (origin at the centroid, x along edge 0), and its response to forces on its points.

use super::element::{Reference, bilinear, inertia, stiffness, stiffness_of_strains, strain_operators};
use super::mesh::Mesh;
use crate::law::{Plane, PlaneElasticity};
use crate::linear::{Entries, SparseLdlt};
use crate::model::MeshDensity;
use crate::model::geometry::{Vec2, area_and_centroid, bounding_box, turned};
use nalgebra::{DMatrix, Matrix2};
use std::collections::BTreeSet;
use std::sync::Arc;

/// Greatest difference of congruent shapes and points, as a share of the size.
const CONGRUENT: f64 = 1e-9;
/// Greatest distance of a point outside an element, in the coordinates of the element: contact points are found with a
/// tolerance relative to the size of the scene.
const OUTSIDE: f64 = 1e-4;
/// Greatest residual of the solved equations, relative to loads and to stiffness × displacement.
const RESIDUAL: f64 = 1e-13;
/// Springs that hold a free mesh, at the ends of edge 0, which lies on the local x axis. They are statically
/// determinate, so their forces are zero for any stiffness.
pub(super) const SPRINGS: [usize; 3] = [0, 1, 3];

/// A placed polygon: vertex i of the shape is `origin` + Q × local vertex × `size`.
pub(super) struct Placement {
    /// The vertices in the frame of the shape.
    pub local: Vec<Vec2>,
    pub origin: Vec2,
    pub rotation: Matrix2<f64>,
    pub size: f64,
}

impl Placement {
    /// Places anticlockwise `vertices` \[m\]. An error names their fault.
    pub fn new(vertices: &[Vec2]) -> Result<Self, String> {
        if vertices.len() < 3 || vertices.iter().any(|v| !(v.x.is_finite() && v.y.is_finite())) {
            return Err("an elastic body needs three finite vertices or more".into());
        }
        let (area, origin) = area_and_centroid(vertices);
        let (low, high) = bounding_box(vertices);
        let edge = vertices[1] - vertices[0];
        if !(area > 1e-12 * (high - low).norm_squared() && edge.norm() > 0.0) {
            return Err(format!("an elastic body needs vertices that go round an area anticlockwise, not {area} m²"));
        }
        let size = area.sqrt();
        let x = edge.normalize();
        let rotation = Matrix2::from_columns(&[x, turned(x)]);
        let placement = Placement { local: Vec::new(), origin, rotation, size };
        Ok(Placement { local: vertices.iter().map(|v| placement.local(*v)).collect(), ..placement })
    }

    /// Returns a point \[m\] in the frame of the shape.
    pub fn local(&self, point: Vec2) -> Vec2 {
        self.rotation.transpose() * (point - self.origin) / self.size
    }
}

/// Returns true if two lists of points agree within `CONGRUENT`.
pub(super) fn agree(a: &[Vec2], b: &[Vec2]) -> bool {
    a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).amax() <= CONGRUENT)
}

/// The place of a point in the mesh: nodes with their shape functions.
pub(super) type Place = Vec<(usize, f64)>;

/// Share of a shape function that is rounding.
const NO_SHARE: f64 = 1e-14;

/// Places of points, and the elastic displacements of all nodes from forces there.
pub(super) struct Response {
    /// The places of the points.
    pub places: Vec<Place>,
    /// The places at which unit forces act: the loaded nodes, or the points if they are fewer.
    pub carriers: Vec<Place>,
    /// Shares of the carriers (index and share) in the force on a point, which are also those in its displacement.
    pub shares: Vec<Place>,
    /// Pᵀ Nᵀ: unit forces (x, y) on the carriers, balanced by inertia.
    pub loads: Vec<Vec<f64>>,
    /// Displacements of all nodes from these forces.
    pub displacements: Arc<DMatrix<f64>>,
}

impl Response {
    /// Computes the response of a shape. Errors are those of [`displacements`](Shape::displacements).
    pub fn new(shape: &Shape, places: Vec<Place>) -> Result<Self, String> {
        let loaded = |place: &Place| place.iter().copied().filter(|(_, share)| share.abs() > NO_SHARE).collect();
        let shares: Vec<Place> = places.iter().map(loaded).collect();
        let nodes: BTreeSet<usize> = shares.iter().flatten().map(|(node, _)| *node).collect();
        let (carriers, shares) = if nodes.len() < places.len() {
            let index = |node: usize| nodes.range(..node).count();
            let shares = shares.iter().map(|place| place.iter().map(|(node, share)| (index(*node), *share)).collect());
            (nodes.iter().map(|node| vec![(*node, 1.0)]).collect(), shares.collect())
        } else {
            (places.clone(), (0..places.len()).map(|point| vec![(point, 1.0)]).collect())
        };
        let mut loads = shape.loads_at(&carriers);
        let displacements = Arc::new(shape.displacements(loads.clone())?);
        shape.balanced(&mut loads);
        let loads = loads.column_iter().map(|load| load.as_slice().to_vec()).collect();
        Ok(Response { places, carriers, shares, loads, displacements })
    }

    /// Returns the forces (x, y) on the carriers from forces on the points.
    pub fn on_carriers(&self, forces: &[f64]) -> Vec<f64> {
        spread(&self.shares, self.carriers.len(), forces)
    }

    /// Returns the displacements of the points from unit forces on the points. `all`: displacements of all nodes from unit forces
    /// on the carriers.
    pub fn condensed(&self, all: &DMatrix<f64>) -> DMatrix<f64> {
        let carried = at_places(&self.carriers, all);
        at_places(&self.shares, &at_places(&self.shares, &carried).transpose()).transpose()
    }
}

/// The data that determine a shape.
#[derive(Clone, PartialEq)]
pub(super) struct Form {
    pub vertices: Vec<Vec2>,
    /// √area \[m\].
    pub size: f64,
    pub density: MeshDensity,
    pub elasticity: PlaneElasticity,
    pub plane: Plane,
    /// True if elements use strains of displacements, also if other elements are better for linear materials.
    pub of_strains: bool,
}

impl Form {
    /// Returns true if two bodies are congruent and have the same mesh and elements.
    pub fn is_congruent(&self, other: &Form) -> bool {
        self.elasticity == other.elasticity
            && self.of_strains == other.of_strains
            && self.density == other.density
            && (self.size / other.size - 1.0).abs() <= CONGRUENT
            && agree(&self.vertices, &other.vertices)
    }
}

/// A mesh with its factorisation, for modulus 1, width 1 and area 1, centroid at the origin.
pub(super) struct Shape {
    pub reference: Reference,
    pub elasticity: PlaneElasticity,
    pub mesh: Mesh,
    /// Stiffness with springs of stiffness 1 at `SPRINGS`.
    factorised: SparseLdlt,
    /// Greatest entry of the stiffness.
    stiffest: f64,
    /// M R: columns translation x, y, rotation about the centroid.
    inertia: DMatrix<f64>,
    /// R.
    rigid: DMatrix<f64>,
    /// Diagonal of Rᵀ M R: area twice, polar moment.
    masses: [f64; 3],
}

impl Shape {
    /// Meshes and factorises a shape. An error gives the reason why this is not possible.
    pub fn new(form: &Form) -> Result<Self, String> {
        let mesh = Mesh::new(&form.vertices, &form.density)?;
        let (reference, d) = (Reference::new(form.density.order), &form.elasticity.stiffness);
        let count = mesh.nodes.len();
        let mut entries: Entries = Vec::with_capacity(mesh.elements.len() * (2 * mesh.elements[0].len()).pow(2));
        entries.extend(SPRINGS.map(|dof| (dof, dof, 1.0)));
        let mut moments = vec![(0.0, Vec2::zeros()); count];
        for (index, nodes) in mesh.elements.iter().enumerate() {
            let corners = mesh.corners(index);
            let k = match form.of_strains {
                true => stiffness_of_strains(&strain_operators(&reference, &corners, form.plane), d),
                false => stiffness(&reference, &corners, d),
            };
            let row = |i: usize| 2 * nodes[i / 2] + i % 2;
            for j in 0..k.ncols() {
                entries.extend((0..k.nrows()).map(|i| (row(i), row(j), k[(i, j)])));
            }
            for (node, (mass, moment)) in nodes.iter().zip(inertia(&reference, &corners)) {
                moments[*node].0 += mass;
                moments[*node].1 += moment;
            }
        }
        let stiffest = entries.iter().fold(0.0f64, |max, entry| max.max(entry.2.abs()));
        let factorised =
            SparseLdlt::new(2 * count, 2 * count, &entries).ok_or("the stiffness of a body has no factorisation")?;
        let columns = |mass: f64, place: Vec2, i: usize| match i {
            0 => [mass, 0.0, -place.y],
            _ => [0.0, mass, place.x],
        };
        let inertia = DMatrix::from_fn(2 * count, 3, |i, j| columns(moments[i / 2].0, moments[i / 2].1, i % 2)[j]);
        let rigid = DMatrix::from_fn(2 * count, 3, |i, j| columns(1.0, mesh.nodes[i / 2], i % 2)[j]);
        let masses = [0, 1, 2].map(|i| rigid.column(i).dot(&inertia.column(i)));
        Ok(Shape { reference, elasticity: form.elasticity, mesh, factorised, stiffest, inertia, rigid, masses })
    }

    /// Returns the place of a point. The shape functions of an element are also correct a little outside it, so that
    /// resultants are exact.
    fn place(&self, point: Vec2) -> Option<Place> {
        let mut best: Option<(f64, usize, [f64; 2])> = None;
        for element in 0..self.mesh.elements.len() {
            let corners = self.mesh.corners(element);
            let (low, high) = bounding_box(&corners);
            let margin = OUTSIDE * (high - low).amax();
            if (0..2).any(|i| point[i] < low[i] - margin || point[i] > high[i] + margin) {
                continue;
            }
            let Some(place) = inverse(&corners, point) else { continue };
            let outside = place[0].abs().max(place[1].abs()) - 1.0;
            if best.is_none_or(|best| outside < best.0) {
                best = Some((outside, element, place));
            }
            if outside <= 0.0 {
                break;
            }
        }
        let (_, element, place) = best.filter(|best| best.0 <= OUTSIDE)?;
        let values = self.reference.at(place).values;
        Some(self.mesh.elements[element].iter().copied().zip(values).collect())
    }

    /// Returns the places of points given in the frame of the shape; `asked` are the same points in world axes. An
    /// error names a point outside the body.
    pub fn places(&self, points: &[Vec2], asked: &[Vec2]) -> Result<Vec<Place>, String> {
        let place = |(point, asked): (&Vec2, &Vec2)| {
            self.place(*point).ok_or_else(|| format!("the point ({}, {}) m lies outside its body", asked.x, asked.y))
        };
        points.iter().zip(asked).map(place).collect()
    }

    /// Computes P x.
    pub fn without_rigid_motion(&self, x: &mut DMatrix<f64>) {
        self.project(x, &self.rigid, &self.inertia);
    }

    /// Computes Pᵀ x.
    pub fn balanced(&self, x: &mut DMatrix<f64>) {
        self.project(x, &self.inertia, &self.rigid);
    }

    /// Returns Nᵀ: unit forces (x, y) at places.
    pub fn loads_at(&self, places: &[Place]) -> DMatrix<f64> {
        let mut loads = DMatrix::zeros(2 * self.mesh.nodes.len(), 2 * places.len());
        for (j, place) in places.iter().enumerate() {
            for &(node, value) in place {
                loads[(2 * node, 2 * j)] += value;
                loads[(2 * node + 1, 2 * j + 1)] += value;
            }
        }
        loads
    }

    /// Computes x − A (Rᵀ M R)⁻¹ Bᵀ x: P with A = R and B = M R, Pᵀ with A and B exchanged.
    fn project(&self, x: &mut DMatrix<f64>, along: &DMatrix<f64>, seen: &DMatrix<f64>) {
        let mut motion = seen.tr_mul(x);
        (0..3).for_each(|i| motion.row_mut(i).scale_mut(1.0 / self.masses[i]));
        x.gemm(-1.0, along, &motion, 1.0);
    }

    /// Returns P K⁺ Pᵀ times each column of `loads`, refined once and checked. Residuals are computed at projected
    /// displacements: displacements of the held mesh may be large rigid motions, which cost digits. An error if
    /// no solution is accurate enough.
    pub fn displacements(&self, mut loads: DMatrix<f64>) -> Result<DMatrix<f64>, String> {
        self.project(&mut loads, &self.inertia, &self.rigid);
        let solve = |mut right: DMatrix<f64>| {
            self.project(&mut right, &self.inertia, &self.rigid);
            let mut all = self.factorised.solve_columns(right)?;
            self.project(&mut all, &self.rigid, &self.inertia);
            Some(all)
        };
        let rest = |x: &DMatrix<f64>| {
            let mut rest = &loads - self.factorised.times(x);
            SPRINGS
                .iter()
                .for_each(|&dof| rest.row_mut(dof).iter_mut().zip(x.row(dof).iter()).for_each(|(r, x)| *r += x));
            rest
        };
        let unsolved = "the equations of an elastic body have no finite solution";
        let mut all = solve(loads.clone()).ok_or(unsolved)?;
        all += solve(rest(&all)).ok_or(unsolved)?;
        if all.is_empty() {
            return Ok(all);
        }
        let error = rest(&all).amax() / (loads.amax() + self.stiffest * all.amax()).max(f64::MIN_POSITIVE);
        if error.is_nan() || error > RESIDUAL {
            return Err(format!("the equations of an elastic body are solved to {error:.1e} only, not {RESIDUAL:.0e}"));
        }
        Ok(all)
    }

    /// Returns C̃ of places; `known` is C̃ of the first of them. Errors are those of
    /// [`displacements`](Self::displacements).
    pub fn flexibility(&self, places: &[Place], known: &DMatrix<f64>) -> Result<DMatrix<f64>, String> {
        let (columns, first) = (2 * places.len(), known.ncols());
        let added = at_places(places, &self.displacements(self.loads_at(&places[first / 2..]))?);
        // Symmetric except for rounding: the two triangles of added places come from different solutions.
        Ok(DMatrix::from_fn(columns, columns, |i, j| match (i < first, j < first) {
            (true, true) => known[(i, j)],
            (true, false) => added[(i, j - first)],
            (false, true) => added[(j, i - first)],
            (false, false) => 0.5 * (added[(i, j - first)] + added[(j, i - first)]),
        }))
    }
}

/// Inverts the bilinear map of an element at a point by Newton's method. `None` if it does not converge, which only
/// happens far outside the element.
fn inverse(corners: &[Vec2; 4], point: Vec2) -> Option<[f64; 2]> {
    let mut place = [0.0, 0.0];
    let mut last = f64::INFINITY;
    for _ in 0..50 {
        let (x, jacobian) = bilinear(corners, place);
        let step = jacobian.try_inverse()? * (point - x);
        place = [place[0] + step.x, place[1] + step.y];
        let size = step.amax();
        if size <= 1e-15 || (size < 1e-12 && size >= last) {
            return Some(place);
        }
        last = size;
    }
    (last < 1e-9).then_some(place)
}

/// Returns Nᵀ f: forces (x, y) on `count` nodes from forces on places.
pub(super) fn spread(places: &[Place], count: usize, forces: &[f64]) -> Vec<f64> {
    let mut on = vec![0.0; 2 * count];
    for (place, force) in places.iter().zip(forces.chunks(2)) {
        for &(node, value) in place {
            (0..2).for_each(|i| on[2 * node + i] += value * force[i]);
        }
    }
    on
}

/// Returns N x: rows (x, y) per place.
pub(super) fn at_places(places: &[Place], all: &DMatrix<f64>) -> DMatrix<f64> {
    let entry = |i: usize, j: usize| -> f64 {
        places[i / 2].iter().map(|&(node, value)| value * all[(2 * node + i % 2, j)]).sum()
    };
    DMatrix::from_fn(2 * places.len(), all.ncols(), entry)
}

/// Returns Q C̃ Qᵀ scale, block by block; exactly symmetric if C̃ is symmetric and `symmetric` is true.
pub(super) fn placed(local: &DMatrix<f64>, q: Matrix2<f64>, scale: f64, symmetric: bool) -> DMatrix<f64> {
    let mut turned = DMatrix::zeros(local.nrows(), local.ncols());
    for j in 0..local.ncols() / 2 {
        for i in 0..if symmetric { j + 1 } else { local.nrows() / 2 } {
            let block = local.fixed_view::<2, 2>(2 * i, 2 * j);
            let mut block = q * block * q.transpose() * scale;
            if symmetric {
                if i == j {
                    block = (block + block.transpose()) / 2.0;
                }
                turned.fixed_view_mut::<2, 2>(2 * j, 2 * i).copy_from(&block.transpose());
            }
            turned.fixed_view_mut::<2, 2>(2 * i, 2 * j).copy_from(&block);
        }
    }
    turned
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::law::Elasticity;

    /// The sparse flexibility C̃ of a mesh of a concave polygon equals a dense solution of another form: the stiffness
    /// bordered by the conditions of mean motion, solved by LU with complete pivoting.
    #[test]
    fn sparse_and_dense_routes_agree() {
        let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]].map(Vec2::from);
        for order in 1..=3 {
            let density = MeshDensity { elements: [2, 2], order, grading: [1.0; 2] };
            let placement = Placement::new(&outline).unwrap();
            let elasticity = PlaneElasticity::new(&Elasticity::isotropic(1.0, 0.25), Plane::Strain);
            let (vertices, size, plane) = (placement.local.clone(), placement.size, Plane::Strain);
            let form = Form { vertices, size, density, elasticity, plane, of_strains: false };
            let shape = Shape::new(&form).unwrap();
            let n = 2 * shape.mesh.nodes.len();
            let mut system = DMatrix::zeros(n + 3, n + 3);
            for (index, nodes) in shape.mesh.elements.iter().enumerate() {
                let k = stiffness(&shape.reference, &shape.mesh.corners(index), &shape.elasticity.stiffness);
                let row = |i: usize| 2 * nodes[i / 2] + i % 2;
                (0..k.nrows()).for_each(|i| (0..k.nrows()).for_each(|j| system[(row(i), row(j))] += k[(i, j)]));
            }
            system.view_mut((0, n), (n, 3)).copy_from(&shape.inertia);
            system.view_mut((n, 0), (3, n)).copy_from(&shape.inertia.transpose());
            let points = [[1.7, 0.0], [2.0, 0.4], [0.3, 2.0], [0.5, 0.5], [1.0, 1.0]].map(Vec2::from);
            let local: Vec<Vec2> = points.iter().map(|&p| placement.local(p)).collect();
            let places = shape.places(&local, &points).unwrap();
            let mut loads = DMatrix::zeros(n + 3, 2 * points.len());
            for (j, place) in places.iter().enumerate() {
                for &(node, value) in place {
                    (0..2).for_each(|i| loads[(2 * node + i, 2 * j + i)] += value);
                }
            }
            let expected = loads.transpose() * system.full_piv_lu().solve(&loads).unwrap();
            let found = shape.flexibility(&places, &DMatrix::zeros(0, 0)).unwrap();
            assert!((&found - &expected).amax() < 1e-12 * found.amax(), "order {order}");
            let first = found.view((0, 0), (6, 6)).into_owned();
            let extended = shape.flexibility(&places, &first).unwrap();
            assert!((&found - extended).amax() < 1e-12 * found.amax(), "order {order}, extended");
        }
    }

    /// Forces on many points act by the few loaded nodes, forces on few points by the points: the flexibility and the
    /// displacements of the nodes are those of forces on the points.
    #[test]
    fn forces_on_points_act_by_the_loaded_nodes() {
        let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [0.0, 1.0]].map(Vec2::from);
        let placement = Placement::new(&outline).unwrap();
        let elasticity = PlaneElasticity::new(&Elasticity::isotropic(1.0, 0.25), Plane::Stress);
        let (vertices, size, plane) = (placement.local.clone(), placement.size, Plane::Stress);
        let density = MeshDensity { elements: [3, 2], order: 1, grading: [1.0; 2] };
        let shape = Shape::new(&Form { vertices, size, density, elasticity, plane, of_strains: true }).unwrap();
        for (count, carriers) in [(9, 6), (2, 4)] {
            let on_side = |x: f64| (0..count).map(move |i| Vec2::new(x, (i as f64 + 0.5) / count as f64));
            let points: Vec<Vec2> = on_side(0.0).chain(on_side(2.0)).collect();
            let local: Vec<Vec2> = points.iter().map(|p| placement.local(*p)).collect();
            let places = shape.places(&local, &points).unwrap();
            let response = Response::new(&shape, places.clone()).unwrap();
            assert_eq!(response.carriers.len(), carriers);
            let expected = shape.flexibility(&places, &DMatrix::zeros(0, 0)).unwrap();
            let found = response.condensed(&response.displacements);
            assert!((&found - &expected).amax() < 1e-13 * expected.amax(), "{count} points");
            let forces: Vec<f64> = (0..4 * count).map(|i| (i as f64).sin()).collect();
            let by_points = shape.loads_at(&places) * DMatrix::from_column_slice(4 * count, 1, &forces);
            let on = response.on_carriers(&forces);
            let by_carriers = &*response.displacements * DMatrix::from_column_slice(on.len(), 1, &on);
            let exact = shape.displacements(by_points).unwrap();
            assert!((by_carriers - &exact).amax() < 1e-13 * exact.amax(), "{count} points");
        }
    }
}
