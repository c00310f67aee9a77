//! Bodies whose material yields: internal forces, tangent, and their condensation onto the points at which forces act,
//! once per iteration.
//!
//! Let v be the displacements of the nodes relative to the mean rigid motion (∫ v dA = 0, ∫ X × v dA = 0, as for
//! elastic bodies), B the strains at the Gauss points and f the forces on the points:
//!
//! ```text
//! f_int(v) = ∫ Bᵀ σ(B v, state) dA = Pᵀ Nᵀ f,    K = ∫ Bᵀ (∂σ/∂ε) B dA
//! v_{k+1} = v_k + P K⁺ (Pᵀ Nᵀ f_{k+1} − f_int(v_k)) = X f_{k+1} + x
//! u = N v = C f + c,    C = N X,   c = N x
//! ```
//!
//! Newton's method on (f, v) together therefore only needs C (not symmetric if flow is not associated) and the offset
//! c. Before yielding X and C are those of the elastic body, x and c are zero, and no matrix is factorised. Internal
//! forces of symmetric stresses are in equilibrium for any v. Gravity therefore acts as on elastic bodies: it is the
//! inertia relief of the forces on the points.
//!
//! All quantities (strains, stresses, plastic strains and the axes of the material) are in the frame of the shape with
//! unit area, forces in units of modulus × width × size.
//!
//! **Characteristic length** of a Gauss point: √A of its element (Rots 1988, Computational modeling of concrete
//! fracture, section 5). Strain localises in a band one element wide, h∥ along the compression, so that the energy per
//! area is h∥/√A times that of the law: this is right for nearly square elements. It holds for order 1, whose strain
//! along the normal of the band is constant in the element. With order 2 the strain is linear and, with Gauss points −,
//! 0, +, equilibrium of the middle node only requires σ₋ = σ₊. One outer point may then unload while the other softens
//! and the middle point follows with half of its strain, so that 13/18 of the element take part. Softening is therefore
//! only for elements of order 1.

use super::element::{bilinear, stiffness_of_strains, strain_operators};
use super::mesh::Mesh;
use super::shape::{Placement, Response, Shape, at_places, spread};
use super::stress::Recovered;
use crate::law::{Elasticity, PlanarPoint, PlanarUpdate, Plane, UpdateContext, Voigt};
use crate::linear::Analysis;
use crate::model::geometry::{Vec2, area_and_centroid};
use crate::model::{Assembly, MeshDensity};
use nalgebra::{DMatrix, Matrix2};
use std::fmt;
use std::sync::{Arc, Mutex};

/// Returns √A of the greatest element \[m\] of a polygon's mesh. An error gives the reason why there is no mesh.
fn largest_element(vertices: &[Vec2], density: &MeshDensity) -> Result<f64, String> {
    let mesh = Mesh::new(vertices, density)?;
    Ok((0..mesh.elements.len()).map(|e| area_and_centroid(&mesh.corners(e)).0.sqrt()).fold(0.0, f64::max))
}

/// Checks that the elements of a body are small enough for its softening material: larger elements would snap back.
/// The error gives both sizes and the change that is needed.
pub fn fine_enough(assembly: &Assembly, body: usize) -> Result<(), String> {
    let (name, material) = &assembly.catalogue.materials[assembly.bodies[body].material];
    let Some(update) = material.inelastic() else { return Ok(()) };
    let (most, own) = (update.largest_length(), largest_element(&assembly.bodies[body].vertices, &assembly.mesh)?);
    if own <= most {
        return Ok(());
    }
    Err(format!(
        "elements of \"{}\" have the size √area = {own:.4e} m; material \"{name}\" softens too steeply for more than \
         {most:.4e} m: use more elements, or raise its fracture energy",
        assembly.bodies[body].name
    ))
}

/// Strains at the quadrature points of a mesh of unit area.
pub(super) struct Strains {
    /// B and weight of each point, element by element.
    pub(super) operators: Vec<Vec<(DMatrix<f64>, f64)>>,
    /// √A of each element.
    lengths: Vec<f64>,
    /// Stiffness of each element while it is elastic.
    pub(super) elastic: Vec<DMatrix<f64>>,
    /// Order of elimination of the tangents, which all have the same pattern.
    pub(super) analysis: Mutex<Analysis>,
}

impl Strains {
    /// Computes B, weights, lengths and elastic stiffness of all elements of a shape.
    pub fn new(shape: &Shape, plane: Plane) -> Self {
        let corners = (0..shape.mesh.elements.len()).map(|e| shape.mesh.corners(e));
        let operators: Vec<_> = corners.clone().map(|c| strain_operators(&shape.reference, &c, plane)).collect();
        let elastic = operators.iter().map(|own| stiffness_of_strains(own, &shape.elasticity.stiffness)).collect();
        let lengths = corners.map(|c| area_and_centroid(&c).0.sqrt()).collect();
        Strains { operators, lengths, elastic, analysis: Mutex::default() }
    }
}

/// Adds the columns of a matrix times their weights to a vector, four columns at a time, in the order of the columns.
pub(super) fn add_columns(sum: &mut [f64], matrix: &DMatrix<f64>, weights: &[f64]) {
    let column = |j: usize| &matrix.as_slice()[j * matrix.nrows()..(j + 1) * matrix.nrows()];
    let (four, rest) = weights.as_chunks::<4>();
    for (group, w) in four.iter().enumerate() {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| column(4 * group + k));
        for ((((x, a), b), c), d) in sum.iter_mut().zip(a).zip(b).zip(c).zip(d) {
            *x = *x + a * w[0] + b * w[1] + c * w[2] + d * w[3];
        }
    }
    for (k, w) in rest.iter().enumerate() {
        sum.iter_mut().zip(column(4 * four.len() + k)).for_each(|(x, a)| *x += a * w);
    }
}

/// The state of a body whose material yields.
#[derive(Debug, Clone, PartialEq)]
pub struct InelasticState {
    /// State of the law, Gauss point by Gauss point.
    pub history: Vec<f64>,
    /// Inelastic strain (xx, yy, zz, engineering xy) of each Gauss point in the shape's frame: as the law defines it, otherwise
    /// ε − C⁻¹ σ.
    pub inelastic_strain: Vec<[f64; 4]>,
    /// Cumulated √(2/3 ε̇:ε̇) of the inelastic strain of each Gauss point.
    pub equivalent: Vec<f64>,
    /// The part of `equivalent` that yielded under compression.
    pub crushed: Vec<f64>,
    /// True if any point has ever yielded.
    pub yielded: bool,
    /// Energy dissipated so far \[J\].
    pub dissipated: f64,
}

/// The outputs of a law at a Gauss point.
#[derive(Debug, Clone, PartialEq)]
pub struct GaussOutputs {
    /// Position in world axes of the undeformed placement \[m\].
    pub position: [f64; 2],
    /// Area that the point represents \[m²\].
    pub area: f64,
    /// The values; NaN if the law has not written one.
    pub values: Vec<f64>,
}

/// A step of a body, computed by its law alone.
#[derive(Debug, Clone, Copy)]
pub struct PassedStep {
    /// Difference of the history from the expected one, relative to the greatest strain.
    pub drift: f64,
    /// Energy stored at the end of the step \[J\].
    pub stored: f64,
    /// Energy dissipated in the step \[J\].
    pub dissipated: f64,
}

/// A body whose material yields, condensed onto some of its points.
#[derive(Clone)]
pub struct InelasticBody {
    pub(super) shape: Arc<Shape>,
    pub(super) strains: Arc<Strains>,
    /// Places of the points and X of the elastic body, for forces on the carriers.
    pub(super) response: Arc<Response>,
    /// C of the elastic body, in world axes \[m/N\].
    pub(super) flexibility: Arc<DMatrix<f64>>,
    pub(super) origin: Vec2,
    pub(super) rotation: Matrix2<f64>,
    pub(super) size: f64,
    pub(super) width: f64,
    /// E \[Pa\], the reference modulus of the shape's elasticity.
    pub(super) modulus: f64,
    /// C⁻¹ × E in space.
    pub(super) compliance: [Voigt; 6],
    pub(super) update: Arc<PlanarUpdate>,
}

impl fmt::Debug for InelasticBody {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        out.debug_struct("InelasticBody").field("update", &self.update).finish_non_exhaustive()
    }
}

impl InelasticBody {
    #[allow(clippy::too_many_arguments)]
    pub(super) fn new(
        shape: Arc<Shape>,
        strains: Arc<Strains>,
        response: Arc<Response>,
        flexibility: Arc<DMatrix<f64>>,
        placement: Placement,
        elasticity: &Elasticity,
        update: Arc<PlanarUpdate>,
        width: f64,
    ) -> Self {
        let Placement { origin, rotation, size, .. } = placement;
        let (modulus, compliance) = (elasticity.modulus, elasticity.compliance());
        InelasticBody {
            shape,
            strains,
            response,
            flexibility,
            origin,
            rotation,
            size,
            width,
            modulus,
            compliance,
            update,
        }
    }

    /// Returns C of the elastic body \[m/N\].
    pub fn flexibility(&self) -> Arc<DMatrix<f64>> {
        self.flexibility.clone()
    }

    /// Returns the number of Gauss points.
    pub fn gauss_points(&self) -> usize {
        self.strains.operators.iter().map(Vec::len).sum()
    }

    /// Returns the number of nodes.
    pub fn nodes(&self) -> usize {
        self.shape.mesh.nodes.len()
    }

    /// Returns the number of state variables of a Gauss point.
    pub fn state_size(&self) -> usize {
        self.update.state_size()
    }

    /// Returns the number of leading state variables that are history. In plane stress the last variable is only the
    /// start value of the search for ε_zz.
    pub fn memory_size(&self) -> usize {
        self.update.law().state_size()
    }

    /// Returns the rows of Gauss points of the elements with a side between two points \[m\], from that side inwards:
    /// for each row its share of the side's length \[m\] and its points.
    pub fn rows_along(&self, from: Vec2, to: Vec2) -> Vec<(f64, Vec<usize>)> {
        let mut rows = Vec::new();
        let (points, n) = (&self.shape.reference.points, self.shape.reference.order + 1);
        let place = |local: Vec2| self.origin + self.rotation * local * self.size;
        for element in 0..self.shape.mesh.elements.len() {
            let corners = self.shape.mesh.corners(element).map(place);
            for side in 0..4 {
                let (a, b) = (corners[side], corners[(side + 1) % 4]);
                let off = |p: Vec2| crate::model::geometry::distance_to_segment(p, from, to);
                if off(a).max(off(b)) > 1e-7 * self.size {
                    continue;
                }
                // Point (i, j) has the index i + n j; sides 0 and 2 run along i.
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

    /// Returns the state of the undeformed body.
    pub fn initial(&self) -> InelasticState {
        let (count, size) = (self.gauss_points(), self.update.state_size());
        let mut history = vec![0.0; count * size];
        history.chunks_mut(size.max(1)).for_each(|state| self.update.initial_state(state));
        InelasticState {
            history,
            inelastic_strain: vec![[0.0; 4]; count],
            equivalent: vec![0.0; count],
            crushed: vec![0.0; count],
            yielded: false,
            dissipated: 0.0,
        }
    }

    /// Returns the displacements of the nodes from forces (x, y per point) \[N\], by X for forces on the carriers, and adds them
    /// to others.
    pub(super) fn add_response(&self, all: &mut [f64], response: &DMatrix<f64>, forces: &[f64]) {
        add_columns(all, response, &self.response.on_carriers(&self.local_forces(forces)));
    }

    /// Converts forces (x, y per point) \[N\] in the axes of the body into loads of the shape.
    fn local_forces(&self, forces: &[f64]) -> Vec<f64> {
        let scale = 1.0 / (self.modulus * self.width * self.size);
        let to_local = self.rotation.transpose() * scale;
        forces.chunks(2).flat_map(|f| <[f64; 2]>::from(to_local * Vec2::new(f[0], f[1]))).collect()
    }

    /// Returns the displacements of the nodes of the elastic body.
    pub fn elastic_displacement(&self, forces: &[f64]) -> Vec<f64> {
        let mut all = vec![0.0; 2 * self.nodes()];
        self.add_response(&mut all, &self.response.displacements, forces);
        all
    }

    /// Returns the displacements (x, y) of the points from those of the nodes \[m\], in the axes of the body.
    pub fn at_points(&self, displacement: &[f64]) -> Vec<f64> {
        let local = at_places(&self.response.places, &DMatrix::from_column_slice(displacement.len(), 1, displacement));
        let turn = self.rotation * self.size;
        local.as_slice().chunks(2).flat_map(|u| <[f64; 2]>::from(turn * Vec2::new(u[0], u[1]))).collect()
    }

    /// Returns the greatest unbalanced force on a node \[N\].
    pub(super) fn unbalanced(&self, internal: &[f64], forces: &[f64]) -> f64 {
        let loads = spread(&self.response.places, self.nodes(), &self.local_forces(forces));
        let mut rest = DMatrix::from_vec(internal.len(), 1, loads);
        self.shape.balanced(&mut rest);
        let left = rest.iter().zip(internal).map(|(f, own)| (f - own).abs());
        let worst = left.fold(0.0, |a: f64, x| if x.is_nan() { x } else { a.max(x) });
        worst * self.modulus * self.width * self.size
    }

    pub(super) fn strains_at(&self, displacement: &[f64]) -> Vec<[f64; 3]> {
        let mut strains = Vec::with_capacity(self.gauss_points());
        let mut local = Vec::new();
        for (nodes, operators) in self.shape.mesh.elements.iter().zip(&self.strains.operators) {
            local.clear();
            local.extend(nodes.iter().flat_map(|node| [displacement[2 * node], displacement[2 * node + 1]]));
            for (b, _) in operators {
                let mut strain = [0.0; 3];
                for (column, u) in b.as_slice().as_chunks::<3>().0.iter().zip(&local) {
                    (0..3).for_each(|i| strain[i] += column[i] * u);
                }
                strains.push(strain);
            }
        }
        strains
    }

    /// Returns the context of the updates in an element.
    pub(super) fn context(&self, element: usize) -> UpdateContext<'static> {
        UpdateContext::of_length(self.strains.lengths[element] * self.size)
    }

    pub(super) fn stresses(
        &self,
        strains: &[[f64; 3]],
        history: &[f64],
        new: &mut [f64],
    ) -> Result<Vec<PlanarPoint>, String> {
        let operators = self.strains.operators.iter().enumerate();
        let contexts: Vec<UpdateContext> =
            operators.flat_map(|(e, points)| std::iter::repeat_n(self.context(e), points.len())).collect();
        let mut points = vec![PlanarPoint::ZERO; strains.len()];
        self.update
            .update(strains, &contexts, history, new, &mut points)
            .map_err(|wrong| format!("the stress at a Gauss point cannot be found: {wrong}"))?;
        Ok(points)
    }

    /// Returns f_int of stresses.
    pub(super) fn internal(&self, points: &[PlanarPoint]) -> Vec<f64> {
        let mut internal = vec![0.0; 2 * self.nodes()];
        let mut next = points.iter();
        for (nodes, operators) in self.shape.mesh.elements.iter().zip(&self.strains.operators) {
            for ((b, weight), point) in operators.iter().zip(&mut next) {
                let stress = point.stress.map(|s| s * weight / self.modulus);
                for (j, column) in b.column_iter().enumerate() {
                    internal[2 * nodes[j / 2] + j % 2] +=
                        column[0] * stress[0] + column[1] * stress[1] + column[2] * stress[2];
                }
            }
        }
        internal
    }

    /// Returns displacements and state of a body in which nothing has yielded, from the forces on its points. A law may
    /// store its strain and stress in its state. If every point takes an elastic branch, the state is that of the law after this
    /// step; otherwise it is the initial state.
    pub fn elastic_state(&self, forces: &[f64]) -> (Vec<f64>, InelasticState) {
        let displacement = self.elastic_displacement(forces);
        let mut state = self.initial();
        let mut history = state.history.clone();
        let points = self.stresses(&self.strains_at(&displacement), &state.history, &mut history);
        if points.is_ok_and(|points| points.iter().all(|point| point.branch.is_elastic())) {
            state.history = history;
        }
        (displacement, state)
    }

    /// Recomputes a state from displacements and history alone. Returns the greatest unbalanced force on a node \[N\]
    /// with the stresses of the law, and the change of the history that the law still gives, relative to the greatest
    /// strain: 0 if no stress is beyond the yield surface.
    ///
    /// # Errors
    /// If an update fails or the numbers do not fit the mesh.
    pub fn check(&self, displacement: &[f64], history: &[f64], forces: &[f64]) -> Result<[f64; 2], String> {
        if displacement.len() != 2 * self.nodes() || history.len() != self.gauss_points() * self.state_size() {
            return Err("the state of a block does not fit its mesh".into());
        }
        let strains = self.strains_at(displacement);
        let mut new = history.to_vec();
        let points = self.stresses(&strains, history, &mut new)?;
        let largest = strains.iter().flatten().fold(0.0f64, |a, x| a.max(x.abs())).max(f64::MIN_POSITIVE);
        let (size, own) = (self.state_size(), self.memory_size());
        let both = new.iter().zip(history).enumerate().filter(|(i, _)| i % size < own);
        let drift = both.map(|(_, (a, b))| (a - b).abs()).fold(0.0, f64::max) / largest;
        Ok([self.unbalanced(&self.internal(&points), forces), drift])
    }

    /// Updates all Gauss points to displacements from the first of two histories and compares the result with the
    /// second.
    ///
    /// # Errors
    /// If an update fails or the numbers do not fit the mesh.
    pub fn passed(&self, displacement: &[f64], [before, after]: [&[f64]; 2]) -> Result<PassedStep, String> {
        let most = self.gauss_points() * self.state_size();
        if displacement.len() != 2 * self.nodes() || before.len() != most || after.len() != most {
            return Err("the state of a block does not fit its mesh".into());
        }
        let strains = self.strains_at(displacement);
        let mut new = before.to_vec();
        let points = self.stresses(&strains, before, &mut new)?;
        let largest = strains.iter().flatten().fold(0.0f64, |a, x| a.max(x.abs())).max(f64::MIN_POSITIVE);
        let (size, own) = (self.state_size(), self.memory_size());
        let both = new.iter().zip(after).enumerate().filter(|(i, _)| i % size < own);
        let drift = both.map(|(_, (a, b))| (a - b).abs()).fold(0.0, f64::max) / largest;
        let volume = self.width * self.size * self.size;
        let weights = self.strains.operators.iter().flatten().map(|(_, weight)| weight * volume);
        let (mut stored, mut dissipated) = (0.0, 0.0);
        for (point, weight) in points.iter().zip(weights) {
            stored += weight * point.stored;
            dissipated += weight * point.dissipated;
        }
        Ok(PassedStep { drift, stored, dissipated })
    }

    /// Returns displacements and stresses of the whole mesh in world axes of the undeformed placement. The stress at a
    /// node is the mean of the nearest Gauss points, so that the stress of each element is within the yield surface.
    ///
    /// # Errors
    /// If an update fails.
    pub fn recover(&self, displacement: &[f64], state: &InelasticState) -> Result<Recovered, String> {
        let strains = self.strains_at(displacement);
        let mut new = state.history.clone();
        let points = self.stresses(&strains, &state.history, &mut new)?;
        let mesh = &self.shape.mesh;
        let mut sums = vec![([0.0; 4], 0.0); mesh.nodes.len()];
        let mut element_stress = Vec::with_capacity(mesh.elements.len());
        let per = self.strains.operators[0].len();
        for (index, nodes) in mesh.elements.iter().enumerate() {
            let here = &points[index * per..(index + 1) * per];
            for (node, point) in nodes.iter().zip(here) {
                (0..4).for_each(|i| sums[*node].0[i] += point.stress_in_space()[i]);
                sums[*node].1 += 1.0;
            }
            let weights = &self.strains.operators[index];
            let area: f64 = weights.iter().map(|w| w.1).sum();
            let mean =
                |i: usize| here.iter().zip(weights).map(|(p, w)| p.stress_in_space()[i] * w.1).sum::<f64>() / area;
            element_stress.push([0, 1, 2, 3].map(mean));
        }
        let local: Vec<Vec2> = displacement.chunks(2).map(|u| Vec2::new(u[0], u[1])).collect();
        let stress = sums.into_iter().map(|(sum, count)| sum.map(|s| s / count)).collect();
        let recovered = Recovered::with(mesh, local, stress, element_stress);
        Ok(recovered.placed(self.origin, self.rotation, self.size, 1.0, [0.0; 3]))
    }

    /// Returns the outputs of the law at all Gauss points, `count` at each.
    ///
    /// # Errors
    /// If an update fails or the numbers do not fit the mesh.
    pub fn outputs(&self, displacement: &[f64], history: &[f64], count: usize) -> Result<Vec<GaussOutputs>, String> {
        let size = self.state_size();
        if displacement.len() != 2 * self.nodes() || history.len() != self.gauss_points() * size {
            return Err("the state of a block does not fit its mesh".into());
        }
        let (strains, mut found) = (self.strains_at(displacement), Vec::new());
        for (element, operators) in self.strains.operators.iter().enumerate() {
            let (corners, context) = (self.shape.mesh.corners(element), self.context(element));
            for ((_, weight), point) in operators.iter().zip(&self.shape.reference.points) {
                let (index, mut values) = (found.len(), vec![f64::NAN; count]);
                let state = &history[index * size..(index + 1) * size];
                self.update
                    .outputs(&strains[index], &context, state, &mut values)
                    .map_err(|wrong| format!("the outputs of a Gauss point cannot be found: {wrong}"))?;
                let place = self.origin + self.rotation * bilinear(&corners, point.place).0 * self.size;
                found.push(GaussOutputs { position: place.into(), area: weight * self.size * self.size, values });
            }
        }
        Ok(found)
    }

    /// Returns the mean over each element of a quantity at its Gauss points.
    pub fn by_element(&self, values: &[f64]) -> Vec<f64> {
        let mut next = values.iter();
        let mean = |points: &Vec<(DMatrix<f64>, f64)>| {
            let area: f64 = points.iter().map(|p| p.1).sum();
            points.iter().zip(&mut next).map(|(p, value)| p.1 * value).sum::<f64>() / area
        };
        self.strains.operators.iter().map(mean).collect()
    }
}
