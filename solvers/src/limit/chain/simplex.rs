//! The simplex method on elementary mechanisms: min β·y with Σ y_i a_i = c, y ≥ 0. Columns are priced joint by joint;
//! stress blocks are represented by tangents.

use super::layout::{Forms, Trees, add_weighted};
use super::small_lu::SmallLu;
use crate::limit::settings::SETTINGS;
use crate::linear::inner;
use nalgebra::{DMatrix, DVector, Vector2, Vector3};
use std::cmp::Ordering;
use voussoir_core::law::{ForceRow, StressBlock};
use voussoir_core::limit::{JointForce, LimitProblem, Velocity};

/// Violations of stress blocks below which Newton's method is tried, in order; then the tangents give the answer.
const BLOCK_TOLERANCES: [f64; 4] = [SETTINGS.shift, SETTINGS.negligible, SETTINGS.balanced, SETTINGS.rounding];
const MAX_PIVOTS: u64 = 5000;

/// The elementary mechanism of a column.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Column {
    /// A linear row of a joint's strength.
    Row { joint: usize, row: usize },
    /// The tangent at `u` of a joint's stress block, which bounds the force at one end.
    Tangent { joint: usize, end: usize, u: f64 },
    /// The upper bound of the objective.
    Cap,
    /// Not a mechanism: ± a unit vector, for the start.
    Artificial { variable: usize },
}

/// A linear program over the affine joint forces.
pub struct Program<'a> {
    problem: &'a LimitProblem,
    forms: &'a Forms,
    force: f64,
    /// The rows of the joints' strengths in the form that pivots use, row after row: the coefficients over the
    /// variables of `forms`; 1, or 0 if the row can have no slack; and the bound in units of the force scale, minus the
    /// constants of the forms.
    rows: Vec<f64>,
    /// End of the rows of each joint, counted in rows.
    ends: Vec<usize>,
    /// True if every row can have slack.
    slack: bool,
    /// True if any joint crushes.
    crushes: bool,
    margin: bool,
    /// True if any point with a margin is sufficient.
    any_field: bool,
    cap: f64,
    /// Number of variables.
    pub variables: usize,
}

/// An optimum: the point, and the columns that prove it with their multipliers.
#[derive(Debug, Clone)]
pub struct Solved {
    pub value: f64,
    pub point: Vec<f64>,
    pub columns: Vec<(Column, f64)>,
    pub capped: bool,
}

#[derive(Debug, Clone)]
pub enum Outcome {
    Optimal(Solved),
    /// A direction with objective 1 that no row bounds.
    Unbounded(Vec<f64>),
    /// No point satisfies all rows: columns with Σ y_i a_i = 0, β·y < 0, y ≥ 0: a refuting motion.
    Infeasible(Vec<(Column, f64)>),
    Failed(String),
}

#[derive(Debug, Clone, Copy, Default)]
pub struct Work {
    pub pivots: u64,
    pub newton_iterations: u64,
}

struct Basis {
    columns: Vec<Column>,
    /// Gradients of the columns, one after the other.
    matrix: Vec<f64>,
    /// Origin of the lexicographic rule.
    origin: Vec<f64>,
    lu: SmallLu,
}

enum Ending {
    Optimal {
        point: Vec<f64>,
        weights: Vec<f64>,
    },
    /// A point that satisfies all rows, if any point is sufficient.
    Enough(Vec<f64>),
    /// A column that can enter without limit, with its weight and the weights of the basis columns that change with it.
    NoLeaving(Vec<(Column, f64)>),
    Stuck(String),
}

impl<'a> Program<'a> {
    /// Creates a program that maximises the last factor of `forms`.
    pub fn new(problem: &'a LimitProblem, forms: &'a Forms, force: f64) -> Self {
        let count: usize = problem.joints.iter().map(|joint| joint.strength.rows.len()).sum();
        let mut rows = vec![0.0; count * (forms.variables + 2)];
        match forms.variables {
            3 => write_rows(3, problem, forms, force, &mut rows),
            4 => write_rows(4, problem, forms, force, &mut rows),
            known => write_rows(known, problem, forms, force, &mut rows),
        }
        let (mut ends, mut slack, mut end) = (Vec::with_capacity(problem.joints.len()), true, 0);
        for joint in &problem.joints {
            end += joint.strength.rows.len();
            ends.push(end);
            slack &= joint.strength.rows.iter().all(can_be_slack);
        }
        let crushes = problem.joints.iter().any(|joint| joint.strength.block.is_some());
        let (variables, cap) = (forms.variables, f64::INFINITY);
        Program { problem, forms, force, rows, ends, slack, crushes, margin: false, any_field: false, cap, variables }
    }

    /// Maximises the least slack of all rows instead, up to 1.
    pub fn with_margin(mut self) -> Self {
        self.margin = true;
        self.cap = 1.0;
        self.variables += 1;
        self
    }

    /// Maximises the margin, but ends at the first point that satisfies all rows without it: its margin is then greater
    /// than the worst violation. This is not used if a row can have no slack or if a joint crushes.
    pub fn with_any_margin(mut self) -> Self {
        self.any_field = !self.crushes && self.slack;
        self.with_margin()
    }

    /// Adds an upper bound of the objective.
    pub fn with_cap(mut self, cap: f64) -> Self {
        self.cap = cap;
        self
    }

    fn form(&self, joint: usize, i: usize) -> &[f64] {
        self.forms.form(joint, i)
    }

    /// Returns a row of a joint in the form that pivots use.
    fn row(&self, joint: usize, row: usize) -> (&[f64], f64, f64) {
        let first = joint.checked_sub(1).map_or(0, |before| self.ends[before]);
        let stride = self.forms.variables + 2;
        let (a, rest) = self.rows[(first + row) * stride..][..stride].split_at(self.forms.variables);
        (a, rest[0], rest[1])
    }

    /// Returns (N_0, N_1, T) at a point, in units of the force scale; with `constant` 0 without the fixed loads.
    fn evaluate(&self, joint: usize, point: &[f64], constant: f64) -> [f64; 3] {
        std::array::from_fn(|i| {
            let form = self.form(joint, i);
            let (coefficients, last) = form.split_at(self.forms.variables);
            coefficients.iter().zip(point).map(|(a, x)| a * x).sum::<f64>() + constant * last[0]
        })
    }

    fn slack_variable(&self, point: &[f64]) -> f64 {
        if self.margin { point[self.variables - 1] } else { 0.0 }
    }

    fn block(&self, joint: usize) -> Option<StressBlock> {
        self.problem.joints[joint]
            .strength
            .block
            .map(|b| StressBlock { tension: b.tension / self.force, total: b.total / self.force })
    }

    /// Returns the coefficients of a column over (N_0, N_1, T); `None` for cap and artificials.
    fn weights(&self, column: Column) -> Option<(usize, [f64; 3])> {
        match column {
            Column::Row { joint, row } => Some((joint, self.problem.joints[joint].strength.rows[row].normal)),
            Column::Tangent { joint, end, u } => {
                let slope = 2.0 * u / self.block(joint)?.total;
                let mut weights = [slope, slope, 0.0];
                weights[end] -= 2.0;
                Some((joint, weights))
            }
            Column::Cap | Column::Artificial { .. } => None,
        }
    }

    /// Writes the vector a of a column and returns its β.
    fn write(&self, column: Column, a: &mut [f64]) -> f64 {
        a.fill(0.0);
        let known = self.forms.variables;
        match column {
            Column::Row { joint, row } => {
                let (own, margin, beta) = self.row(joint, row);
                a[..known].copy_from_slice(own);
                if self.margin {
                    a[self.variables - 1] = margin;
                }
                beta
            }
            Column::Tangent { joint, u, .. } => {
                let block = self.block(joint).expect("tangents belong to stress blocks");
                let bound = u * u / block.total - 2.0 * u / block.total * block.tension + block.tension;
                let weights = self.weights(column).map_or([0.0; 3], |(_, weights)| weights);
                let beta = add_weighted(known, self.forms.of_joint(joint), &weights, bound, a);
                if self.margin {
                    a[self.variables - 1] = 1.0;
                }
                beta
            }
            Column::Artificial { variable } => {
                a[variable] = 1.0;
                0.0
            }
            Column::Cap => {
                a[self.variables - 1] = 1.0;
                self.cap
            }
        }
    }

    /// Calls `visit` with every column whose violation at `point`, evaluated by `measure`, is above `least`; `visit`
    /// returns the new `least`. With `constant` 0 it scans the recession cone. For arches, with at most three
    /// redundants and a factor, the number of variables is a constant, so that the compiler unrolls the loops.
    fn scan(
        &self,
        (point, constant): (&[f64], f64),
        measure: impl Fn(f64) -> f64 + Copy,
        least: f64,
        visit: &mut dyn FnMut(Column, f64) -> f64,
    ) {
        let at = (point, constant);
        match self.forms.variables {
            3 => self.scan_by(3, at, measure, least, visit),
            4 => self.scan_by(4, at, measure, least, visit),
            known => self.scan_by(known, at, measure, least, visit),
        }
    }

    /// Scans with this number of variables.
    #[inline(always)]
    fn scan_by(
        &self,
        known: usize,
        (point, constant): (&[f64], f64),
        measure: impl Fn(f64) -> f64 + Copy,
        mut least: f64,
        visit: &mut dyn FnMut(Column, f64) -> f64,
    ) {
        let (slack, x, stride) = (self.slack_variable(point), &point[..known], known + 2);
        let mut first = 0;
        for (joint, &end) in self.ends.iter().enumerate() {
            for (row, r) in self.rows[first * stride..end * stride].chunks_exact(stride).enumerate() {
                let size = measure(inner(&r[..known], x) + r[known] * slack - constant * r[known + 1]);
                if size > least {
                    least = visit(Column::Row { joint, row }, size);
                }
            }
            first = end;
            if self.crushes
                && let Some(block) = self.block(joint)
            {
                let forces = self.evaluate(joint, point, constant);
                tangents(joint, &block, forces, constant, slack, &mut |column, violation| {
                    let size = measure(violation);
                    if size > least {
                        least = visit(column, size);
                    }
                });
            }
        }
        if self.cap.is_finite() {
            let size = measure(point[self.variables - 1] - constant * self.cap);
            if size > least {
                visit(Column::Cap, size);
            }
        }
    }

    /// Returns the most violated column and its violation.
    fn entering(&self, point: &[f64], constant: f64, block_tolerance: f64, basis: &[Column]) -> Option<(Column, f64)> {
        let mut worst: Option<(Column, f64)> = None;
        let size = point.iter().fold(1.0f64, |m, x| m.max(x.abs()));
        let least = SETTINGS.rounding * size;
        self.scan((point, constant), |violation| violation, least, &mut |column, violation| {
            let tangent = constant != 0.0 && matches!(column, Column::Tangent { .. });
            if !basis.contains(&column) && (!tangent || violation > block_tolerance * size) {
                worst = Some((column, violation));
            }
            worst.map_or(least, |(_, violation)| violation)
        });
        worst
    }

    /// Returns the rows active at a point.
    pub fn active(&self, point: &[f64]) -> Vec<Column> {
        let size = point.iter().fold(1.0f64, |m, x| m.max(x.abs()));
        let mut active = Vec::new();
        let least = -SETTINGS.admissible * size;
        self.scan((point, 1.0), |violation| violation, least, &mut |column, _| {
            active.push(column);
            least
        });
        active
    }

    /// Returns the vector a of a column.
    pub fn gradient(&self, column: Column) -> DVector<f64> {
        let mut a = DVector::zeros(self.variables);
        self.write(column, a.as_mut_slice());
        a
    }

    /// Solves the program.
    pub fn solve(&self) -> (Outcome, Work) {
        let mut work = Work::default();
        let m = self.variables;
        let columns: Vec<_> =
            (0..m)
                .map(|variable| {
                    if variable == m - 1 && self.cap.is_finite() {
                        Column::Cap
                    } else {
                        Column::Artificial { variable }
                    }
                })
                .collect();
        let identity: Vec<f64> = (0..m * m).map(|k| f64::from(u8::from(k % (m + 1) == 0))).collect();
        let mut basis = Basis { columns, matrix: identity.clone(), origin: identity, lu: SmallLu::new(m) };
        if !self.cap.is_finite() {
            match self.iterate(&mut basis, true, SETTINGS.rounding, &mut work) {
                Ending::Optimal { point, .. } if point[m - 1] > SETTINGS.active => {
                    return (Outcome::Unbounded(point.iter().map(|x| x / point[m - 1]).collect()), work);
                }
                Ending::Optimal { .. } => {}
                Ending::NoLeaving(_) | Ending::Enough(_) => {
                    return (Outcome::Failed("phase one has no optimum".into()), work);
                }
                Ending::Stuck(why) => return (Outcome::Failed(why), work),
            }
        }
        self.drive_out(&mut basis);
        let mut outcome = Outcome::Failed(String::new());
        for block_tolerance in BLOCK_TOLERANCES {
            let last = Some(&block_tolerance) == BLOCK_TOLERANCES.last();
            outcome = match self.iterate(&mut basis, false, block_tolerance, &mut work) {
                Ending::Optimal { point, weights } => self.finish(&basis, point, weights, last, &mut work),
                Ending::Enough(point) => {
                    Outcome::Optimal(Solved { value: point[m - 1], point, columns: Vec::new(), capped: false })
                }
                Ending::NoLeaving(refutation) => Outcome::Infeasible(refutation),
                Ending::Stuck(why) => Outcome::Failed(why),
            };
            if !matches!(outcome, Outcome::Failed(_)) {
                break;
            }
        }
        (outcome, work)
    }

    /// Returns the cost of a column: in phase one 1 for artificials of the objective, otherwise β.
    fn cost(&self, column: Column, beta: f64, phase_one: bool) -> f64 {
        match (phase_one, column) {
            (true, Column::Artificial { .. }) => 1.0,
            (true, _) => 0.0,
            (false, _) => beta,
        }
    }

    fn iterate(&self, basis: &mut Basis, phase_one: bool, block_tolerance: f64, work: &mut Work) -> Ending {
        let m = self.variables;
        let constant = if phase_one { 0.0 } else { 1.0 };
        basis.origin.clone_from(&basis.matrix);
        let [mut weights, mut point, mut change, mut step] = [(); 4].map(|()| vec![0.0; m]);
        let mut costs: Vec<f64> =
            basis.columns.iter().map(|&column| self.cost(column, self.write(column, &mut change), phase_one)).collect();
        for _ in 0..MAX_PIVOTS {
            if !basis.lu.factorise(&basis.matrix) {
                return Ending::Stuck("the simplex basis became singular".into());
            }
            weights.fill(0.0);
            weights[m - 1] = 1.0;
            basis.lu.solve(&mut weights);
            point.copy_from_slice(&costs);
            basis.lu.solve_transposed(&mut point);
            // One step of refinement, because λ is read from this point.
            for ((step, cost), column) in step.iter_mut().zip(&costs).zip(basis.matrix.chunks_exact(m)) {
                *step = cost - inner(column, &point);
            }
            basis.lu.solve_transposed(&mut step);
            point.iter_mut().zip(&step).for_each(|(x, step)| *x += step);
            let Some((column, violation)) = self.entering(&point, constant, block_tolerance, &basis.columns) else {
                return Ending::Optimal { point, weights };
            };
            if self.any_field && violation <= self.slack_variable(&point) {
                return Ending::Enough(point);
            }
            // The buffer of the step, which is not needed any more, holds the entering column.
            let entering = &mut step;
            let beta = self.write(column, entering);
            change.copy_from_slice(entering);
            basis.lu.solve(&mut change);
            let Some(leaving) = leaving(&weights, &change, &mut basis.lu, &basis.origin) else {
                let steady =
                    basis.columns.iter().zip(change.iter()).map(|(&column, change)| (column, (-change).max(0.0)));
                let moving = steady.chain([(column, 1.0)]).filter(|(_, weight)| *weight > 0.0);
                return Ending::NoLeaving(moving.collect());
            };
            basis.columns[leaving] = column;
            basis.matrix[leaving * m..(leaving + 1) * m].copy_from_slice(entering);
            costs[leaving] = self.cost(column, beta, phase_one);
            work.pivots += 1;
        }
        Ending::Stuck(format!("no optimum after {MAX_PIVOTS} pivots"))
    }

    /// Replaces artificials, which are zero, by real columns if possible.
    fn drive_out(&self, basis: &mut Basis) {
        let m = self.variables;
        let mut row = vec![0.0; m];
        for place in 0..m {
            if !matches!(basis.columns[place], Column::Artificial { .. }) || !basis.lu.factorise(&basis.matrix) {
                continue;
            }
            row.fill(0.0);
            row[place] = 1.0;
            basis.lu.solve_transposed(&mut row);
            let mut best: (f64, Option<Column>) = (SETTINGS.active, None);
            // In the recession cone the violation at a point is its product with the column.
            self.scan((&row, 0.0), f64::abs, best.0, &mut |column, product| {
                if !basis.columns.contains(&column) {
                    best = (product, Some(column));
                }
                best.0
            });
            if let Some(column) = best.1 {
                basis.columns[place] = column;
                self.write(column, &mut basis.matrix[place * m..(place + 1) * m]);
            }
        }
    }

    /// Returns the answer of the last basis; Newton's method improves it if stress blocks are active. `last`: the
    /// tangents are close enough to replace their blocks if Newton's method fails.
    fn finish(&self, basis: &Basis, mut point: Vec<f64>, weights: Vec<f64>, last: bool, work: &mut Work) -> Outcome {
        let mut merged: Vec<(Column, f64)> = Vec::new();
        for (&column, &weight) in basis.columns.iter().zip(weights.iter()) {
            let same = |other: &Column| match (column, *other) {
                (Column::Tangent { joint, end, .. }, Column::Tangent { joint: j, end: e, .. }) => {
                    (joint, end) == (j, e)
                }
                _ => false,
            };
            match merged.iter_mut().find(|(other, _)| same(other)) {
                Some((_, sum)) => *sum += weight,
                None => merged.push((column, weight)),
            }
        }
        merged.retain(|(column, _)| !matches!(column, Column::Artificial { .. }));
        if merged.iter().any(|(column, _)| matches!(column, Column::Tangent { .. })) {
            // Rows with zero multipliers may be active by chance.
            let mut trial: Vec<_> =
                merged.iter().copied().filter(|(_, weight)| *weight > SETTINGS.negligible).collect();
            let mut moved = point.clone();
            match self.newton(&mut moved, &mut trial, work) {
                Ok(()) => (point, merged) = (moved, trial),
                Err(_) if last => {}
                Err(why) => return Outcome::Failed(why),
            }
        }
        let capped = merged.iter().any(|&(column, weight)| column == Column::Cap && weight > SETTINGS.active);
        merged.retain(|&(column, weight)| column != Column::Cap && weight > SETTINGS.pivot);
        Outcome::Optimal(Solved { value: point[self.variables - 1], point, columns: merged, capped })
    }

    /// Solves the stationarity Σ y_i ∇c_i(v) = c with c_i(v) = 0 for the given columns by Newton's method.
    fn newton(&self, point: &mut [f64], columns: &mut [(Column, f64)], work: &mut Work) -> Result<(), String> {
        let (m, k) = (self.variables, columns.len());
        let mut a = vec![0.0; m];
        for _ in 0..30 {
            work.newton_iterations += 1;
            let mut kkt = DMatrix::zeros(m + k, m + k);
            let mut residual = DVector::zeros(m + k);
            residual[m - 1] = -1.0;
            for (place, (column, weight)) in columns.iter_mut().enumerate() {
                if let Column::Tangent { joint, u, .. } = column {
                    let forces = self.evaluate(*joint, point, 1.0);
                    let block = self.block(*joint).expect("tangents belong to stress blocks");
                    *u = forces[0] + forces[1] + block.tension;
                    let gradient = DVector::from_fn(m, |i, _| {
                        if i < self.forms.variables { self.form(*joint, 0)[i] + self.form(*joint, 1)[i] } else { 0.0 }
                    });
                    let curvature = &gradient * gradient.transpose() * (2.0 * *weight / block.total);
                    let mut hessian = kkt.view_mut((0, 0), (m, m));
                    hessian += &curvature;
                }
                let beta = self.write(*column, &mut a);
                for i in 0..m {
                    kkt[(i, m + place)] = a[i];
                    kkt[(m + place, i)] = a[i];
                    residual[i] += *weight * a[i];
                }
                residual[m + place] = a.iter().zip(point.iter()).map(|(a, x)| a * x).sum::<f64>() - beta;
            }
            let size = point.iter().fold(1.0f64, |s, x| s.max(x.abs()));
            if residual.amax() <= 4.0 * SETTINGS.zero * size {
                break;
            }
            let Some(step) = kkt.lu().solve(&residual) else {
                return Err("Newton's method on the stress blocks met a singular system".into());
            };
            (0..m).for_each(|i| point[i] -= step[i]);
            columns.iter_mut().enumerate().for_each(|(i, (_, weight))| *weight -= step[m + i]);
            if step.rows(0, m).amax() <= SETTINGS.zero * size {
                break;
            }
        }
        let mut worst = 0.0f64;
        self.scan(
            (point, 1.0),
            |violation| if violation.is_nan() { f64::INFINITY } else { violation },
            0.0,
            &mut |_, violation| {
                worst = violation;
                violation
            },
        );
        let least = columns.iter().map(|(_, weight)| *weight).fold(f64::INFINITY, f64::min);
        if worst > SETTINGS.admissible || least < -SETTINGS.admissible || !worst.is_finite() {
            return Err(format!(
                "Newton's method on the stress blocks left a violation of {worst:.1e} and a multiplier of {least:.1e}"
            ));
        }
        Ok(())
    }

    fn joint_force(&self, forces: [f64; 3]) -> JointForce {
        JointForce { normal: [forces[0] * self.force, forces[1] * self.force], shear: forces[2] * self.force }
    }

    /// Returns the joint forces \[N\] at a point.
    pub fn forces(&self, point: &[f64]) -> Vec<JointForce> {
        (0..self.problem.joints.len()).map(|joint| self.joint_force(self.evaluate(joint, point, 1.0))).collect()
    }

    /// Returns the joint forces \[N\] along a direction, without the fixed loads.
    pub fn directions(&self, direction: &[f64]) -> Vec<JointForce> {
        (0..self.problem.joints.len()).map(|joint| self.joint_force(self.evaluate(joint, direction, 0.0))).collect()
    }

    /// Returns the velocities of the groups about the pole from the multipliers of the columns. Each yielding row moves
    /// its joint by −y times its normal; motions are added along the trees.
    pub fn motion(&self, problem: &LimitProblem, trees: &Trees, columns: &[(Column, f64)]) -> Vec<Velocity> {
        let mut rates = vec![[0.0; 3]; problem.joints.len()];
        for &(column, weight) in columns {
            if let Some((joint, weights)) = self.weights(column) {
                (0..3).for_each(|i| rates[joint][i] -= weight * weights[i]);
            }
        }
        let mut motion = vec![Vector3::zeros(); problem.groups];
        for link in &trees.links {
            let joint = &problem.joints[link.joint];
            let [open_0, open_1, slip] = rates[link.joint];
            let height = (joint.ends[1] - joint.ends[0]).norm();
            let rotation = (open_0 - open_1) / height;
            let lever = joint.ends[0] - problem.pole;
            let at_end: Vector2<f64> = joint.normal * open_0 + joint.tangent * slip;
            let twist = Vector3::new(at_end.x + rotation * lever.y, at_end.y - rotation * lever.x, rotation);
            let behind = link.behind.map_or(Vector3::zeros(), |group| motion[group]);
            motion[link.ahead] = behind + if joint.plus == Some(link.ahead) { twist } else { -twist };
        }
        motion.into_iter().map(Into::into).collect()
    }
}

/// Writes the rows of all joints in the form that pivots use.
#[inline(always)]
fn write_rows(known: usize, problem: &LimitProblem, forms: &Forms, force: f64, rows: &mut [f64]) {
    let mut rows = rows.chunks_exact_mut(known + 2);
    for (joint, forms) in problem.joints.iter().zip(forms.values.chunks_exact(3 * (known + 1))) {
        for (row, own) in joint.strength.rows.iter().zip(&mut rows) {
            let beta = add_weighted(known, forms, &row.normal, row.bound / force, own);
            (own[known], own[known + 1]) = (f64::from(u8::from(can_be_slack(row))), beta);
        }
    }
}

/// Returns false for a row that sets T to zero: it can have no slack.
fn can_be_slack(row: &ForceRow) -> bool {
    !(row.normal[0] == 0.0 && row.normal[1] == 0.0 && row.bound == 0.0)
}

/// Visits the tangents of a stress block that are nearest to the forces of its joint.
fn tangents(
    joint: usize,
    block: &StressBlock,
    forces: [f64; 3],
    constant: f64,
    slack: f64,
    visit: &mut impl FnMut(Column, f64),
) {
    let tension = constant * block.tension;
    let u = forces[0] + forces[1] + tension;
    for (end, normal) in forces.into_iter().take(2).enumerate() {
        let w = 2.0 * normal + tension;
        if constant == 0.0 {
            // The tangents at both ends of the parabola bound its recession cone.
            visit(Column::Tangent { joint, end, u: 0.0 }, slack - w);
            visit(Column::Tangent { joint, end, u: block.total }, slack + 2.0 * u - w);
        } else {
            let at = u.clamp(0.0, block.total);
            let violation = (2.0 * u - at) * at / block.total - w + slack;
            visit(Column::Tangent { joint, end, u: at }, violation);
        }
    }
}

/// Returns the column that leaves: least y/d over d > 0. Ties are decided by the lexicographic rule on the rows of the
/// basis' inverse times `origin`, which prevents cycles of degenerate pivots.
fn leaving(weights: &[f64], change: &[f64], lu: &mut SmallLu, origin: &[f64]) -> Option<usize> {
    let m = change.len();
    let largest = change.iter().fold(0.0f64, |m, x| m.max(x.abs()));
    let close = |x: f64, y: f64| (x - y).abs() <= SETTINGS.rounding * (1.0 + x.abs().max(y.abs()));
    // Columns of the rule computed so far: most pivots need none.
    let mut reference: Vec<f64> = Vec::new();
    let mut order = |a: usize, b: usize| {
        let (x, y) = (weights[a].max(0.0) / change[a], weights[b].max(0.0) / change[b]);
        if !close(x, y) {
            return x.total_cmp(&y);
        }
        for column in 0..m {
            if reference.len() == column * m {
                reference.extend_from_slice(&origin[column * m..(column + 1) * m]);
                lu.solve(&mut reference[column * m..]);
            }
            let (x, y) = (reference[column * m + a] / change[a], reference[column * m + b] / change[b]);
            if !close(x, y) {
                return x.total_cmp(&y);
            }
        }
        Ordering::Equal
    };
    (0..m).filter(|&k| change[k] > SETTINGS.admissible * largest.max(f64::MIN_POSITIVE)).min_by(|&a, &b| order(a, b))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Tangents nearest to forces on the parabola of an end touch it there; tangents of other forces lie outside it.
    #[test]
    fn tangents_touch_the_parabola() {
        let block = StressBlock { tension: 0.2, total: 10.2 };
        for pressed in [0.5, 3.0, 9.0] {
            let u = pressed + block.tension;
            let least = (u * u / block.total - block.tension) / 2.0;
            let mut seen = Vec::new();
            tangents(0, &block, [least, pressed - least, 0.0], 1.0, 0.0, &mut |_, violation| seen.push(violation));
            assert!(seen.len() == 2 && seen[0].abs() < 1e-13 && seen[1] < 1e-13, "{pressed}: {seen:?}");
        }
    }

    /// The column with the least ratio leaves; among equal ratios the first row of the inverse decides; no column
    /// leaves if no weight decreases.
    #[test]
    fn the_least_ratio_leaves() {
        let identity = [1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0];
        let mut lu = SmallLu::new(3);
        assert!(lu.factorise(&identity));
        assert_eq!(leaving(&[3.0, 1.0, 2.0], &[1.0, 1.0, 1.0], &mut lu, &identity), Some(1));
        assert_eq!(leaving(&[1.0, 1.0, 2.0], &[1.0, 1.0, 1.0], &mut lu, &identity), Some(1));
        assert_eq!(leaving(&[3.0, 1.0, 2.0], &[-1.0, 0.0, -1.0], &mut lu, &identity), None);
    }
}
