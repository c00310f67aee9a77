//! A lower bound of θ from products of statics with kinematics: one linear program, no search.
//!
//! At a state, X = γ rᵀ, X_θ = γ θ, Q = q̇ rᵀ and Q_θ = q̇ θ satisfy linear rows: equilibrium times each γ_i and each
//! component of q̇, yield times γ_i ≥ 0 (with equality for the same pair: γ_i s_i = 0), the flow rule times each force,
//! p·q̇ = 1 times each force, θ γ_i ≤ t γ_i. Their least θ is a linear program: the reformulation-linearisation of
//! Sherali & Adams (1990). No bound on γ is assumed.
//!
//! Products of all joints with all joints would be too many. The program keeps products of joints with blocks near each
//! other, and of joints cut by one layer around the ground, with the equilibrium of the part above the cut: only this
//! gives the load on sliding joints. Products that are left out only remove rows, so the bound stays valid.

use crate::limit::settings::SETTINGS;
use crate::limit::systems::Systems;
use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, SupportedConeT};
use std::collections::{BTreeMap, HashMap};
use voussoir_core::limit::{FIRST, LAST, LimitProblem, ProductStep};
use voussoir_core::linear::{Entries, SparseLdlt};

/// Linear form: (index, coefficient).
type Form = Vec<(usize, f64)>;

/// Multipliers below this share of the greatest are set to zero; the values are tried in order.
const SUPPORT_THRESHOLDS: [f64; 5] = [1e-6, 1e-5, 1e-4, 1e-7, 1e-3];
/// Regularisations of the interior-point method; they are tried in order.
const REGULARISATIONS: [f64; 2] = [SETTINGS.apart, SETTINGS.great_shift];
/// Distance of the upper bound of θ in the program above the known state, relative to it.
const MARGIN_ABOVE: f64 = 0.05;
/// The largest neighbourhood that is tried first.
const MAX_REACH: usize = 3;

/// Minimise x_0 subject to equations row·x = h and rows row·x ≥ h.
struct Program {
    columns: usize,
    equations: Vec<(Form, f64)>,
    rows: Vec<(Form, f64)>,
    /// Meaning of each row.
    kinds: Vec<Kind>,
    /// Index of the equation γ_i s_i = 0, with i.
    idle: Vec<(usize, usize)>,
    /// t.
    most: f64,
}

/// A quantity that is not negative.
#[derive(Clone, Copy)]
pub enum Kind {
    /// γ_i.
    Gamma(usize),
    /// γ_i (θ − a).
    GammaTheta(usize),
    /// γ_i (t − θ).
    GammaUpperSlack(usize),
    /// θ − a.
    Theta,
    /// t − θ.
    UpperSlack,
    /// s_j.
    Slack(usize),
    /// γ_i s_j.
    Product(usize, usize),
}

/// A proved bound.
pub struct Bound {
    /// No state has a lower θ.
    pub theta: f64,
    /// Steps of the proof, from below.
    pub steps: Vec<Step>,
}

/// Proof that no state with a ≤ θ ≤ t lies below a bound.
pub struct Step {
    /// The bound before the allowance for rounding.
    pub raw: f64,
    /// a and t.
    pub range: [f64; 2],
    /// Multipliers of the quantities ≥ 0, in the units of the systems; multipliers of γ_i s_i = 0 have either sign.
    pub multipliers: Vec<(Kind, f64)>,
}

impl Step {
    /// Returns the proof in SI units, for load factors from `start`.
    pub fn stored(&self, systems: &Systems, problem: &LimitProblem, start: f64) -> ProductStep {
        let code = |i: usize| {
            let pair = &systems.pairs[i];
            let force = pair.normal[0].0;
            let joint = systems.variables.joints.partition_point(|&(first, _)| first <= force) - 1;
            let first = systems.variables.joints[joint].0;
            let shear = pair.normal.iter().find(|&&(j, _)| j == first + 2).map(|&(_, v)| v);
            let slot = match shear {
                Some(v) if v > 0.0 => 2,
                Some(_) => 3,
                // The upper bound of a force of the fill.
                None if systems.variables.joints[joint].1 == 1 && pair.normal[0].1 > 0.0 => 1,
                None => force - first,
            };
            (4 * problem.joints[joint].joint + slot) as i64
        };
        let (unit, force) = (systems.unit, systems.force);
        let mut sums: BTreeMap<i64, BTreeMap<i64, f64>> = BTreeMap::new();
        let mut add = |i: i64, j: i64, value: f64| *sums.entry(i).or_default().entry(j).or_default() += value;
        for &(kind, z) in &self.multipliers {
            match kind {
                Kind::Gamma(i) => {
                    let share = z / (self.range[1] - self.range[0]) * force / unit;
                    add(code(i), FIRST, share);
                    add(code(i), LAST, share);
                }
                Kind::GammaTheta(i) => add(code(i), FIRST, z * force / unit),
                Kind::GammaUpperSlack(i) => add(code(i), LAST, z * force / unit),
                Kind::Theta => add(FIRST, FIRST, z),
                Kind::UpperSlack => add(FIRST, LAST, z),
                Kind::Slack(j) => add(FIRST, code(j), z * unit / force),
                Kind::Product(i, j) => add(code(i), code(j), z),
            }
        }
        ProductStep {
            range: self.range.map(|end| start + end * unit),
            bound: start + self.raw * unit,
            multipliers: sums.into_iter().map(|(i, row)| (i, row.into_iter().collect())).collect(),
        }
    }
}

/// Products that are kept.
struct Kept {
    /// Pairs of joints.
    joints: Vec<Vec<bool>>,
    /// Pairs of a group's motion and a joint.
    groups: Vec<Vec<bool>>,
    /// Groups above a cut, with the cut joints.
    cuts: Vec<(Vec<usize>, Vec<usize>)>,
}

impl Kept {
    fn new(problem: &LimitProblem, reach: usize) -> Self {
        let (n, m) = (problem.groups, problem.joints.len());
        let of = |k: usize| [problem.joints[k].minus, problem.joints[k].plus].into_iter().flatten();
        let both = |k: usize| problem.joints[k].minus.zip(problem.joints[k].plus);
        let mut distance = vec![vec![usize::MAX / 4; n]; n];
        let mut layer = vec![usize::MAX / 4; n];
        for k in 0..m {
            match both(k) {
                Some((a, b)) => (distance[a][b], distance[b][a]) = (1, 1),
                None => of(k).for_each(|a| layer[a] = 1),
            }
        }
        (0..n).for_each(|a| distance[a][a] = 0);
        for via in 0..n {
            for a in 0..n {
                for b in 0..n {
                    distance[a][b] = distance[a][b].min(distance[a][via] + distance[via][b]);
                }
            }
        }
        let ground: Vec<usize> = (0..n).filter(|&a| layer[a] == 1).collect();
        let depth = |a: usize| ground.iter().map(|&g| distance[a][g] + 1).min().unwrap_or(usize::MAX / 4);
        let depths: Vec<usize> = (0..n).map(depth).collect();
        let mut cuts = Vec::new();
        for d in 1..=n {
            let mut left: Vec<usize> = (0..n).filter(|&a| depths[a] >= d).collect();
            while let Some(first) = left.pop() {
                let mut above = vec![first];
                let mut at = 0;
                while at < above.len() {
                    let here = above[at];
                    at += 1;
                    let (near, far): (Vec<usize>, Vec<usize>) = left.iter().partition(|&&a| distance[here][a] == 1);
                    above.extend(near);
                    left = far;
                }
                let cut: Vec<usize> = (0..m).filter(|&k| of(k).filter(|a| above.contains(a)).count() == 1).collect();
                if above.len() > 1 {
                    above.sort_unstable();
                    cuts.push((above, cut));
                }
            }
        }
        let mut joints: Vec<Vec<bool>> =
            (0..m).map(|k| (0..m).map(|l| of(k).any(|a| of(l).any(|b| distance[a][b] <= reach))).collect()).collect();
        for (_, cut) in &cuts {
            for &k in cut {
                cut.iter().for_each(|&l| joints[k][l] = true);
            }
        }
        let mut groups = vec![vec![false; m]; n];
        for (k, near) in joints.iter().enumerate() {
            for a in of(k) {
                groups[a].iter_mut().zip(near).for_each(|(group, near)| *group |= near);
            }
        }
        Kept { joints, groups, cuts }
    }
}

/// Columns of the products, numbered in the order of first use.
struct Columns {
    of: HashMap<(usize, usize), usize>,
    one: (usize, usize),
}

impl Columns {
    /// Returns the form Σ v (first × second) as a row over columns, and its constant on the right-hand side.
    fn row(&mut self, terms: impl IntoIterator<Item = ((usize, usize), f64)>) -> (Form, f64) {
        let (mut row, mut right) = (Form::new(), 0.0);
        for (key, v) in terms {
            if key == self.one {
                right -= v;
            } else {
                let next = self.of.len();
                row.push((*self.of.entry(key).or_insert(next), v));
            }
        }
        (row, right)
    }
}

/// A program during its construction. Second factors are forces, then θ and 1; first factors are 1, then γ_i, then q̇.
struct Builder<'a> {
    systems: &'a Systems,
    kept: Kept,
    columns: Columns,
    program: Program,
    /// Joint of each force variable.
    joint_of: Vec<usize>,
}

impl Builder<'_> {
    /// Returns the index of θ among the second factors; 1 comes after it.
    fn theta(&self) -> usize {
        self.systems.forces
    }

    fn one(&self) -> usize {
        self.systems.forces + 1
    }

    /// Returns the index of γ_i among the first factors.
    fn gamma(&self, i: usize) -> usize {
        1 + i
    }

    /// Returns the index of a component of q̇ among the first factors.
    fn velocity(&self, q: usize) -> usize {
        1 + self.systems.pairs.len() + q
    }

    fn joint_of_pair(&self, i: usize) -> usize {
        self.joint_of[self.systems.pairs[i].normal[0].0]
    }

    /// Returns the equilibrium of each group and of the part above each cut, with the joints in it.
    fn balances(&self) -> Vec<(Form, Vec<usize>)> {
        let (systems, theta, one) = (self.systems, self.theta(), self.one());
        let mut balances: Vec<(Form, Vec<usize>)> = Vec::new();
        for (q, own) in systems.equilibrium.iter().enumerate() {
            let mut form = own.clone();
            let joints = form.iter().map(|&(j, _)| self.joint_of[j]).collect();
            form.extend([(theta, systems.varying[q]), (one, systems.fixed[q])]);
            balances.push((form, joints));
        }
        for (above, cut) in &self.kept.cuts {
            for x in 0..3 {
                let mut sum = vec![0.0f64; systems.forces + 2];
                for &group in above {
                    systems.equilibrium[3 * group + x].iter().for_each(|&(j, v)| sum[j] += v);
                    sum[theta] += systems.varying[3 * group + x];
                    sum[one] += systems.fixed[3 * group + x];
                }
                // Forces between two groups above the cut cancel, except for rounding.
                (0..systems.forces).filter(|&j| !cut.contains(&self.joint_of[j])).for_each(|j| sum[j] = 0.0);
                balances.push((sum.into_iter().enumerate().collect(), cut.clone()));
            }
        }
        balances.iter_mut().for_each(|(form, _)| form.retain(|&(_, v)| v != 0.0));
        balances
    }

    /// Adds equilibrium times 1, γ_i and q̇; `None` if this gives more than `most` equations.
    fn equilibrium(&mut self, most: usize) -> Option<()> {
        let (pairs, rows) = (self.systems.pairs.len(), self.systems.equilibrium.len());
        for (index, (form, joints)) in self.balances().iter().enumerate() {
            let times = |first: usize| form.iter().map(move |&(l, v)| ((first, l), v));
            if index < rows {
                self.program.equations.push(self.columns.row(times(0)));
            }
            for i in 0..pairs {
                let near = &self.kept.joints[self.joint_of_pair(i)];
                if joints.iter().all(|&k| near[k]) {
                    self.program.equations.push(self.columns.row(times(self.gamma(i))));
                }
            }
            for q in 0..rows {
                if joints.iter().all(|&k| self.kept.groups[q / 3][k]) {
                    self.program.equations.push(self.columns.row(times(self.velocity(q))));
                }
            }
            if self.program.equations.len() > most {
                return None;
            }
        }
        Some(())
    }

    /// Adds the rows γ_i, γ_i θ, γ_i (t − θ) and θ ≥ 0.
    fn signs(&mut self) {
        let (theta, one, t) = (self.theta(), self.one(), self.program.most);
        for i in 0..self.systems.pairs.len() {
            let gamma = self.gamma(i);
            let program = &mut self.program;
            program.rows.push(self.columns.row([((gamma, one), 1.0)]));
            program.rows.push(self.columns.row([((gamma, theta), 1.0)]));
            program.rows.push(self.columns.row([((gamma, one), t), ((gamma, theta), -1.0)]));
            program.kinds.extend([Kind::Gamma(i), Kind::GammaTheta(i), Kind::GammaUpperSlack(i)]);
        }
        self.program.rows.push(self.columns.row([((0, theta), 1.0)]));
        self.program.kinds.push(Kind::Theta);
    }

    /// Adds s_j ≥ 0, γ_i s_j ≥ 0 and γ_i s_i = 0.
    fn slacks(&mut self) {
        let one = self.one();
        for (j, pair) in self.systems.pairs.iter().enumerate() {
            let slack = |first: usize| {
                let forces = pair.normal.iter().map(move |&(l, v)| ((first, l), -v));
                forces.chain((pair.bound != 0.0).then_some(((first, one), pair.bound)))
            };
            self.program.rows.push(self.columns.row(slack(0)));
            self.program.kinds.push(Kind::Slack(j));
            for i in 0..self.systems.pairs.len() {
                if !self.kept.joints[self.joint_of_pair(i)][self.joint_of_pair(j)] {
                    continue;
                }
                let row = self.columns.row(slack(self.gamma(i)));
                if i == j {
                    self.program.idle.push((self.program.equations.len(), i));
                    self.program.equations.push(row);
                } else {
                    self.program.rows.push(row);
                    self.program.kinds.push(Kind::Product(i, j));
                }
            }
        }
    }

    /// Adds the flow rule of each force variable, Eᵀ q̇ + Dᵀ γ = 0, and p·q̇ = 1, each times forces, θ and 1; `None` if
    /// there are more than `most` equations and rows.
    fn flow_rule(&mut self, most: usize) -> Option<()> {
        let systems = self.systems;
        let mut flow: Vec<(Form, usize)> = self.joint_of.iter().map(|&joint| (Form::new(), joint)).collect();
        for (q, entries) in systems.equilibrium.iter().enumerate() {
            entries.iter().for_each(|&(j, v)| flow[j].0.push((self.velocity(q), v)));
        }
        for (i, pair) in systems.pairs.iter().enumerate() {
            pair.flow.iter().for_each(|&(j, v)| flow[j].0.push((self.gamma(i), v)));
        }
        let loaded: Vec<usize> = (0..systems.varying.len()).filter(|&q| systems.varying[q] != 0.0).collect();
        for l in 0..systems.forces + 2 {
            // θ and 1 belong to no joint.
            let at = self.joint_of.get(l).copied();
            for (form, k) in &flow {
                if at.is_none_or(|at| self.kept.joints[*k][at]) {
                    self.program.equations.push(self.columns.row(form.iter().map(|&(first, v)| ((first, l), v))));
                }
            }
            if at.is_none_or(|at| loaded.iter().all(|&q| self.kept.groups[q / 3][at])) {
                let power: Vec<_> = loaded.iter().map(|&q| ((self.velocity(q), l), systems.varying[q])).collect();
                self.program.equations.push(self.columns.row(power.into_iter().chain([((0, l), -1.0)])));
            }
            if self.program.equations.len() + self.program.rows.len() > most {
                return None;
            }
        }
        Some(())
    }
}

impl Program {
    /// Creates the rows for θ ≤ t with products up to `reach`; `None` if there are more than `most` rows.
    fn new(systems: &Systems, problem: &LimitProblem, t: f64, reach: usize, most: usize) -> Option<Self> {
        let mut joint_of = vec![0; systems.forces];
        for (k, &(first, own)) in systems.variables.joints.iter().enumerate() {
            (first..first + own).for_each(|j| joint_of[j] = k);
        }
        let (theta, one) = (systems.forces, systems.forces + 1);
        let columns = Columns { of: HashMap::from([((0, theta), 0)]), one: (0, one) };
        let (equations, rows, kinds, idle) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let program = Program { columns: 0, equations, rows, kinds, idle, most: t };
        let mut builder = Builder { systems, kept: Kept::new(problem, reach), columns, program, joint_of };
        builder.equilibrium(most)?;
        builder.signs();
        builder.slacks();
        builder.flow_rule(most)?;
        let Builder { columns, mut program, .. } = builder;
        program.columns = columns.of.len();
        Some(program)
    }

    /// Computes multipliers by an interior-point method: of the equations, then of the rows (≥ 0).
    fn multipliers(&self, regularisation: f64) -> Option<(Vec<f64>, u64)> {
        let (mut i, mut j, mut v, mut right) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
        let equations = self.equations.iter().map(|row| (row, 1.0));
        for ((form, h), sign) in equations.chain(self.rows.iter().map(|row| (row, -1.0))) {
            for &(column, value) in form {
                i.push(right.len());
                j.push(column);
                v.push(sign * value);
            }
            right.push(sign * h);
        }
        let a = CscMatrix::new_from_triplets(right.len(), self.columns, i, j, v);
        let p = CscMatrix::<f64>::zeros((self.columns, self.columns));
        let mut q = vec![0.0; self.columns];
        q[0] = 1.0;
        let cones =
            [SupportedConeT::ZeroConeT(self.equations.len()), SupportedConeT::NonnegativeConeT(self.rows.len())];
        // The rows depend on each other: the factorisation needs more regularisation than usual.
        let settings = DefaultSettings::<f64> {
            verbose: false,
            max_iter: 100,
            max_threads: 1,
            static_regularization_constant: regularisation,
            ..DefaultSettings::default()
        };
        let mut solver = DefaultSolver::new(&p, &q, &a, &right, &cones, settings).ok()?;
        solver.solve();
        // The status of the solver does not matter: the multipliers are corrected and their bound recomputed.
        let z = &solver.solution.z;
        z.iter().all(|v| v.is_finite()).then(|| (z.clone(), u64::from(solver.solution.iterations)))
    }

    /// Returns a row in the form of Clarabel: linear form, right-hand side and sign.
    fn signed(&self, k: usize) -> (&Form, f64, f64) {
        match self.equations.get(k) {
            Some((form, h)) => (form, *h, 1.0),
            None => {
                let (form, h) = &self.rows[k - self.equations.len()];
                (form, -h, -1.0)
            }
        }
    }

    /// Returns x_0 + (signed rows)ᵀ z, which is zero for multipliers that prove a bound.
    fn residual(&self, z: &[f64]) -> Vec<f64> {
        let mut r = vec![0.0; self.columns];
        r[0] = 1.0;
        for (k, z) in z.iter().enumerate().filter(|(_, z)| **z != 0.0) {
            let (form, _, sign) = self.signed(k);
            form.iter().for_each(|&(j, v)| r[j] += sign * v * z);
        }
        r
    }

    /// Returns the bound that multipliers prove: x_0 ≥ −Σ h z if x_0 + (signed rows)ᵀ z = 0 and z ≥ 0 on rows.
    /// Multipliers below one of several thresholds are set to zero; the others are corrected to satisfy the equation to
    /// rounding.
    fn bound(&self, z: &[f64]) -> Option<Bound> {
        SUPPORT_THRESHOLDS.into_iter().find_map(|least| self.bound_on(least, z.to_vec()))
    }

    fn bound_on(&self, least: f64, mut z: Vec<f64>) -> Option<Bound> {
        let (e, m, n) = (self.equations.len(), z.len(), self.columns);
        let scale = z.iter().fold(1.0f64, |m, z| m.max(z.abs()));
        z[e..].iter_mut().filter(|z| **z < least * scale).for_each(|z| *z = 0.0);
        let support: Vec<usize> = (0..m).filter(|&k| k < e || z[k] > 0.0).collect();
        let sizes: Vec<f64> = support.iter().map(|&k| if k < e { scale } else { z[k] }.sqrt()).collect();
        let mut entries: Entries = (0..support.len()).map(|k| (k, k, 1.0)).collect();
        let first = support.len();
        entries.extend((0..n).map(|j| (first + j, first + j, -SETTINGS.active)));
        for (k, (&row, size)) in support.iter().zip(&sizes).enumerate() {
            let (form, _, sign) = self.signed(row);
            for &(j, v) in form {
                entries.push((first + j, k, sign * v * size));
                entries.push((k, first + j, sign * v * size));
            }
        }
        let factorised = SparseLdlt::new(first + n, first, &entries)?;
        for _ in 0..8 {
            let r = self.residual(&z);
            let worst = r.iter().fold(0.0f64, |m, r| m.max(r.abs()));
            if worst <= SETTINGS.rounding * scale {
                let proved: f64 = -support.iter().map(|&k| self.signed(k).1 * z[k]).sum::<f64>();
                let positive = z[e..].iter().all(|z| *z >= 0.0);
                let kinds = self.kinds.iter().copied().zip(z[e..].iter().copied());
                let idle = self.idle.iter().map(|&(k, i)| (Kind::Product(i, i), -z[k]));
                let multipliers = kinds.chain(idle).filter(|(_, z)| *z != 0.0).collect();
                let theta = proved - SETTINGS.product_margin * worst;
                let step = Step { raw: proved, range: [0.0, self.most], multipliers };
                return positive.then(|| Bound { theta, steps: vec![step] });
            }
            let mut load = vec![0.0; first];
            load.extend(r.iter().map(|r| -r));
            let step = factorised.solve(&load)?;
            support.iter().zip(&sizes).zip(&step).for_each(|((&k, size), step)| z[k] += size * step);
        }
        None
    }
}

/// Returns the greatest lower bound of θ for states with θ ≤ t, from the widest neighbourhood with at most `most` rows,
/// and the number of iterations. `None` if the smallest neighbourhood (with `widest_only` the widest) has more rows, or
/// if nothing was proved.
pub fn lower_bound(
    systems: &Systems,
    problem: &LimitProblem,
    t: f64,
    most: usize,
    widest_only: bool,
) -> (Option<Bound>, u64) {
    // A margin above the known state gives the program an interior, which the method needs.
    let above = t * (1.0 + MARGIN_ABOVE);
    let fits = |reach: usize| Program::new(systems, problem, above, reach, most);
    let least = if widest_only { MAX_REACH } else { 0 };
    let Some(program) = (least..=MAX_REACH).rev().find_map(fits) else { return (None, 0) };
    let mut work = 0;
    for regularisation in REGULARISATIONS {
        let Some((z, iterations)) = program.multipliers(regularisation) else { continue };
        work += iterations;
        if let Some(bound) = program.bound(&z) {
            return (Some(bound), work);
        }
    }
    (None, work)
}
