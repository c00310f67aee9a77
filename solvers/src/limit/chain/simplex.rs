//! The simplex method on elementary mechanisms: min β·y with Σ y_i a_i = c, y ≥ 0, columns priced
//! joint by joint, stress blocks by their tangents.

use super::layout::{Forms, Trees};
use nalgebra::{DMatrix, DVector, Vector2, Vector3};
use std::cmp::Ordering;
use voussoir_core::law::StressBlock;
use voussoir_core::limit::{JointForce, LimitProblem, Velocity};

/// Violation of a linear row that counts, in units of the force scale.
const ROW_TOLERANCE: f64 = 1e-13;
/// Violations of stress blocks at which Newton's method is tried, in turn; after the last one the
/// tangents themselves are the answer.
const BLOCK_TOLERANCES: [f64; 4] = [1e-8, 1e-10, 1e-12, 1e-13];
/// Slack below which a row counts as active.
const ACTIVE_TOLERANCE: f64 = 1e-11;
const MAX_PIVOTS: u64 = 5000;

/// Which elementary mechanism a column is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Column {
    /// A linear row of a joint's strength.
    Row { joint: usize, row: usize },
    /// The tangent at `u` of a joint's stress block, bounding the force at one end.
    Tangent { joint: usize, end: usize, u: f64 },
    /// The upper bound of the objective.
    Cap,
    /// No mechanism: ± a unit vector, for the start.
    Artificial { variable: usize },
}

/// A linear program over the affine joint forces.
pub struct Program<'a> {
    problem: &'a LimitProblem,
    forms: &'a Forms,
    force: f64,
    margin: bool,
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
    /// No point satisfies all rows: columns with Σ y_i a_i = 0 and β·y < 0, y ≥ 0, a motion that refutes
    /// equilibrium.
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
    matrix: DMatrix<f64>,
    /// Where the lexicographic rule starts from.
    origin: DMatrix<f64>,
}

enum Ending {
    Optimal {
        point: DVector<f64>,
        weights: DVector<f64>,
    },
    /// A column that enters for ever, with its weight and those of the basis that go with it.
    NoLeaving(Vec<(Column, f64)>),
    Stuck(String),
}

impl<'a> Program<'a> {
    /// Maximises the last factor of `forms`.
    pub fn new(problem: &'a LimitProblem, forms: &'a Forms, force: f64) -> Self {
        Program { problem, forms, force, margin: false, cap: f64::INFINITY, variables: forms.variables }
    }

    /// Maximises the least slack of all rows instead, up to 1.
    pub fn with_margin(mut self) -> Self {
        self.margin = true;
        self.cap = 1.0;
        self.variables += 1;
        self
    }

    /// With an upper bound of the objective.
    pub fn with_cap(mut self, cap: f64) -> Self {
        self.cap = cap;
        self
    }

    fn form(&self, joint: usize, i: usize) -> &[f64] {
        let length = self.forms.variables + 1;
        let first = (3 * joint + i) * length;
        &self.forms.values[first..first + length]
    }

    /// (N_0, N_1, T) at a point, in units of the force scale; `constant` 0 drops the fixed loads.
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

    /// Coefficients of a column over (N_0, N_1, T); none for cap and artificials.
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

    /// A row that pins T to zero can have no slack.
    fn has_margin(&self, column: Column) -> bool {
        match column {
            Column::Row { joint, row } => {
                let row = &self.problem.joints[joint].strength.rows[row];
                self.margin && !(row.normal[0] == 0.0 && row.normal[1] == 0.0 && row.bound == 0.0)
            }
            _ => self.margin,
        }
    }

    /// a and β of a column.
    fn column(&self, column: Column) -> (DVector<f64>, f64) {
        let mut a = DVector::zeros(self.variables);
        let Some((joint, weights)) = self.weights(column) else {
            return match column {
                Column::Artificial { variable } => {
                    a[variable] = 1.0;
                    (a, 0.0)
                }
                _ => {
                    a[self.variables - 1] = 1.0;
                    (a, self.cap)
                }
            };
        };
        let mut beta = match column {
            Column::Row { joint, row } => self.problem.joints[joint].strength.rows[row].bound / self.force,
            Column::Tangent { joint, u, .. } => {
                let block = self.block(joint).expect("tangents belong to stress blocks");
                u * u / block.total - 2.0 * u / block.total * block.tension + block.tension
            }
            _ => unreachable!("cap and artificials have no weights"),
        };
        for (i, weight) in weights.into_iter().enumerate().filter(|(_, w)| *w != 0.0) {
            let form = self.form(joint, i);
            for k in 0..self.forms.variables {
                a[k] += weight * form[k];
            }
            beta -= weight * form[self.forms.variables];
        }
        if self.has_margin(column) {
            a[self.variables - 1] = 1.0;
        }
        (a, beta)
    }

    /// Calls `visit` with every column that is near or beyond its bound at `point`, and its
    /// violation; in the recession cone where `constant` is 0.
    fn scan(&self, point: &[f64], constant: f64, mut visit: impl FnMut(Column, f64)) {
        let slack = self.slack_variable(point);
        for joint in 0..self.problem.joints.len() {
            let forces = self.evaluate(joint, point, constant);
            let strength = &self.problem.joints[joint].strength;
            for (row, r) in strength.rows.iter().enumerate() {
                let column = Column::Row { joint, row };
                let s = if self.margin && self.has_margin(column) { slack } else { 0.0 };
                let carried = r.normal[0] * forces[0] + r.normal[1] * forces[1] + r.normal[2] * forces[2];
                visit(column, carried + s - constant * r.bound / self.force);
            }
            let Some(block) = self.block(joint) else {
                continue;
            };
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
        if self.cap.is_finite() {
            visit(Column::Cap, point[self.variables - 1] - constant * self.cap);
        }
    }

    /// The column violated most.
    fn entering(&self, point: &[f64], constant: f64, block_tolerance: f64, basis: &[Column]) -> Option<(Column, f64)> {
        let mut worst: Option<(Column, f64)> = None;
        let size = point.iter().fold(1.0f64, |m, x| m.max(x.abs()));
        self.scan(point, constant, |column, violation| {
            let tolerance = match column {
                Column::Tangent { .. } if constant != 0.0 => block_tolerance,
                _ => ROW_TOLERANCE,
            };
            if violation > tolerance * size && worst.is_none_or(|(_, w)| violation > w) && !basis.contains(&column) {
                worst = Some((column, violation));
            }
        });
        worst
    }

    /// Rows active at a point.
    pub fn active(&self, point: &[f64]) -> Vec<Column> {
        let size = point.iter().fold(1.0f64, |m, x| m.max(x.abs()));
        let mut active = Vec::new();
        self.scan(point, 1.0, |column, violation| {
            if violation > -ACTIVE_TOLERANCE * size {
                active.push(column);
            }
        });
        active
    }

    /// The vector a of a column.
    pub fn gradient(&self, column: Column) -> DVector<f64> {
        self.column(column).0
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
        let mut basis = Basis { columns, matrix: DMatrix::identity(m, m), origin: DMatrix::identity(m, m) };
        if !self.cap.is_finite() {
            match self.iterate(&mut basis, true, ROW_TOLERANCE, &mut work) {
                Ending::Optimal { point, .. } if point[m - 1] > 1e-9 => {
                    return (Outcome::Unbounded((point.clone() / point[m - 1]).as_slice().to_vec()), work);
                }
                Ending::Optimal { .. } => {}
                Ending::NoLeaving(_) => {
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
                Ending::NoLeaving(refutation) => Outcome::Infeasible(refutation),
                Ending::Stuck(why) => Outcome::Failed(why),
            };
            if !matches!(outcome, Outcome::Failed(_)) {
                break;
            }
        }
        (outcome, work)
    }

    /// Costs of the basis: in phase one 1 for artificials of the objective, else β.
    fn costs(&self, basis: &Basis, phase_one: bool) -> DVector<f64> {
        DVector::from_iterator(
            self.variables,
            basis.columns.iter().map(|&column| match (phase_one, column) {
                (true, Column::Artificial { .. }) => 1.0,
                (true, _) => 0.0,
                (false, _) => self.column(column).1,
            }),
        )
    }

    fn iterate(&self, basis: &mut Basis, phase_one: bool, block_tolerance: f64, work: &mut Work) -> Ending {
        let m = self.variables;
        let mut objective = DVector::zeros(m);
        objective[m - 1] = 1.0;
        let constant = if phase_one { 0.0 } else { 1.0 };
        basis.origin = basis.matrix.clone();
        for _ in 0..MAX_PIVOTS {
            let lu = basis.matrix.clone().lu();
            let transposed = basis.matrix.transpose().lu();
            let costs = self.costs(basis, phase_one);
            let (Some(weights), Some(mut point)) = (lu.solve(&objective), transposed.solve(&costs)) else {
                return Ending::Stuck("the simplex basis became singular".into());
            };
            // One step of refinement: λ is read off this point.
            if let Some(step) = transposed.solve(&(&costs - basis.matrix.transpose() * &point)) {
                point += step;
            }
            let Some((column, _)) = self.entering(point.as_slice(), constant, block_tolerance, &basis.columns) else {
                return Ending::Optimal { point, weights };
            };
            let a = self.gradient(column);
            let Some(change) = lu.solve(&a) else {
                return Ending::Stuck("the simplex basis became singular".into());
            };
            let reference = lu.solve(&basis.origin).unwrap_or_else(|| DMatrix::identity(m, m));
            let Some(leaving) = leaving(&weights, &change, &reference) else {
                let steady =
                    basis.columns.iter().zip(change.iter()).map(|(&column, change)| (column, (-change).max(0.0)));
                let moving = steady.chain([(column, 1.0)]).filter(|(_, weight)| *weight > 0.0);
                return Ending::NoLeaving(moving.collect());
            };
            basis.columns[leaving] = column;
            basis.matrix.set_column(leaving, &a);
            work.pivots += 1;
        }
        Ending::Stuck(format!("no optimum after {MAX_PIVOTS} pivots"))
    }

    /// Replaces artificials, which stand at zero, by real columns wherever some column can.
    fn drive_out(&self, basis: &mut Basis) {
        let m = self.variables;
        for place in 0..m {
            if !matches!(basis.columns[place], Column::Artificial { .. }) {
                continue;
            }
            let mut unit = DVector::zeros(m);
            unit[place] = 1.0;
            let Some(row) = basis.matrix.transpose().lu().solve(&unit) else {
                continue;
            };
            let mut best: (f64, Option<Column>) = (1e-9, None);
            let origin = vec![0.0; m];
            self.scan(&origin, 0.0, |column, _| {
                let size = row.dot(&self.gradient(column)).abs();
                if size > best.0 && !basis.columns.contains(&column) {
                    best = (size, Some(column));
                }
            });
            if let Some(column) = best.1 {
                basis.columns[place] = column;
                basis.matrix.set_column(place, &self.gradient(column));
            }
        }
    }

    /// Turns the last basis into an answer; where stress blocks are active, Newton's method on them.
    /// `last`: the tangents are near enough to stand for their blocks where Newton's method fails.
    fn finish(
        &self,
        basis: &Basis,
        point: DVector<f64>,
        weights: DVector<f64>,
        last: bool,
        work: &mut Work,
    ) -> Outcome {
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
        let mut point = point.as_slice().to_vec();
        if merged.iter().any(|(column, _)| matches!(column, Column::Tangent { .. })) {
            // Rows that stand at zero may be active by chance; with too few the system is singular.
            let mut failed = String::new();
            let found = [1e-10, f64::NEG_INFINITY].iter().find_map(|&least| {
                let mut trial: Vec<_> = merged.iter().copied().filter(|(_, weight)| *weight > least).collect();
                let mut moved = point.clone();
                match self.newton(&mut moved, &mut trial, work) {
                    Ok(()) => Some((moved, trial)),
                    Err(why) => {
                        failed = why;
                        None
                    }
                }
            });
            match found {
                Some((moved, trial)) => (point, merged) = (moved, trial),
                None if last => {}
                None => return Outcome::Failed(failed),
            }
        }
        let capped = merged.iter().any(|&(column, weight)| column == Column::Cap && weight > 1e-9);
        merged.retain(|&(column, weight)| column != Column::Cap && weight > 1e-14);
        Outcome::Optimal(Solved { value: point[self.variables - 1], point, columns: merged, capped })
    }

    /// Stationarity Σ y_i ∇c_i(v) = c with c_i(v) = 0 for the columns given.
    fn newton(&self, point: &mut [f64], columns: &mut [(Column, f64)], work: &mut Work) -> Result<(), String> {
        let (m, k) = (self.variables, columns.len());
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
                let (a, beta) = self.column(*column);
                for i in 0..m {
                    kkt[(i, m + place)] = a[i];
                    kkt[(m + place, i)] = a[i];
                    residual[i] += *weight * a[i];
                }
                residual[m + place] = a.iter().zip(point.iter()).map(|(a, x)| a * x).sum::<f64>() - beta;
            }
            let size = point.iter().fold(1.0f64, |s, x| s.max(x.abs()));
            if residual.amax() <= 4e-15 * size {
                break;
            }
            let Some(step) = kkt.lu().solve(&residual) else {
                return Err("Newton's method on the stress blocks met a singular system".into());
            };
            (0..m).for_each(|i| point[i] -= step[i]);
            columns.iter_mut().enumerate().for_each(|(i, (_, weight))| *weight -= step[m + i]);
            if step.rows(0, m).amax() <= 1e-15 * size {
                break;
            }
        }
        let mut worst = 0.0f64;
        self.scan(point, 1.0, |_, violation| worst = worst.max(violation));
        let least = columns.iter().map(|(_, weight)| *weight).fold(f64::INFINITY, f64::min);
        if worst > 1e-11 || least < -1e-11 || !worst.is_finite() {
            return Err(format!(
                "Newton's method on the stress blocks left a violation of {worst:.1e} and a multiplier of {least:.1e}"
            ));
        }
        Ok(())
    }

    fn joint_force(&self, forces: [f64; 3]) -> JointForce {
        JointForce { normal: [forces[0] * self.force, forces[1] * self.force], shear: forces[2] * self.force }
    }

    /// Joint forces \[N\] at a point.
    pub fn forces(&self, point: &[f64]) -> Vec<JointForce> {
        (0..self.problem.joints.len()).map(|joint| self.joint_force(self.evaluate(joint, point, 1.0))).collect()
    }

    /// Joint forces \[N\] along a direction, without the fixed loads.
    pub fn directions(&self, direction: &[f64]) -> Vec<JointForce> {
        (0..self.problem.joints.len()).map(|joint| self.joint_force(self.evaluate(joint, direction, 0.0))).collect()
    }

    /// Velocities of the groups about the pole from the multipliers of the columns: each yielding
    /// row moves its joint by −y times its normal; motions add up along the trees.
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

/// The place that leaves: least y/d over d > 0, ties by the lexicographic rule on the rows of
/// `reference`, which keeps degenerate pivots from cycling.
fn leaving(weights: &DVector<f64>, change: &DVector<f64>, reference: &DMatrix<f64>) -> Option<usize> {
    let largest = change.amax();
    let candidates = (0..change.len()).filter(|&k| change[k] > 1e-11 * largest.max(1e-300));
    candidates.min_by(|&a, &b| {
        let ratio = |k: usize, value: f64| value / change[k];
        let close = |x: f64, y: f64| (x - y).abs() <= 1e-13 * (1.0 + x.abs().max(y.abs()));
        let (x, y) = (ratio(a, weights[a].max(0.0)), ratio(b, weights[b].max(0.0)));
        if !close(x, y) {
            return x.total_cmp(&y);
        }
        for column in 0..reference.ncols() {
            let (x, y) = (ratio(a, reference[(a, column)]), ratio(b, reference[(b, column)]));
            if !close(x, y) {
                return x.total_cmp(&y);
            }
        }
        Ordering::Equal
    })
}
