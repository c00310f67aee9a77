//! The program of all products, for scenes with too many rows for an interior-point method.
//!
//! U spans the motions (γ, p·q̇) that satisfy the flow rule, and V the fields (s, θ − a, t − θ) in equilibrium. The
//! products of a state are Z = U Y Vᵀ ≥ 0 with Z_ii = 0 for each pair. The least θ − a of such Z with p·q̇ = 1 is a
//! linear program over a tensor product of two subspaces. The projection onto it is U (Uᵀ · V) Vᵀ, four products of
//! dense matrices for any number of rows. Operator splitting needs no other operation.
//!
//! Splitting with an adapted penalty (Boyd et al., Foundations and Trends in Machine Learning 3 (2011)) gives an
//! estimate and approximate multipliers. The multipliers that prove a bound β are exact: Λ ≥ 0 with Uᵀ (C − β N − Λ) V
//! = 0. The Douglas–Rachford iteration approaches them; conjugate residuals remove the remaining error by changes M ∘
//! (U y Vᵀ), where M vanishes with Λ. If Λ stays ≥ 0, β is proved, and the next bound is half of the way to the
//! estimate; otherwise it is half of the way down.

use super::curve::Curve;
use super::products::{Bound, Kind, Step};
use crate::limit::settings::SETTINGS;
use crate::limit::systems::Systems;
use nalgebra::{DMatrix, DVector};
use voussoir_core::limit::BracketWork;

/// Share of the remaining work that is given to each range.
const WORK_SHARE_OF_RANGE: f64 = 0.6;
/// Share of a range's work for the program itself, and for each trial of a bound.
const WORK_SHARE_OF_PROGRAM: f64 = 0.2;
const WORK_SHARE_OF_TRIAL: f64 = 0.08;
/// Least number of iterations of both.
const MIN_ITERATIONS: usize = 1000;
/// Number of iterations between checks of multipliers.
const ITERATIONS_BETWEEN_CHECKS: usize = 200;
/// Greatest number of conjugate residual iterations of one correction.
const MAX_CONJUGATE_RESIDUALS: usize = 500;
/// Greatest number of supports on which multipliers are corrected in one trial, and of corrections on each.
const MAX_SUPPORTS: usize = 10;
const MAX_CORRECTIONS: usize = 4;
/// Least distance of a trial bound above the proved one, relative to the range.
const LEAST_RAISE: f64 = 0.02;
/// Multipliers below this multiple of the greatest residual, and below the second value, change in proportion.
const FREE_MULTIPLIERS: [f64; 2] = [100.0, 1e-4];
/// Over-relaxation factor.
const OVER_RELAXATION: f64 = 1.7;
/// Initial penalty, in units of the objective.
const INITIAL_PENALTY: f64 = 10.0;
/// Number of iterations between adaptations of the penalty.
const ITERATIONS_BETWEEN_ADAPTATIONS: usize = 100;
/// The first bound that is tried, relative to the estimate.
const FIRST_SHARE: f64 = 0.85;
/// Bounds closer than this share of t count as equal.
const SAME_BOUND: f64 = 1e-3;
/// Number of scalings of the rows.
const ROW_SCALINGS: usize = 8;

/// Returns columns that span the solutions of matrix · x = 0.
fn null_space(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let decomposed = matrix.transpose().col_piv_qr();
    let diagonal = decomposed.r().diagonal();
    let rank = diagonal.iter().filter(|d| d.abs() > SETTINGS.negligible * diagonal[0].abs()).count();
    let columns = matrix.ncols();
    let mut basis = DMatrix::identity(columns, columns);
    decomposed.q_tr_mul(&mut basis);
    basis.rows(rank, columns - rank).transpose()
}

/// Returns orthonormal columns of the same span.
fn orthonormal(columns: DMatrix<f64>) -> DMatrix<f64> {
    let decomposed = columns.col_piv_qr();
    let r = decomposed.r().diagonal();
    let rank = r.iter().filter(|d| d.abs() > SETTINGS.negligible * r[0].abs()).count();
    decomposed.q().columns(0, rank).into_owned()
}

/// Scales rows to similar size. Returns orthonormal columns and the scales.
fn balanced(columns: &DMatrix<f64>) -> (DMatrix<f64>, DVector<f64>) {
    let mut scale = DVector::from_element(columns.nrows(), 1.0);
    let scaled = |scale: &DVector<f64>| {
        let mut by = columns.clone();
        by.row_iter_mut().zip(scale.iter()).for_each(|(mut row, s)| row *= *s);
        orthonormal(by)
    };
    for _ in 0..ROW_SCALINGS {
        let basis = scaled(&scale);
        scale.iter_mut().zip(basis.row_iter()).for_each(|(s, row)| *s /= row.norm_squared().max(1e-4).sqrt().sqrt());
    }
    (scaled(&scale), scale)
}

/// Returns U: γ and p·q̇ of the motions that satisfy the flow rule.
fn motions(systems: &Systems) -> DMatrix<f64> {
    let (groups, pairs) = (systems.equilibrium.len(), systems.pairs.len());
    let mut flow = DMatrix::zeros(systems.forces, groups + pairs);
    for (q, row) in systems.equilibrium.iter().enumerate() {
        row.iter().for_each(|&(j, v)| flow[(j, q)] += v);
    }
    for (i, pair) in systems.pairs.iter().enumerate() {
        pair.flow.iter().for_each(|&(j, v)| flow[(j, groups + i)] += v);
    }
    let free = null_space(&flow);
    let power = DVector::from_column_slice(&systems.varying).transpose() * free.rows(0, groups);
    let mut all = free.rows(groups, pairs).into_owned().insert_row(pairs, 0.0);
    all.row_mut(pairs).copy_from(&power);
    all
}

/// Returns V: s, θ − a and t − θ of the fields in equilibrium.
fn fields(systems: &Systems, [a, t]: [f64; 2]) -> DMatrix<f64> {
    let (rows, forces, pairs) = (systems.equilibrium.len(), systems.forces, systems.pairs.len());
    let mut balance = DMatrix::zeros(rows, forces + 2);
    for (q, row) in systems.equilibrium.iter().enumerate() {
        row.iter().for_each(|&(j, v)| balance[(q, j)] += v);
        balance[(q, forces)] = systems.varying[q];
        balance[(q, forces + 1)] = systems.fixed[q];
    }
    let free = null_space(&balance);
    let (theta, one) = (free.row(forces).into_owned(), free.row(forces + 1).into_owned());
    let mut all = DMatrix::zeros(pairs + 2, free.ncols());
    for (j, pair) in systems.pairs.iter().enumerate() {
        let mut slack = &one * pair.bound;
        pair.normal.iter().for_each(|&(k, v)| slack -= free.row(k) * v);
        all.row_mut(j).copy_from(&slack);
    }
    all.row_mut(pairs).copy_from(&(&theta - &one * a));
    all.row_mut(pairs + 1).copy_from(&(&one * t - &theta));
    all
}

/// A subspace: orthonormal columns, and their transpose.
struct Subspace {
    columns: DMatrix<f64>,
    transposed: DMatrix<f64>,
    scale: DVector<f64>,
}

impl Subspace {
    fn new(columns: &DMatrix<f64>) -> Self {
        let (columns, scale) = balanced(columns);
        Subspace { transposed: columns.transpose(), columns, scale }
    }
}

/// The program over the products of two subspaces, with its work.
struct Products {
    motions: Subspace,
    fields: Subspace,
    pairs: usize,
    range: [f64; 2],
    /// Projection of C, in units of its length.
    objective: DMatrix<f64>,
    /// Length of the projection of C, the unit of multipliers.
    unit: f64,
    /// Projection of N.
    power: DMatrix<f64>,
    /// Number of multiplications.
    work: u64,
}

impl Products {
    fn new(systems: &Systems, range: [f64; 2]) -> Self {
        let (motions, fields) = (Subspace::new(&motions(systems)), Subspace::new(&fields(systems, range)));
        let pairs = systems.pairs.len();
        let none = DMatrix::zeros(0, 0);
        let (objective, power) = (none.clone(), none);
        let mut all = Products { motions, fields, pairs, range, objective, unit: 1.0, power, work: 0 };
        let at = |j: usize, value: f64| value / (all.motions.scale[pairs] * all.fields.scale[j]);
        let (theta, upper) = (at(pairs, 1.0), at(pairs + 1, 1.0));
        let mut matrix = DMatrix::zeros(pairs + 1, pairs + 2);
        matrix[(pairs, pairs)] = theta;
        let objective = all.project(&matrix);
        all.unit = objective.norm();
        all.objective = objective / all.unit;
        matrix[(pairs, pairs)] = theta / (range[1] - range[0]);
        matrix[(pairs, pairs + 1)] = upper / (range[1] - range[0]);
        all.power = all.project(&matrix);
        all
    }

    /// Returns Uᵀ Z V.
    fn inner(&mut self, z: &DMatrix<f64>) -> DMatrix<f64> {
        let (u, v) = (&self.motions, &self.fields);
        let (rows, columns) = z.shape();
        self.work += (u.columns.ncols() * columns * (rows + v.columns.ncols())) as u64;
        &u.transposed * z * &v.columns
    }

    /// Returns U y Vᵀ.
    fn outer(&mut self, y: &DMatrix<f64>) -> DMatrix<f64> {
        let (u, v) = (&self.motions, &self.fields);
        let (rows, columns) = y.shape();
        self.work += (u.columns.nrows() * columns * (rows + v.columns.nrows())) as u64;
        &u.columns * y * &v.transposed
    }

    fn project(&mut self, z: &DMatrix<f64>) -> DMatrix<f64> {
        let inner = self.inner(z);
        self.outer(&inner)
    }

    /// Returns the nearest admissible multipliers: ≥ 0, except that multipliers of γ_i s_i have either sign.
    fn admissible(&self, z: &DMatrix<f64>) -> DMatrix<f64> {
        let mut own = z.map(|z| z.max(0.0));
        (0..self.pairs).for_each(|i| own[(i, i)] = z[(i, i)]);
        own
    }

    /// Returns the least entry among those that must not be negative.
    fn least(&self, z: &DMatrix<f64>) -> f64 {
        let all = (0..z.ncols()).flat_map(|j| (0..z.nrows()).map(move |i| (i, j)));
        all.filter(|&(i, j)| i != j || i == self.pairs).map(|at| z[at]).fold(0.0, f64::min)
    }

    /// Runs the splitting. Returns multipliers, and the bound that they approximately prove.
    fn split(&mut self, iterations: usize) -> (DMatrix<f64>, f64) {
        let length = self.power.norm();
        let unit_power = &self.power / length;
        let (rows, columns) = self.power.shape();
        let mut z = DMatrix::<f64>::zeros(rows, columns);
        let (mut w, mut penalty) = (z.clone(), INITIAL_PENALTY);
        for iteration in 1..=iterations {
            let mut x = self.project(&(&z - &w)) - &self.objective / penalty;
            // p·q̇ = 1, scaled so that the normalisation has length one.
            let short = 1.0 - x.dot(&unit_power);
            x += &unit_power * short;
            let y = &x * OVER_RELAXATION + &z * (1.0 - OVER_RELAXATION) + &w;
            let mut next = y.map(|y| y.max(0.0));
            (0..self.pairs).for_each(|i| next[(i, i)] = 0.0);
            w = y - &next;
            if iteration % ITERATIONS_BETWEEN_ADAPTATIONS == 0 {
                // Errors of Z = U Y Vᵀ and of the equation of the multipliers, each relative to its data.
                let apart = (&x - &next).norm() / next.norm().max(x.norm());
                let by = (apart / (penalty * (&next - &z).norm())).sqrt().clamp(0.5, 2.0);
                if by.is_finite() && !(0.7..=1.4).contains(&by) {
                    penalty *= by;
                    w /= by;
                }
            }
            z = next;
        }
        let multipliers = self.admissible(&(w * -penalty));
        let proved = self.project(&multipliers);
        let left = &self.objective - proved;
        let bound = left.dot(&self.power) / self.power.norm_squared() * self.unit;
        (multipliers, bound)
    }

    /// Searches for exact multipliers of a bound, starting from approximate ones, which are improved.
    fn prove(&mut self, bound: f64, near: &mut DMatrix<f64>, iterations: usize) -> Option<DMatrix<f64>> {
        let target = &self.objective - &self.power * (bound / self.unit);
        let mut nearly = SETTINGS.nearly;
        for iteration in 1..=iterations {
            let own = self.admissible(near);
            let reflected = &own * 2.0 - &*near;
            *near = &own + &target - self.project(&reflected);
            let last = iteration == iterations;
            if iteration % ITERATIONS_BETWEEN_CHECKS == 0 || last {
                let short = &target - &own;
                let moved = &own + self.project(&short);
                if !moved.iter().all(|value| value.is_finite()) {
                    return None;
                }
                if last || self.least(&moved) >= -nearly {
                    if let Some(exact) = self.corrected(&target, own) {
                        return Some(exact);
                    }
                    nearly *= 0.1;
                }
            }
        }
        None
    }

    /// Returns exact multipliers from nearly exact ones.
    fn corrected(&mut self, target: &DMatrix<f64>, mut own: DMatrix<f64>) -> Option<DMatrix<f64>> {
        let mut worst = f64::INFINITY;
        for _ in 0..MAX_SUPPORTS {
            let first = self.inner(&(target - &own)).amax();
            let free = (FREE_MULTIPLIERS[0] * first).clamp(SETTINGS.exact, FREE_MULTIPLIERS[1]);
            let mut freedom = own.map(|v| (v / free).clamp(0.0, 1.0));
            (0..self.pairs).for_each(|i| freedom[(i, i)] = 1.0);
            let mut last = f64::INFINITY;
            for _ in 0..MAX_CORRECTIONS {
                let left = self.inner(&(target - &own));
                let size = left.amax();
                if size <= SETTINGS.exact * own.amax() && self.least(&own) >= 0.0 {
                    return Some(own * self.unit);
                }
                if self.least(&own) < 0.0 || size > 0.5 * last {
                    break;
                }
                last = size;
                let step = self.correction(&freedom, left);
                own += freedom.component_mul(&self.outer(&step));
            }
            if !own.iter().all(|value| value.is_finite()) || first > worst {
                return None;
            }
            worst = first;
            own = self.admissible(&own);
        }
        None
    }

    /// Solves Uᵀ (M ∘ (U y Vᵀ)) V = left for y by conjugate residuals.
    fn correction(&mut self, freedom: &DMatrix<f64>, left: DMatrix<f64>) -> DMatrix<f64> {
        let apply = |all: &mut Self, y: &DMatrix<f64>| {
            let outer = all.outer(y).component_mul(freedom);
            all.inner(&outer)
        };
        let enough = SETTINGS.left * left.norm();
        let mut before = left.norm();
        let mut y = DMatrix::zeros(left.nrows(), left.ncols());
        let mut residual = left;
        let mut image = apply(self, &residual);
        let (mut direction, mut along) = (residual.clone(), image.clone());
        let mut power = residual.dot(&image);
        for _ in 0..MAX_CONJUGATE_RESIDUALS {
            let squared = along.norm_squared();
            if power <= 0.0 || squared == 0.0 {
                break;
            }
            let step = power / squared;
            y += &direction * step;
            residual -= &along * step;
            // Conjugate residuals do not grow, except by rounding.
            let now = residual.norm();
            if now <= enough || now > before {
                break;
            }
            before = now;
            image = apply(self, &residual);
            let next = residual.dot(&image);
            let kept = next / power;
            power = next;
            direction = &residual + direction * kept;
            along = &image + along * kept;
        }
        y
    }

    /// Returns the proof with its multipliers, in the units of the systems.
    fn step(&self, bound: f64, multipliers: &DMatrix<f64>) -> Step {
        let n = self.pairs;
        let mut kinds = Vec::new();
        for i in 0..=n {
            for j in 0..n + 2 {
                let value = multipliers[(i, j)];
                if value == 0.0 {
                    continue;
                }
                let kind = match (i < n, j) {
                    (true, j) if j < n => Kind::Product(i, j),
                    (true, j) if j == n => Kind::GammaTheta(i),
                    (true, _) => Kind::GammaUpperSlack(i),
                    (false, j) if j < n => Kind::Slack(j),
                    (false, j) if j == n => Kind::Theta,
                    (false, _) => Kind::UpperSlack,
                };
                kinds.push((kind, value * self.motions.scale[i] * self.fields.scale[j]));
            }
        }
        Step { raw: self.range[0] + bound, range: self.range, multipliers: kinds }
    }

    /// Returns the greatest bound proved with this work. Calls `raised` with each better bound and its work.
    fn greatest(&mut self, limit: u64, raised: &mut dyn FnMut(u64, f64)) -> Option<Step> {
        let before = self.work;
        let once = self.objective.clone();
        self.project(&once);
        let cost = (self.work - before).max(1) as f64;
        let iterations = |share: f64| ((share * limit as f64 / cost) as usize).max(MIN_ITERATIONS);
        let width = self.range[1] - self.range[0];
        let (mut near, estimate) = self.split(iterations(WORK_SHARE_OF_PROGRAM));
        // The estimate may be inaccurate at first: failed values are tried again after a lower bound is proved.
        let high = if estimate > 0.0 { estimate.min(width) } else { width };
        let (mut low, mut best, mut bound) = (0.0, None, FIRST_SHARE * high);
        while high - low > SAME_BOUND * width && bound > low + LEAST_RAISE * width.min(high - low) && self.work < limit
        {
            match self.prove(bound, &mut near, iterations(WORK_SHARE_OF_TRIAL)) {
                Some(exact) => {
                    low = bound;
                    raised(self.work, self.range[0] + bound);
                    best = Some(self.step(bound, &exact));
                    bound = 0.5 * (low + high);
                }
                None => bound = 0.5 * (low + bound),
            }
        }
        best
    }
}

/// Returns the greatest lower bound of θ for states with θ ≤ `most` that this number of multiplications proves, and the
/// work done.
pub fn split_bound(systems: &Systems, most: f64, limit: u64, curve: &mut Curve) -> (Option<Bound>, u64) {
    let most = most * (1.0 + SETTINGS.above_state);
    let (mut steps, mut proved, mut work) = (Vec::new(), 0.0, 0u64);
    while !systems.pairs.is_empty() && proved < most * (1.0 - SAME_BOUND) {
        let mut products = Products::new(systems, [proved, most]);
        let own = (WORK_SHARE_OF_RANGE * limit.saturating_sub(work) as f64) as u64;
        // No motion of the flow rule has p·q̇ = 1, or too little work is left.
        let hopeless = products.power.norm() < SETTINGS.negligible || own < (MIN_ITERATIONS as u64) * products.work;
        let mut raised = |own: u64, theta: f64| {
            curve.proved(BracketWork::Splitting, (work + own) as f64 / 1e9, theta * (1.0 - SETTINGS.closed));
        };
        let found = if hopeless { None } else { products.greatest(own, &mut raised) };
        work += products.work;
        curve.proved(BracketWork::Splitting, work as f64 / 1e9, 0.0);
        let Some(step) = found else { break };
        proved = step.raw * (1.0 - SETTINGS.closed);
        steps.push(step);
    }
    let bound = (!steps.is_empty()).then_some(Bound { theta: proved, steps });
    (bound, work)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::limit::tests::scenes::{Dry, STUCK, block};

    fn matrix(rows: usize, columns: usize) -> DMatrix<f64> {
        DMatrix::from_fn(rows, columns, |i, j| ((7 * i * i + 11 * j + 5 * i * j + 1) as f64).sin())
    }

    /// The columns of the null space solve the equations; their number is the number of columns minus the rank.
    #[test]
    fn the_null_space_solves_the_equations() {
        let thin = matrix(2, 5);
        for of in [thin.clone(), matrix(4, 2) * thin] {
            let null = null_space(&of);
            assert_eq!(null.ncols(), 3);
            assert!((of * null).amax() < 1e-13);
        }
    }

    /// Balanced columns are orthonormal and span the scaled columns.
    #[test]
    fn balanced_columns_span_the_scaled_ones() {
        let columns = matrix(6, 2);
        let (basis, scale) = balanced(&columns);
        assert!((basis.transpose() * &basis - DMatrix::identity(2, 2)).amax() < 1e-13);
        let scaled = DMatrix::from_diagonal(&scale) * columns;
        assert!((&basis * (basis.transpose() * &scaled) - &scaled).amax() < 1e-12 * scaled.amax());
    }

    /// Virtual work: on a motion that the flow rule allows, a change of the field without a change of the fixed loads does
    /// Δλ p·q̇ = Σ d·Δr γ, which is −Σ Δs γ if flow is associated.
    #[test]
    fn motions_and_fields_obey_virtual_work() {
        let problem = block(1.0, 2.0, Dry { friction: Some(0.6), ..STUCK });
        let systems = Systems::new(&problem, &problem.fixed);
        let (motions, fields) = (motions(&systems), fields(&systems, [0.0, 1.0]));
        let pairs = systems.pairs.len();
        assert!(motions.ncols() > 1 && fields.ncols() == 2);
        // The sum of θ and 1 − θ is the share of the fixed loads.
        let share = |k: usize| fields[(pairs, k)] + fields[(pairs + 1, k)];
        let change = fields.column(0) * share(1) - fields.column(1) * share(0);
        for motion in motions.column_iter() {
            let dissipated = -motion.rows(0, pairs).dot(&change.rows(0, pairs));
            assert!((change[pairs] * motion[pairs] - dissipated).abs() < 1e-13, "{dissipated}");
        }
    }
}
