//! A body of a yielding material, linearised at displacements of its nodes: stresses, energies, tangent, and the
//! condensation of the tangent onto its points. The module `inelastic` has the equations.

use super::inelastic::{InelasticBody, InelasticState};
use super::shape::{SPRINGS, at_places, placed};
use crate::law::{Effect, PlanarPoint};
use crate::linear::{Entries, SparseLu};
use crate::model::geometry::Vec2;
use nalgebra::DMatrix;
use std::sync::Arc;

/// Greatest residual of the equations of a tangent, relative to loads and stiffness × displacement.
const RESIDUAL: f64 = 1e-10;
/// Residual of these equations, relative to the same, that is rounding.
const ROUNDING: f64 = 1e-14;
/// Share of the elastic stiffness that is added to yielding points if the tangent has no inverse. It makes the
/// iteration slower but does not change its result.
const SOFTEST: f64 = 1e-3;

/// Greatest difference of a tangent from the elastic stiffness, relative to E, up to which both count as equal.
const UNCHANGED: f64 = 1e-9;

/// Relative difference up to which the dissipation of a law is that of plastic flow, σ · Δε^p.
const PLASTIC_WORK: f64 = 1e-9;

/// Rounding of an inelastic strain, which is the difference of two strains, relative to the greatest of them.
const STRAIN_ROUNDING: f64 = 1e-14;

/// Step of the differences of a dissipation, relative to the greatest strain.
const DIFFERENCE: f64 = 1e-6;

/// Flexibility, relative to that of the elastic body, above which a tangent counts as singular.
const LARGEST: f64 = 1e4;

/// A body linearised at nodal displacements: u = C f + c at its points.
#[derive(Debug, Clone)]
pub struct Linearisation {
    /// C \[m/N\].
    pub flexibility: Arc<DMatrix<f64>>,
    /// c (x, y per point) \[m\].
    pub offset: Vec<f64>,
    /// X for forces on the carriers, and x.
    response: Arc<DMatrix<f64>>,
    rest: Vec<f64>,
    /// Displacements of the nodes (x, y) at which it is linearised, in the frame of the shape, in units of its size.
    pub displacement: Arc<Vec<f64>>,
    internal: Vec<f64>,
    /// State of the body if a step ends here.
    pub end: Arc<InelasticState>,
    /// Elastic energy \[J\].
    pub stored: f64,
    /// Number of Gauss points at which something irreversible happens in the step.
    pub yielding: usize,
    /// True if the tangent differs from the elastic stiffness: the flexibility is that of this state, and need not be symmetric.
    pub changed: bool,
    /// Number of matrices factorised for it.
    pub factorisations: u64,
}

/// Returns the greatest residual of the equations of a tangent without its springs, relative to loads and stiffness ×
/// displacement: of the last right-hand side and of the sum of the others, which are all solved by the same factors.
fn unsolved(factors: &SparseLu, stiffest: f64, right: &[Vec<f64>], all: &DMatrix<f64>) -> f64 {
    // A number that is not one remains the greatest.
    let larger = |a: f64, b: f64| if a >= b || a.is_nan() { a } else { b };
    let greatest = |v: &[f64]| v.iter().fold(0.0, |a, x| larger(a, x.abs()));
    let of_sum = |some: std::ops::Range<usize>| {
        let columns = all.columns_range(some.clone());
        let mut sum = vec![0.0; all.nrows()];
        for right in &right[some.clone()] {
            sum.iter_mut().zip(right).for_each(|(sum, b)| *sum += b);
        }
        let x = columns.column_sum();
        let mut left = factors.left(&sum, x.as_slice());
        SPRINGS.iter().for_each(|&dof| left[dof] += x[dof]);
        let loads = right[some].iter().map(|b| greatest(b)).fold(0.0, larger);
        greatest(&left) / (loads + stiffest * columns.amax()).max(f64::MIN_POSITIVE)
    };
    let last = right.len() - 1;
    larger(of_sum(0..last), of_sum(last..right.len()))
}

impl InelasticBody {
    /// Returns the displacements of the nodes from forces on the points, by the linearisation.
    pub fn displaced(&self, linear: &Linearisation, forces: &[f64]) -> Vec<f64> {
        let mut all = linear.rest.clone();
        self.add_response(&mut all, &linear.response, forces);
        all
    }

    /// Returns the greatest unbalanced force on a node \[N\] at the displacements of the linearisation.
    pub fn residual(&self, linear: &Linearisation, forces: &[f64]) -> f64 {
        self.unbalanced(&linear.internal, forces)
    }

    /// Returns C⁻¹ σ of a point: the elastic part of (ε_xx, ε_yy, ε_zz, γ_xy).
    fn elastic_strain(&self, stress: [f64; 4]) -> [f64; 4] {
        let entry = |i: usize| (0..4).map(|j| self.compliance[i][j] * stress[j]).sum::<f64>() / self.modulus;
        [0, 1, 2, 3].map(entry)
    }

    /// Returns the part of a strain (xx, yy, zz, xy) that is not elastic: as the law defines it, otherwise ε − C⁻¹ σ.
    fn inelastic_strain(&self, point: &PlanarPoint, strain: &[f64; 3], memory: &[f64]) -> [f64; 4] {
        let own = self.update.inelastic_strain(point.strain_in_space(strain), memory);
        own.unwrap_or_else(|| self.beyond_elastic(point, strain))
    }

    /// Returns ε − C⁻¹ σ (xx, yy, zz, xy) of a point.
    fn beyond_elastic(&self, point: &PlanarPoint, strain: &[f64; 3]) -> [f64; 4] {
        let (total, elastic) = (point.strain_in_space(strain), self.elastic_strain(point.stress_in_space()));
        [0, 1, 2, 3].map(|i| total[i] - elastic[i])
    }

    /// Returns the state of the law at a Gauss point.
    fn memory<'a>(&self, history: &'a [f64], index: usize) -> &'a [f64] {
        let size = self.state_size();
        &history[index * size..index * size + self.memory_size()]
    }

    /// Returns ∂(dissipated energy)/∂(ε_xx, ε_yy, γ_xy) of a point \[Pa\]. Plastic flow dissipates σ · Δε^p, whose derivative
    /// follows from the tangent. The dissipation of other laws is differentiated by differences, on one side if the step would be
    /// elastic on the other.
    fn dissipation_slope(
        &self,
        point: &PlanarPoint,
        strain: &[f64; 3],
        (element, index): (usize, usize),
        start: &InelasticState,
    ) -> Result<[f64; 3], String> {
        let (stress, total) = (point.stress_in_space(), point.strain_in_space(strain));
        let (now, before) = (self.beyond_elastic(point, strain), start.inelastic_strain[index]);
        let step = [0, 1, 2, 3].map(|i| now[i] - before[i]);
        let terms = [0, 1, 2, 3].map(|i| stress[i] * step[i]);
        let size = terms.iter().map(|term| term.abs()).sum::<f64>().max(point.dissipated.abs());
        let [largest, force] = [total, stress].map(|all| all.iter().fold(0.0_f64, |a, x| a.max(x.abs())));
        let rounding = STRAIN_ROUNDING * largest * force;
        if (terms.iter().sum::<f64>() - point.dissipated).abs() <= PLASTIC_WORK * size + rounding {
            return Ok([0, 1, 2].map(|j| {
                let t = [point.tangent[0][j], point.tangent[1][j], point.tangent_across[j], point.tangent[2][j]];
                let elastic = self.elastic_strain(t);
                let unit = [f64::from(j == 0), f64::from(j == 1), 0.0, f64::from(j == 2)];
                (0..4).map(|i| t[i] * step[i] + stress[i] * (unit[i] - elastic[i])).sum()
            }));
        }
        let width = DIFFERENCE * largest;
        let (context, size) = (self.context(element), self.state_size());
        let (old, mut new) = (&start.history[index * size..(index + 1) * size], vec![0.0; size]);
        let mut at = |j: usize, by: f64| {
            let mut moved = *strain;
            moved[j] += by;
            let found = self.update.update_point(&moved, &context, old, &mut new);
            let found = found.map_err(|why| format!("a stress update beside a state failed: {why}"))?;
            Ok::<_, String>((!found.branch.is_elastic()).then_some(found.dissipated))
        };
        let mut slope = [0.0; 3];
        for (j, slope) in slope.iter_mut().enumerate() {
            *slope = match (at(j, width)?, at(j, -width)?) {
                (Some(ahead), Some(behind)) => (ahead - behind) / (2.0 * width),
                (Some(ahead), None) => (ahead - point.dissipated) / width,
                (None, Some(behind)) => (point.dissipated - behind) / width,
                (None, None) => 0.0,
            };
        }
        Ok(slope)
    }

    /// Linearises the body at displacements of its nodes; `start` is the state at the start of the step.
    ///
    /// # Errors
    /// If stresses or the tangent cannot be computed.
    pub fn linearise(&self, displacement: Vec<f64>, start: &InelasticState) -> Result<Linearisation, String> {
        let volume = self.size.powi(2) * self.width;
        let strains = self.strains_at(&displacement);
        let mut end = start.clone();
        let points = self.stresses(&strains, &start.history, &mut end.history)?;
        let (mut stored, mut yielding) = (0.0, 0);
        let weights = self.strains.operators.iter().flatten().map(|(_, weight)| weight * volume);
        for (index, (point, weight)) in points.iter().zip(weights).enumerate() {
            stored += weight * point.stored;
            end.dissipated += weight * point.dissipated;
            if point.branch.is_elastic() {
                continue;
            }
            let inelastic = self.inelastic_strain(point, &strains[index], self.memory(&end.history, index));
            let before = start.inelastic_strain[index];
            let [x, y, z, xy] = [0, 1, 2, 3].map(|i| inelastic[i] - before[i]);
            let equivalent = (2.0 / 3.0 * (x * x + y * y + z * z + 0.5 * xy * xy)).sqrt();
            end.inelastic_strain[index] = inelastic;
            end.equivalent[index] += equivalent;
            if point.branch.effect != Effect::Tearing && point.stress[0] + point.stress[1] + point.stress_across < 0.0 {
                end.crushed[index] += equivalent;
            }
            yielding += 1;
        }
        end.yielded |= yielding > 0;
        // The tangent of a law decides, not the name of its branch: a damaged material unloads with less stiffness.
        let changed = yielding > 0 || !points.iter().all(|point| self.is_unchanged(point));
        let internal = self.internal(&points);
        let (mut rest, mut response, mut flexibility) =
            (vec![0.0; displacement.len()], self.response.displacements.clone(), self.flexibility.clone());
        let mut factorisations = 0;
        if changed {
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
            let scale = 1.0 / (self.modulus * self.width);
            flexibility = Arc::new(placed(&self.response.condensed(&x), self.rotation, scale, false));
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
            yielding,
            changed,
            factorisations,
        })
    }

    /// Returns true if a point has the elastic tangent and nothing irreversible happens there.
    fn is_unchanged(&self, point: &PlanarPoint) -> bool {
        let elastic = &self.shape.elasticity.stiffness;
        let same = |i: usize, j: usize| (point.tangent[i][j] / self.modulus - elastic[(i, j)]).abs() <= UNCHANGED;
        point.branch.is_elastic() && (0..3).all(|i| (0..3).all(|j| same(i, j)))
    }

    /// Returns the number of Gauss points at which something irreversible happens in a step from `start` to displacements of the
    /// nodes.
    ///
    /// # Errors
    /// If stresses cannot be computed.
    pub fn yielding(&self, displacement: &[f64], start: &InelasticState) -> Result<usize, String> {
        let mut history = start.history.clone();
        let points = self.stresses(&self.strains_at(displacement), &start.history, &mut history)?;
        Ok(points.iter().filter(|point| !point.branch.is_elastic()).count())
    }

    /// Returns the entries of K with the tangents of yielding points and the elastic stiffness elsewhere; `share` of the elastic
    /// stiffness is added at yielding points.
    fn tangent_entries(&self, points: &[PlanarPoint], share: f64) -> Entries {
        let elements = &self.shape.mesh.elements;
        let mut entries: Entries = Vec::with_capacity(SPRINGS.len() + elements.len() * (2 * elements[0].len()).pow(2));
        entries.extend(SPRINGS.map(|dof| (dof, dof, 1.0)));
        let mut first = 0;
        for ((nodes, operators), elastic) in elements.iter().zip(&self.strains.operators).zip(&self.strains.elastic) {
            let here = &points[first..first + operators.len()];
            first += operators.len();
            let changed = !here.iter().all(|point| self.is_unchanged(point));
            let own = changed.then(|| self.tangent_of_element(operators, here, share));
            let k = own.as_ref().unwrap_or(elastic);
            let row = |i: usize| 2 * nodes[i / 2] + i % 2;
            for (j, column) in k.column_iter().enumerate() {
                entries.extend(column.iter().enumerate().map(|(i, value)| (row(i), row(j), *value)));
            }
        }
        entries
    }

    /// Returns K of an element with these points.
    fn tangent_of_element(
        &self,
        operators: &[(DMatrix<f64>, f64)],
        points: &[PlanarPoint],
        share: f64,
    ) -> DMatrix<f64> {
        let elastic = &self.shape.elasticity.stiffness;
        let columns = operators[0].0.ncols();
        let mut k = DMatrix::zeros(columns, columns);
        for ((b, weight), point) in operators.iter().zip(points) {
            let mut d = nalgebra::Matrix3::from_fn(|i, j| point.tangent[i][j] / self.modulus);
            if !self.is_unchanged(point) {
                d += elastic * share;
            }
            k += b.transpose() * (d * *weight) * b;
        }
        k
    }

    /// Returns P K⁺ Pᵀ Nᵀ and P K⁺ f_int with the tangents of yielding points and the elastic stiffness elsewhere. The solution
    /// is refined only if its residual is more than rounding.
    fn solve(&self, points: &[PlanarPoint], internal: &[f64], share: f64) -> Option<(DMatrix<f64>, Vec<f64>)> {
        let size = internal.len();
        let entries = self.tangent_entries(points, share);
        let stiffest = entries.iter().fold(0.0f64, |max, entry| max.max(entry.2.abs()));
        let factors = SparseLu::analysed_together(size, &entries, &self.strains.analysis)?;
        let mut right = self.response.loads.clone();
        right.push(internal.to_vec());
        for refinements in [0, 1] {
            let all = factors.solve(&right, refinements)?;
            let mut all = DMatrix::from_vec(size, all.len(), all.concat());
            self.shape.without_rigid_motion(&mut all);
            let error = unsolved(&factors, stiffest, &right, &all);
            if refinements == 0 && (error.is_nan() || error > ROUNDING) {
                continue;
            }
            let largest = all.columns(0, right.len() - 1).amax();
            let singular = largest.is_nan() || largest > LARGEST * self.response.displacements.amax();
            if singular || error.is_nan() || error > RESIDUAL {
                return None;
            }
            let own = all.column(right.len() - 1).iter().copied().collect();
            return Some((all.columns(0, right.len() - 1).into_owned(), own));
        }
        None
    }

    /// Returns ∂(energy dissipated in the step)/∂(forces on the points) \[J/N\]; `start` is the state at the start of the step.
    ///
    /// # Errors
    /// If an update of the law fails.
    pub fn dissipation_by_force(&self, linear: &Linearisation, start: &InelasticState) -> Result<Vec<f64>, String> {
        if linear.yielding == 0 {
            return Ok(vec![0.0; 2 * self.response.places.len()]);
        }
        let volume = self.size.powi(2) * self.width;
        let strains = self.strains_at(&linear.displacement);
        let mut history = start.history.clone();
        let points = self.stresses(&strains, &start.history, &mut history)?;
        let (mut slope, mut index) = (vec![0.0; linear.displacement.len()], 0);
        for (element, (nodes, operators)) in self.shape.mesh.elements.iter().zip(&self.strains.operators).enumerate() {
            for (b, weight) in operators {
                if !points[index].branch.is_elastic() {
                    let by_strain = self.dissipation_slope(&points[index], &strains[index], (element, index), start)?;
                    let by_strain = by_strain.map(|s| s * weight * volume);
                    for (j, column) in b.column_iter().enumerate() {
                        slope[2 * nodes[j / 2] + j % 2] +=
                            column[0] * by_strain[0] + column[1] * by_strain[1] + column[2] * by_strain[2];
                    }
                }
                index += 1;
            }
        }
        let scale = 1.0 / (self.modulus * self.width * self.size);
        let by_carrier = linear.response.tr_mul(&nalgebra::DVector::from_vec(slope)) * scale;
        let local =
            at_places(&self.response.shares, &DMatrix::from_column_slice(by_carrier.len(), 1, by_carrier.as_slice()));
        Ok(local.as_slice().chunks(2).flat_map(|s| <[f64; 2]>::from(self.rotation * Vec2::new(s[0], s[1]))).collect())
    }
}
