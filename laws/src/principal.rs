//! Perfect plasticity of isotropic materials whose strength is a polyhedron of principal stresses.
//!
//! The principal stresses of the trial are σ̂_1 ≥ σ̂_2 ≥ σ̂_3 (tension positive). The facets are a·σ ≤ b with the flow
//! Δε^p = Σ γ d, γ ≥ 0. The stress keeps the trial's axes, and at most three facets are active. So the result is the only
//! admissible one among all sets of up to three facets, each a linear problem Aᵀ C D γ = Aᵀ σ̂ − b (Clausen, Damkilde &
//! Andersen 2006, Comput. Struct. 84). The tangent along the principal axes is
//!
//! ```text
//! C_ep = C − C D (Aᵀ C D)⁻¹ Aᵀ C,    G_ij = G (σ_i − σ_j) / (σ̂_i − σ̂_j) for the shear of axes i and j
//! ```
//!
//! because strains that rotate also rotate the stresses; if σ̂_i = σ̂_j, the shear is the limit of C_ep.

use crate::meridian::state_names;
use voussoir_core::law::{Elasticity, StressPoint, StressUpdate, UpdateBranch, UpdateContext, UpdateFailure, Voigt};

type Vector = [f64; 3];

/// A facet over the sorted principal stresses.
#[derive(Debug, Clone, Copy)]
pub struct PrincipalFacet {
    /// a.
    pub normal: Vector,
    /// b \[Pa\].
    pub bound: f64,
    /// d.
    pub flow: Vector,
    /// True if the facet bounds tension.
    pub tension: bool,
}

/// Elasticity, facets, and the branch for the number of active facets that fail in shear and in tension.
#[derive(Debug, Clone)]
pub struct PrincipalUpdate {
    young_modulus: f64,
    poisson_ratio: f64,
    facets: Vec<PrincipalFacet>,
    branch: fn(usize, usize) -> UpdateBranch,
}

static STATE: [&str; 6] = state_names(&[]);

/// Share of the trial stress by which facets may be exceeded due to rounding.
const ROUNDING: f64 = 1e-11;
/// Principal stresses are equal, and their axes arbitrary, if their difference is below this share of the greatest stress.
const EQUAL: f64 = 1e-9;

fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// An active set: facets with multipliers, and the resulting stress.
#[derive(Clone, Copy)]
struct Active {
    facets: [usize; 3],
    count: usize,
    steps: Vector,
    stress: Vector,
    excess: f64,
}

impl PrincipalUpdate {
    /// Creates the law from E \[Pa\], ν, the facets, and names of branches by the numbers of active facets (shear, tension).
    pub fn new(
        young_modulus: f64,
        poisson_ratio: f64,
        facets: Vec<PrincipalFacet>,
        branch: fn(usize, usize) -> UpdateBranch,
    ) -> Self {
        PrincipalUpdate { young_modulus, poisson_ratio, facets, branch }
    }

    /// Returns Lamé's λ and G \[Pa\].
    fn lame(&self) -> [f64; 2] {
        let (e, nu) = (self.young_modulus, self.poisson_ratio);
        [e * nu / ((1.0 + nu) * (1.0 - 2.0 * nu)), e / (2.0 * (1.0 + nu))]
    }

    /// Returns C v.
    fn pull(&self, v: &Vector) -> Vector {
        let [lambda, shear] = self.lame();
        let trace = lambda * (v[0] + v[1] + v[2]);
        v.map(|x| trace + 2.0 * shear * x)
    }

    fn excess(&self, stress: &Vector) -> f64 {
        self.facets.iter().map(|f| dot(&f.normal, stress) - f.bound).fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns the result with these active facets; `None` if they depend on each other or a multiplier is negative.
    fn with(&self, trial: &Vector, facets: [usize; 3], count: usize) -> Option<Active> {
        let inverse = self.inverse(&facets, count)?;
        let over: Vector = std::array::from_fn(|i| match self.facets.get(facets[i]) {
            Some(f) if i < count => dot(&f.normal, trial) - f.bound,
            _ => 0.0,
        });
        let steps = inverse.map(|row| dot(&row, &over));
        if steps[..count].iter().any(|step| *step < 0.0) {
            return None;
        }
        let mut stress = *trial;
        for (index, step) in facets.iter().zip(steps).take(count) {
            let pull = self.pull(&self.facets[*index].flow);
            (0..3).for_each(|i| stress[i] -= step * pull[i]);
        }
        Some(Active { facets, count, steps, stress, excess: self.excess(&stress) })
    }

    /// Returns (Aᵀ C D)⁻¹ in its first `count` rows and columns.
    fn inverse(&self, facets: &[usize; 3], count: usize) -> Option<[Vector; 3]> {
        let mut m = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        for i in 0..count {
            for j in 0..count {
                m[i][j] =
                    dot(&self.facets[facets[i]].normal, &self.pull(&self.facets[facets[j]].flow)) / self.young_modulus;
            }
        }
        let minor = |a: usize, b: usize, c: usize, d: usize| m[a][c] * m[b][d] - m[a][d] * m[b][c];
        let cofactors = [
            [minor(1, 2, 1, 2), -minor(0, 2, 1, 2), minor(0, 1, 1, 2)],
            [-minor(1, 2, 0, 2), minor(0, 2, 0, 2), -minor(0, 1, 0, 2)],
            [minor(1, 2, 0, 1), -minor(0, 2, 0, 1), minor(0, 1, 0, 1)],
        ];
        let determinant = m[0][0] * cofactors[0][0] + m[0][1] * cofactors[1][0] + m[0][2] * cofactors[2][0];
        if determinant.abs() <= 1e-9 {
            return None;
        }
        Some(std::array::from_fn(|i| {
            std::array::from_fn(|j| {
                let inside = i < count && j < count;
                if inside { cofactors[i][j] / determinant / self.young_modulus } else { 0.0 }
            })
        }))
    }

    /// Returns the admissible result for a trial outside the surface.
    fn returned(&self, trial: &Vector) -> Result<Active, UpdateFailure> {
        let size = trial.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        let mut best: Option<Active> = None;
        let mut consider = |facets: [usize; 3], count: usize| {
            if let Some(active) = self.with(trial, facets, count)
                && best.is_none_or(|best| active.excess < best.excess)
            {
                best = Some(active);
            }
        };
        let n = self.facets.len();
        for i in 0..n {
            consider([i, 0, 0], 1);
            for j in i + 1..n {
                consider([i, j, 0], 2);
                (j + 1..n).for_each(|k| consider([i, j, k], 3));
            }
        }
        match best {
            Some(best) if best.excess <= ROUNDING * size => Ok(best),
            _ => Err(UpdateFailure::Law("no flow of the material's facets returns the stress to them")),
        }
    }

    /// Returns C_ep along the principal axes; shears follow from the rotation of the axes.
    fn tangent(&self, trial: &Vector, active: &Active) -> [Voigt; 6] {
        let [lambda, shear] = self.lame();
        let mut tangent = [[0.0; 6]; 6];
        let inverse = self.inverse(&active.facets, active.count).unwrap_or([[0.0; 3]; 3]);
        let set = &active.facets[..active.count];
        for i in 0..3 {
            for j in 0..3 {
                let mut entry = lambda + if i == j { 2.0 * shear } else { 0.0 };
                for (k, one) in set.iter().enumerate() {
                    for (l, other) in set.iter().enumerate() {
                        // C is symmetric: a row of Aᵀ C is C a.
                        let (pull, row) = (self.pull(&self.facets[*one].flow), self.pull(&self.facets[*other].normal));
                        entry -= pull[i] * inverse[k][l] * row[j];
                    }
                }
                tangent[i][j] = entry;
            }
        }
        let size = trial.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
        for (place, (i, j)) in [(0, 1), (1, 2), (2, 0)].into_iter().enumerate() {
            let apart = trial[i] - trial[j];
            tangent[3 + place][3 + place] = if apart.abs() > EQUAL * size {
                shear * (active.stress[i] - active.stress[j]) / apart
            } else {
                0.25 * (tangent[i][i] + tangent[j][j] - tangent[i][j] - tangent[j][i])
            };
        }
        tangent
    }
}

/// Returns the principal values in descending order, with their axes as rows. Jacobi rotations keep axes orthogonal also if
/// values are equal.
pub fn principal(stress: &Voigt) -> (Vector, [Vector; 3]) {
    let mut m =
        [[stress[0], stress[3], stress[5]], [stress[3], stress[1], stress[4]], [stress[5], stress[4], stress[2]]];
    let mut axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    // Convergence is quadratic: six sweeps are sufficient, twelve are safe.
    for _ in 0..12 {
        for (p, q) in [(0, 1), (0, 2), (1, 2)] {
            if m[p][q] == 0.0 {
                continue;
            }
            let theta = (m[q][q] - m[p][p]) / (2.0 * m[p][q]);
            let t = if theta.is_infinite() { 0.0 } else { 1.0_f64.copysign(theta) / (theta.abs() + theta.hypot(1.0)) };
            let cosine = 1.0 / t.hypot(1.0);
            let sine = t * cosine;
            for row in &mut m {
                (row[p], row[q]) = (cosine * row[p] - sine * row[q], sine * row[p] + cosine * row[q]);
            }
            let (a, b) = (m[p], m[q]);
            m[p] = std::array::from_fn(|k| cosine * a[k] - sine * b[k]);
            m[q] = std::array::from_fn(|k| sine * a[k] + cosine * b[k]);
            (m[p][q], m[q][p]) = (0.0, 0.0);
            let (a, b) = (axes[p], axes[q]);
            axes[p] = std::array::from_fn(|k| cosine * a[k] - sine * b[k]);
            axes[q] = std::array::from_fn(|k| sine * a[k] + cosine * b[k]);
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|a, b| m[*b][*b].total_cmp(&m[*a][*a]));
    (order.map(|i| m[i][i]), order.map(|i| axes[i]))
}

/// Returns Σ v_i n_i ⊗ n_i; `shear` is 2 for strains, because they have engineering shears.
pub fn in_space(v: &Vector, axes: &[Vector; 3], shear: f64) -> Voigt {
    let entry = |i: usize, j: usize| (0..3).map(|k| v[k] * axes[k][i] * axes[k][j]).sum::<f64>();
    [entry(0, 0), entry(1, 1), entry(2, 2), shear * entry(0, 1), shear * entry(1, 2), shear * entry(2, 0)]
}

impl StressUpdate for PrincipalUpdate {
    fn state_size(&self) -> usize {
        6
    }

    fn initial_state(&self, state: &mut [f64]) {
        state.fill(0.0);
    }

    fn state_names(&self) -> &'static [&'static str] {
        &STATE
    }

    fn update_point(
        &self,
        strain: &Voigt,
        _: &UpdateContext,
        old: &[f64],
        new: &mut [f64],
    ) -> Result<StressPoint, UpdateFailure> {
        if !strain.iter().chain(old).all(|x| x.is_finite()) {
            return Err(UpdateFailure::NotFinite);
        }
        new.copy_from_slice(old);
        let [lambda, shear] = self.lame();
        let trace = lambda * (0..3).map(|i| strain[i] - old[i]).sum::<f64>();
        let stress: Voigt = std::array::from_fn(|i| {
            let own = (strain[i] - old[i]) * shear;
            if i < 3 { trace + 2.0 * own } else { own }
        });
        if !stress.iter().all(|x| x.is_finite()) {
            return Err(UpdateFailure::NotFinite);
        }
        let (trial, axes) = principal(&stress);
        let (e, nu) = (self.young_modulus, self.poisson_ratio);
        let stored = |s: &Vector| (0.5 * dot(s, s) - nu * (s[0] * s[1] + s[1] * s[2] + s[2] * s[0])) / e;
        if self.excess(&trial) <= 0.0 {
            let tangent = Elasticity::isotropic(e, nu).stiffness();
            return Ok(StressPoint {
                stress,
                tangent,
                branch: UpdateBranch::ELASTIC,
                stored: stored(&trial),
                dissipated: 0.0,
            });
        }
        let active = self.returned(&trial)?;
        let (mut plastic, mut dissipated, mut counts) = ([0.0; 3], 0.0, [0, 0]);
        for (index, step) in active.facets.iter().zip(active.steps).take(active.count) {
            let facet = &self.facets[*index];
            (0..3).for_each(|i| plastic[i] += step * facet.flow[i]);
            dissipated += step * dot(&facet.flow, &active.stress);
            counts[usize::from(facet.tension)] += 1;
        }
        for (entry, step) in new.iter_mut().zip(in_space(&plastic, &axes, 2.0)) {
            *entry += step;
        }
        let along = Elasticity { modulus: 1.0, relative: self.tangent(&trial, &active) };
        Ok(StressPoint {
            stress: in_space(&active.stress, &axes, 1.0),
            tangent: along.turned(&axes).relative,
            branch: (self.branch)(counts[0], counts[1]),
            stored: stored(&active.stress),
            dissipated,
        })
    }
}
