//! Bodies whose material yields: internal forces, tangent, and their condensation on the points where
//! something acts, once per iteration.
//!
//! With v the displacements of the nodes relative to the mean rigid motion (∫ v dA = 0, ∫ X × v dA = 0,
//! as for elastic bodies), B the strains at the Gauss points and f the forces on the points,
//!
//! ```text
//! f_int(v) = ∫ Bᵀ σ(B v, state) dA = Pᵀ Nᵀ f,    K = ∫ Bᵀ (∂σ/∂ε) B dA
//! v_{k+1} = v_k + P K⁺ (Pᵀ Nᵀ f_{k+1} − f_int(v_k)) = X f_{k+1} + x
//! u = N v = C f + c,    C = N X,   c = N x
//! ```
//!
//! so that Newton's method on (f, v) together needs C (not symmetric where flow is not associated) and the
//! offset c only. While nothing has yielded, X and C are those of the elastic body, x and c are zero, and
//! no matrix is factorised. Internal forces of symmetric stresses are in equilibrium for any v, so
//! gravity enters as for elastic bodies: it is the inertia relief of the forces on the points.
//!
//! Everything is in the shape's own frame with unit area, forces in E × width × size. An isotropic law
//! gives the same in any frame; states (plastic strains) are in the shape's frame.
//!
//! **Characteristic length** of a Gauss point: √A of its element, the width of the band into which
//! softening localises in a mesh of quadratic elements that are nearly square (Rots 1988, Computational
//! modeling of concrete fracture, section 5; Feenstra & de Borst 1996, Int. J. Numer. Methods Eng. 39).

use super::condensation::{Place, Placement, Response, SPRINGS, Shape, at_places, placed};
use super::element::{stiffness_of_strains, strain_operators};
use super::mesh::{Mesh, MeshDensity};
use super::{IsotropicElastic, Recovered};
use crate::assembly::Plane;
use crate::geometry::{Vec2, area_and_centroid};
use crate::lu::SparseLu;
use crate::material::Region;
use crate::material::plane::{PlanarPoint, PlanarUpdate};
use crate::sparse::Entries;
use nalgebra::{DMatrix, Matrix2};
use std::fmt;
use std::sync::Arc;

/// Greatest residual of the equations of a tangent, relative to loads and stiffness × displacement.
const RESIDUAL: f64 = 1e-10;
/// Share of the elastic stiffness that yielding points get where their tangent has no inverse. It
/// slows the iteration down; what it converges to is the same.
const SOFTEST: f64 = 1e-6;

/// Flexibility, relative to the elastic body's, from which a tangent counts as singular.
const LARGEST: f64 = 1e7;

/// √A of the greatest element \[m\] of a polygon's mesh, or why there is no mesh.
pub fn largest_element(vertices: &[Vec2], density: &MeshDensity) -> Result<f64, String> {
    let mesh = Mesh::new(vertices, density)?;
    Ok((0..mesh.elements.len()).map(|e| area_and_centroid(&mesh.corners(e)).0.sqrt()).fold(0.0, f64::max))
}

/// Strains at the quadrature points of a mesh of unit area.
pub(super) struct Strains {
    /// B and weight of each point, element by element.
    operators: Vec<Vec<(DMatrix<f64>, f64)>>,
    /// √A of each element.
    lengths: Vec<f64>,
}

impl Strains {
    pub fn new(shape: &Shape, plane: Plane) -> Self {
        let corners = (0..shape.mesh.elements.len()).map(|e| shape.mesh.corners(e));
        Strains {
            operators: corners.clone().map(|c| strain_operators(&shape.reference, &c, plane)).collect(),
            lengths: corners.map(|c| area_and_centroid(&c).0.sqrt()).collect(),
        }
    }
}

/// What a body of a yielding material remembers.
#[derive(Debug, Clone, PartialEq)]
pub struct InelasticState {
    /// State of the law, Gauss point by Gauss point.
    pub history: Vec<f64>,
    /// ε^p (xx, yy, zz, engineering xy) of each Gauss point in the shape's frame.
    pub plastic_strain: Vec<[f64; 4]>,
    /// Cumulated √(2/3 ε̇^p:ε̇^p) of each Gauss point.
    pub equivalent: Vec<f64>,
    /// The part of it that yielded under compression.
    pub crushed: Vec<f64>,
    /// Whether some point has ever yielded.
    pub yielded: bool,
    /// Plastic work so far \[J\].
    pub dissipated: f64,
}

/// A body of a yielding material, seen from some of its points.
#[derive(Clone)]
pub struct InelasticBody {
    shape: Arc<Shape>,
    strains: Arc<Strains>,
    places: Arc<Vec<Place>>,
    /// X of the elastic body.
    response: Arc<DMatrix<f64>>,
    /// C of the elastic body, in the world \[m/N\].
    flexibility: Arc<DMatrix<f64>>,
    origin: Vec2,
    rotation: Matrix2<f64>,
    size: f64,
    width: f64,
    material: IsotropicElastic,
    update: Arc<PlanarUpdate>,
}

impl fmt::Debug for InelasticBody {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_struct("InelasticBody").field("material", &self.material).finish_non_exhaustive()
    }
}

/// A body linearised at nodal displacements: u = C f + c at its points.
#[derive(Debug, Clone)]
pub struct Linearisation {
    /// C \[m/N\].
    pub flexibility: Arc<DMatrix<f64>>,
    /// c (x, y per point) \[m\].
    pub offset: Vec<f64>,
    /// X and x.
    response: Arc<DMatrix<f64>>,
    rest: Vec<f64>,
    /// Where: displacements of the nodes (x, y) in the shape's frame, in units of its size.
    pub displacement: Arc<Vec<f64>>,
    internal: Vec<f64>,
    /// What a step that ends here remembers.
    pub end: Arc<InelasticState>,
    /// Elastic energy \[J\].
    pub stored: f64,
    /// ∂(plastic work)/∂v \[J\].
    slope: Vec<f64>,
    /// Gauss points that yield in the step.
    pub yielding: usize,
    /// Matrices factorised for it.
    pub factorisations: u64,
}

impl InelasticBody {
    #[allow(clippy::too_many_arguments)]
    pub(super) fn new(
        shape: Arc<Shape>,
        strains: Arc<Strains>,
        (places, response): Response,
        flexibility: Arc<DMatrix<f64>>,
        placement: Placement,
        material: IsotropicElastic,
        update: Arc<PlanarUpdate>,
        width: f64,
    ) -> Self {
        let Placement { origin, rotation, size, .. } = placement;
        InelasticBody { shape, strains, places, response, flexibility, origin, rotation, size, width, material, update }
    }

    /// C of the elastic body \[m/N\].
    pub fn flexibility(&self) -> Arc<DMatrix<f64>> {
        self.flexibility.clone()
    }

    /// Number of Gauss points.
    pub fn gauss_points(&self) -> usize {
        self.strains.operators.iter().map(Vec::len).sum()
    }

    /// Number of nodes.
    pub fn nodes(&self) -> usize {
        self.shape.mesh.nodes.len()
    }

    /// Numbers in the law's state of a Gauss point.
    pub fn state_size(&self) -> usize {
        self.update.state_size()
    }

    /// Rows of Gauss points of the elements with a side between two points \[m\], from that side
    /// inwards: the length along the side that each stands for \[m\], and its points.
    pub fn rows_along(&self, from: Vec2, to: Vec2) -> Vec<(f64, Vec<usize>)> {
        let mut rows = Vec::new();
        let (points, n) = (&self.shape.reference.points, self.shape.reference.order + 1);
        let place = |local: Vec2| self.origin + self.rotation * local * self.size;
        for element in 0..self.shape.mesh.elements.len() {
            let corners = self.shape.mesh.corners(element).map(place);
            for side in 0..4 {
                let (a, b) = (corners[side], corners[(side + 1) % 4]);
                let off = |p: Vec2| crate::geometry::distance_to_segment(p, from, to);
                if off(a).max(off(b)) > 1e-7 * self.size {
                    continue;
                }
                // Point (i, j) is the one at i + n j; sides 0 and 2 run along i.
                let rule: f64 = points[..n].iter().map(|p| p.weight).sum();
                for (row, point) in points[..n].iter().enumerate() {
                    let inwards = (0..n).map(|k| if side % 2 == 0 { row + n * k } else { k + n * row });
                    let share = point.weight / rule;
                    rows.push(((b - a).norm() * share, inwards.map(|k| element * n * n + k).collect()));
                }
            }
        }
        rows
    }

    /// The state of the undeformed body.
    pub fn initial(&self) -> InelasticState {
        let (count, size) = (self.gauss_points(), self.update.state_size());
        let mut history = vec![0.0; count * size];
        history.chunks_mut(size).for_each(|state| self.update.initial_state(state));
        InelasticState {
            history,
            plastic_strain: vec![[0.0; 4]; count],
            equivalent: vec![0.0; count],
            crushed: vec![0.0; count],
            yielded: false,
            dissipated: 0.0,
        }
    }

    /// Forces (x, y per point) \[N\] in the body's axes as loads of the shape.
    fn local_forces(&self, forces: &[f64]) -> Vec<f64> {
        let scale = 1.0 / (self.material.young_modulus * self.width * self.size);
        let to_local = self.rotation.transpose() * scale;
        forces.chunks(2).flat_map(|f| <[f64; 2]>::from(to_local * Vec2::new(f[0], f[1]))).collect()
    }

    /// Displacements of the nodes by forces on the points, as the linearisation sees them.
    pub fn displaced(&self, linear: &Linearisation, forces: &[f64]) -> Vec<f64> {
        let mut all = linear.rest.clone();
        for (f, column) in self.local_forces(forces).iter().zip(linear.response.column_iter()) {
            if *f != 0.0 {
                all.iter_mut().zip(column.iter()).for_each(|(x, c)| *x += c * f);
            }
        }
        all
    }

    /// Displacements of the nodes of the elastic body.
    pub fn elastic_displacement(&self, forces: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; 2 * self.nodes()];
        for (f, column) in self.local_forces(forces).iter().zip(self.response.column_iter()) {
            all.iter_mut().zip(column.iter()).for_each(|(x, c)| *x += c * f);
        }
        all
    }

    /// Displacements (x, y) of the points from those of the nodes \[m\], in the body's axes.
    pub fn at_points(&self, displacement: &[f64]) -> Vec<f64> {
        let local = at_places(&self.places, &DMatrix::from_column_slice(displacement.len(), 1, displacement));
        let turn = self.rotation * self.size;
        local.as_slice().chunks(2).flat_map(|u| <[f64; 2]>::from(turn * Vec2::new(u[0], u[1]))).collect()
    }

    /// Greatest force on a node that internal forces leave \[N\].
    fn unbalanced(&self, internal: &[f64], forces: &[f64]) -> f64 {
        let mut rest = DMatrix::zeros(internal.len(), 1);
        for (place, f) in self.places.iter().zip(self.local_forces(forces).chunks(2)) {
            for &(node, value) in place {
                (0..2).for_each(|i| rest[(2 * node + i, 0)] += value * f[i]);
            }
        }
        self.shape.balanced(&mut rest);
        let left = rest.iter().zip(internal).map(|(f, own)| (f - own).abs());
        let worst = left.fold(0.0, |a: f64, x| if x.is_nan() { x } else { a.max(x) });
        worst * self.material.young_modulus * self.width * self.size
    }

    /// Greatest force on a node that the stresses at the linearisation's displacements leave \[N\].
    pub fn residual(&self, linear: &Linearisation, forces: &[f64]) -> f64 {
        self.unbalanced(&linear.internal, forces)
    }

    fn strains_at(&self, displacement: &[f64]) -> Vec<[f64; 3]> {
        let mut strains = Vec::with_capacity(self.gauss_points());
        for (nodes, operators) in self.shape.mesh.elements.iter().zip(&self.strains.operators) {
            for (b, _) in operators {
                let mut strain = [0.0; 3];
                for (a, node) in nodes.iter().enumerate() {
                    for k in 0..2 {
                        let u = displacement[2 * node + k];
                        (0..3).for_each(|i| strain[i] += b[(i, 2 * a + k)] * u);
                    }
                }
                strains.push(strain);
            }
        }
        strains
    }

    fn stresses(&self, strains: &[[f64; 3]], history: &[f64], new: &mut [f64]) -> Result<Vec<PlanarPoint>, String> {
        let lengths: Vec<f64> = self
            .strains
            .operators
            .iter()
            .zip(&self.strains.lengths)
            .flat_map(|(points, length)| std::iter::repeat_n(length * self.size, points.len()))
            .collect();
        let mut points = vec![PlanarPoint::ZERO; strains.len()];
        self.update
            .update(strains, &lengths, history, new, &mut points)
            .map_err(|wrong| format!("the stress at a Gauss point cannot be found: {wrong}"))?;
        Ok(points)
    }

    /// f_int of stresses.
    fn internal(&self, points: &[PlanarPoint]) -> Vec<f64> {
        let mut internal = vec![0.0; 2 * self.nodes()];
        let mut next = points.iter();
        for (nodes, operators) in self.shape.mesh.elements.iter().zip(&self.strains.operators) {
            for ((b, weight), point) in operators.iter().zip(&mut next) {
                let stress = point.stress.map(|s| s * weight / self.material.young_modulus);
                for (j, column) in b.column_iter().enumerate() {
                    internal[2 * nodes[j / 2] + j % 2] +=
                        column[0] * stress[0] + column[1] * stress[1] + column[2] * stress[2];
                }
            }
        }
        internal
    }

    /// ε^p of a strain and its stress: what Hooke's law does not explain.
    fn plastic_strain(&self, strain: &[f64; 3], point: &PlanarPoint) -> [f64; 4] {
        let IsotropicElastic { young_modulus: e, poisson_ratio: nu, .. } = self.material;
        let ([xx, yy, xy], zz) = (point.stress, point.stress_across);
        let direct = |s: f64| ((1.0 + nu) * s - nu * (xx + yy + zz)) / e;
        [
            strain[0] - direct(xx),
            strain[1] - direct(yy),
            point.strain_across - direct(zz),
            strain[2] - 2.0 * (1.0 + nu) * xy / e,
        ]
    }

    /// ∂(σ · Δε^p)/∂(ε_xx, ε_yy, γ_xy) of a point \[Pa\].
    fn dissipation_slope(&self, point: &PlanarPoint, step: &[f64; 4]) -> [f64; 3] {
        let IsotropicElastic { young_modulus: e, poisson_ratio: nu, .. } = self.material;
        let ([xx, yy, xy], zz) = (point.stress, point.stress_across);
        let mut slope = [0.0; 3];
        for (j, slope) in slope.iter_mut().enumerate() {
            let t = [point.tangent[0][j], point.tangent[1][j], point.tangent_across[j], point.tangent[2][j]];
            let trace = t[0] + t[1] + t[2];
            let direct = |s: f64| ((1.0 + nu) * s - nu * trace) / e;
            let elastic = [direct(t[0]), direct(t[1]), direct(t[2]), 2.0 * (1.0 + nu) * t[3] / e];
            let total = [f64::from(j == 0), f64::from(j == 1), 0.0, f64::from(j == 2)];
            let stress = [xx, yy, zz, xy];
            *slope = (0..4).map(|i| t[i] * step[i] + stress[i] * (total[i] - elastic[i])).sum();
        }
        slope
    }

    /// The body at displacements of its nodes, `start` being the state at the step's start. An error
    /// says why there are no stresses or no tangent.
    pub fn linearise(&self, displacement: Vec<f64>, start: &InelasticState) -> Result<Linearisation, String> {
        let (e, volume) = (self.material.young_modulus, self.size.powi(2) * self.width);
        let strains = self.strains_at(&displacement);
        let mut end = start.clone();
        let points = self.stresses(&strains, &start.history, &mut end.history)?;
        let (mut stored, mut slope, mut yielding) = (0.0, vec![0.0; displacement.len()], 0);
        let mut index = 0;
        for (nodes, operators) in self.shape.mesh.elements.iter().zip(&self.strains.operators) {
            for (b, weight) in operators {
                let (point, strain) = (&points[index], &strains[index]);
                let plastic = self.plastic_strain(strain, point);
                let elastic = [strain[0], strain[1], point.strain_across, strain[2]];
                let stress = [point.stress[0], point.stress[1], point.stress_across, point.stress[2]];
                stored += 0.5 * weight * volume * (0..4).map(|i| stress[i] * (elastic[i] - plastic[i])).sum::<f64>();
                if point.region != Region::Elastic {
                    let before = start.plastic_strain[index];
                    let step = [0, 1, 2, 3].map(|i| plastic[i] - before[i]);
                    let [x, y, z, xy] = step;
                    let equivalent = (2.0 / 3.0 * (x * x + y * y + z * z + 0.5 * xy * xy)).sqrt();
                    end.plastic_strain[index] = plastic;
                    end.equivalent[index] += equivalent;
                    if point.region != Region::Apex && stress[0] + stress[1] + stress[2] < 0.0 {
                        end.crushed[index] += equivalent;
                    }
                    end.dissipated += weight * volume * point.dissipation;
                    let by_strain = self.dissipation_slope(point, &step).map(|s| s * weight * volume);
                    for (j, column) in b.column_iter().enumerate() {
                        slope[2 * nodes[j / 2] + j % 2] +=
                            column[0] * by_strain[0] + column[1] * by_strain[1] + column[2] * by_strain[2];
                    }
                    yielding += 1;
                }
                index += 1;
            }
        }
        end.yielded |= yielding > 0;
        let internal = self.internal(&points);
        let (mut rest, mut response, mut flexibility) =
            (vec![0.0; displacement.len()], self.response.clone(), self.flexibility.clone());
        let mut factorisations = 0;
        if yielding > 0 {
            let mut solved = None;
            for share in [0.0, SOFTEST] {
                factorisations += 1;
                solved = self.solve(&points, &internal, share);
                if solved.is_some() {
                    break;
                }
            }
            let (x, own) = solved.ok_or("the tangent stiffness of a block that yields has no inverse")?;
            rest = displacement.iter().zip(own.iter()).map(|(v, own)| v - own).collect();
            let scale = 1.0 / (e * self.width);
            flexibility = Arc::new(placed(&at_places(&self.places, &x), self.rotation, scale, false));
            response = Arc::new(x);
        } else if start.yielded {
            let own = self.shape.displacements(DMatrix::from_column_slice(internal.len(), 1, &internal))?;
            rest = displacement.iter().zip(own.iter()).map(|(v, own)| v - own).collect();
        }
        let offset = self.at_points(&rest);
        Ok(Linearisation {
            flexibility,
            offset,
            response,
            rest,
            displacement: Arc::new(displacement),
            internal,
            end: Arc::new(end),
            stored,
            slope,
            yielding,
            factorisations,
        })
    }

    /// P K⁺ Pᵀ Nᵀ and P K⁺ f_int for the tangents of points that yield, the elastic stiffness elsewhere.
    fn solve(&self, points: &[PlanarPoint], internal: &[f64], share: f64) -> Option<(DMatrix<f64>, Vec<f64>)> {
        let e = self.material.young_modulus;
        let size = internal.len();
        let mut entries: Entries = Vec::new();
        entries.extend(SPRINGS.map(|dof| (dof, dof, 1.0)));
        let mut first = 0;
        let hooke = super::element::Hooke::new(self.update.plane(), self.material.poisson_ratio);
        for (nodes, operators) in self.shape.mesh.elements.iter().zip(&self.strains.operators) {
            let here = &points[first..first + operators.len()];
            first += operators.len();
            let k = if here.iter().all(|point| point.region == Region::Elastic) {
                stiffness_of_strains(operators, hooke)
            } else {
                let mut k = DMatrix::zeros(2 * nodes.len(), 2 * nodes.len());
                for ((b, weight), point) in operators.iter().zip(here) {
                    let mut d = nalgebra::Matrix3::from_fn(|i, j| point.tangent[i][j] / e);
                    if point.region != Region::Elastic {
                        d += hooke.stiffness() * share;
                    }
                    k += b.transpose() * (d * *weight) * b;
                }
                k
            };
            let row = |i: usize| 2 * nodes[i / 2] + i % 2;
            for j in 0..k.ncols() {
                entries.extend((0..k.nrows()).map(|i| (row(i), row(j), k[(i, j)])));
            }
        }
        let stiffest = entries.iter().fold(0.0f64, |max, entry| max.max(entry.2.abs()));
        let factors = SparseLu::new(size, &entries)?;
        let mut loads = self.shape.loads_at(&self.places);
        self.shape.balanced(&mut loads);
        let mut right: Vec<Vec<f64>> = loads.column_iter().map(|c| c.iter().copied().collect()).collect();
        right.push(internal.to_vec());
        let all = factors.solve(&right, 1)?;
        let mut all = DMatrix::from_fn(size, all.len(), |i, j| all[j][i]);
        self.shape.without_rigid_motion(&mut all);
        let largest = all.columns(0, right.len() - 1).amax();
        if largest.is_nan() || largest > LARGEST * self.response.amax() {
            return None;
        }
        let mut left = DMatrix::from_fn(size, right.len(), |i, j| right[j][i]);
        for &(i, j, value) in entries.iter().skip(SPRINGS.len()) {
            for c in 0..left.ncols() {
                left[(i, c)] -= value * all[(j, c)];
            }
        }
        for (c, right) in right.iter().enumerate() {
            let load = right.iter().fold(0.0f64, |a, x| a.max(x.abs()));
            let error = left.column(c).amax() / (load + stiffest * all.column(c).amax()).max(f64::MIN_POSITIVE);
            if error.is_nan() || error > RESIDUAL {
                return None;
            }
        }
        let own = all.column(right.len() - 1).iter().copied().collect();
        Some((all.columns(0, right.len() - 1).into_owned(), own))
    }

    /// ∂(plastic work of the step)/∂(forces on the points) \[J/N\].
    pub fn dissipation_by_force(&self, linear: &Linearisation) -> Vec<f64> {
        if linear.yielding == 0 {
            return vec![0.0; 2 * self.places.len()];
        }
        let scale = 1.0 / (self.material.young_modulus * self.width * self.size);
        let local: Vec<f64> = linear
            .response
            .column_iter()
            .map(|column| column.iter().zip(&linear.slope).map(|(x, s)| x * s).sum::<f64>() * scale)
            .collect();
        local.chunks(2).flat_map(|s| <[f64; 2]>::from(self.rotation * Vec2::new(s[0], s[1]))).collect()
    }

    /// Recomputes a state from displacements and history alone: the greatest unbalanced force on a
    /// node \[N\] with stresses that the law itself gives there, and how much the law would still change
    /// the history, relative to the greatest strain: 0 where no stress lies beyond the yield surface.
    pub fn check(&self, displacement: &[f64], history: &[f64], forces: &[f64]) -> Result<[f64; 2], String> {
        if displacement.len() != 2 * self.nodes() || history.len() != self.gauss_points() * self.state_size() {
            return Err("the state of a block does not fit its mesh".into());
        }
        let strains = self.strains_at(displacement);
        let mut new = history.to_vec();
        let points = self.stresses(&strains, history, &mut new)?;
        let largest = strains.iter().flatten().fold(0.0f64, |a, x| a.max(x.abs())).max(f64::MIN_POSITIVE);
        // ε_zz of plane stress is no memory.
        let (size, own) = (self.state_size(), self.update.law().state_size());
        let both = new.iter().zip(history).enumerate().filter(|(i, _)| i % size < own);
        let drift = both.map(|(_, (a, b))| (a - b).abs()).fold(0.0, f64::max) / largest;
        Ok([self.unbalanced(&self.internal(&points), forces), drift])
    }

    /// Displacements and stresses of the whole mesh in world axes of the undeformed placement. Stresses at
    /// nodes are those of the Gauss points next to them, so that none lies beyond the yield surface. Also
    /// σ_zz \[Pa\] at the nodes and in the elements.
    pub fn recover(&self, displacement: &[f64], state: &InelasticState) -> Result<(Recovered, [Vec<f64>; 2]), String> {
        let strains = self.strains_at(displacement);
        let mut new = state.history.clone();
        let points = self.stresses(&strains, &state.history, &mut new)?;
        let mesh = &self.shape.mesh;
        let mut sums = vec![([0.0; 3], 0.0, 0.0); mesh.nodes.len()];
        let mut element_across = Vec::with_capacity(mesh.elements.len());
        let mut element_stress = Vec::with_capacity(mesh.elements.len());
        let per = self.strains.operators[0].len();
        for (index, nodes) in mesh.elements.iter().enumerate() {
            let here = &points[index * per..(index + 1) * per];
            for (node, point) in nodes.iter().zip(here) {
                (0..3).for_each(|i| sums[*node].0[i] += point.stress[i]);
                sums[*node].1 += point.stress_across;
                sums[*node].2 += 1.0;
            }
            let weights = &self.strains.operators[index];
            let area: f64 = weights.iter().map(|w| w.1).sum();
            element_stress
                .push([0, 1, 2].map(|i| here.iter().zip(weights).map(|(p, w)| p.stress[i] * w.1).sum::<f64>() / area));
            element_across.push(here.iter().zip(weights).map(|(p, w)| p.stress_across * w.1).sum::<f64>() / area);
        }
        let across = sums.iter().map(|(_, zz, count)| zz / count).collect();
        let local: Vec<Vec2> = displacement.chunks(2).map(|u| Vec2::new(u[0], u[1])).collect();
        let stress = sums.into_iter().map(|(sum, _, count)| sum.map(|s| s / count)).collect();
        let recovered = Recovered::with(mesh, local, stress, element_stress);
        let placed = recovered.placed(self.origin, self.rotation, self.size, 1.0, [0.0; 3]);
        Ok((placed, [across, element_across]))
    }

    /// Mean over each element of a value of its Gauss points.
    pub fn by_element(&self, values: &[f64]) -> Vec<f64> {
        let mut next = values.iter();
        let mean = |points: &Vec<(DMatrix<f64>, f64)>| {
            let area: f64 = points.iter().map(|p| p.1).sum();
            points.iter().zip(&mut next).map(|(p, value)| p.1 * value).sum::<f64>() / area
        };
        self.strains.operators.iter().map(mean).collect()
    }
}
