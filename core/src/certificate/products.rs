//! Proof that no limit state with the laws' own flow is below a factor, from products of statics with kinematics, and
//! its check. The check shares no code with the solver that found the proof.
//!
//! A state has forces r and a factor λ with slacks s_j = b_j − a_j·r ≥ 0 and equilibrium, a motion q̇ with multipliers
//! γ_i ≥ 0, jumps −Σ γ_i d_i and p·q̇ = 1, and γ_i s_i = 0. Every product of one of γ_i, p·q̇ with one of s_j, λ − a, t
//! − λ is therefore ≥ 0 in a range a ≤ λ ≤ t. The matrix Z of these products is U Y Vᵀ, where the columns of U span the
//! motions that the flow rule allows and the columns of V span the fields in equilibrium. Multipliers Λ ≥ 0 prove λ ≥ β
//! if
//!
//! ```text
//! Uᵀ (C − (β − a) N − Λ) V = 0        λ − a = Σ C_ij Z_ij,   1 = p·q̇ = Σ N_ij Z_ij
//! ```
//!
//! because then λ − β = Σ Λ_ij Z_ij, in which the products γ_i s_i are zero. This is linear duality of the first level
//! of Sherali & Adams, SIAM J. Discrete Math. 3 (1990). The rows "equilibrium times γ_i" and "flow rule times r_j" need
//! no multipliers here, because U and V represent them.
//!
//! **Rounding.** The remainder of the left-hand side is distributed over Λ by U (…) Vᵀ, so that the identity holds to
//! the last digits. Entries that become negative then cost their size times a product. No bound of this product holds
//! for every state (γ has no bound if mechanisms with p·q̇ = 0 exist). The check uses [`COVERED`] times the greatest γ
//! times the greatest s of the state that was found.

use crate::law::{Facet, YieldPolygon};
use crate::limit::{FIRST, LAST, ProductStep};
use crate::model::geometry::{Vec2, cross};
use crate::model::{Assembly, Bond, FillReaction, Joint, StageLoads, add_force};
use nalgebra::DMatrix;
use std::collections::BTreeMap;

/// Greatest products that are covered, relative to those of the state that was found.
pub const COVERED: f64 = 100.0;

/// Columns shorter than this share of the longest are zero columns.
const RANK: f64 = 1e-11;

/// One row of one joint over its forces (N_0, N_1, T).
struct Row {
    code: i64,
    first: usize,
    normal: [f64; 3],
    flow: [f64; 3],
    bound: f64,
}

/// The rows of all joints and the linear system between them.
struct Rows {
    rows: Vec<Row>,
    forces: usize,
    /// Wrench components by force variable, with two trailing columns for p and w; scaled.
    balance: DMatrix<f64>,
    unit: f64,
    force: f64,
}

/// Checks each step from `start` on; `state` is the greatest γ and s of a state at the factor `found`. Returns the
/// factor that is proved and the loss from rounding. An error gives the reason why nothing is proved.
pub fn proved(
    assembly: &Assembly,
    loads: &StageLoads,
    steps: &[ProductStep],
    [start, found]: [f64; 2],
    state: [f64; 2],
) -> Result<(f64, f64), String> {
    let rows = Rows::new(assembly, loads)?;
    let motions = rows.motions();
    let (mut proved, mut rounding) = (start, 0.0);
    for step in steps {
        let [a, t] = step.range;
        let ordered = a.is_finite() && t.is_finite() && a < t && a <= proved && t >= found && step.bound <= t;
        if !ordered {
            return Err(format!("no range [{a}, {t}] follows on {proved}"));
        }
        let shortfall = rows.shortfall(&motions, step, state)?;
        proved = proved.max(step.bound - shortfall);
        rounding += shortfall;
    }
    Ok((proved, rounding))
}

/// Groups of bodies with the poles of their moments.
struct Groups<'a> {
    assembly: &'a Assembly,
    of_body: Vec<Option<usize>>,
    poles: Vec<Vec2>,
    size: f64,
}

impl<'a> Groups<'a> {
    fn new(assembly: &'a Assembly) -> Self {
        let (of_body, count) = assembly.rigid_groups();
        let mut poles: Vec<Option<Vec2>> = vec![None; count];
        for (body, group) in of_body.iter().enumerate() {
            if let Some(group) = group {
                poles[*group].get_or_insert_with(|| assembly.inertia(body).centroid);
            }
        }
        let poles = poles.into_iter().map(Option::unwrap_or_default).collect();
        Groups { assembly, of_body, poles, size: assembly.size() }
    }

    /// Returns the resultants of loads on each group about its pole; moments are divided by the size of the scene.
    fn gather(&self, wrenches: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let mut sums = vec![[0.0f64; 3]; self.poles.len()];
        for (group, [x, y, moment]) in self.of_body.iter().zip(wrenches) {
            if let Some(group) = *group {
                let about = moment - cross(self.poles[group], Vec2::new(*x, *y));
                for (sum, part) in sums[group].iter_mut().zip([*x, *y, about / self.size]) {
                    *sum += part;
                }
            }
        }
        sums
    }

    /// Returns the columns of N_0, N_1 and T of a joint.
    fn columns(&self, joint: &Joint) -> [Vec<f64>; 3] {
        let (n, t) = joint.frame();
        [(joint.ends[0], n), (joint.ends[1], n), (joint.ends[0], t)].map(|(at, direction)| {
            let mut column = vec![0.0; 3 * self.poles.len()];
            for (body, sign) in [(joint.plus, 1.0), (joint.minus, -1.0)] {
                let Some(group) = self.of_body[body] else { continue };
                let moment = cross(at - self.poles[group], direction) / self.size;
                for (x, part) in [direction.x, direction.y, moment].into_iter().enumerate() {
                    column[3 * group + x] += sign * part;
                }
            }
            column
        })
    }

    /// Returns the column of a unit force of the fill. `None` if the ground holds the body.
    fn fill_column(&self, reaction: &FillReaction) -> Option<Vec<f64>> {
        let group = self.of_body[reaction.body]?;
        let mut column = vec![0.0; 3 * self.poles.len()];
        let moment = cross(reaction.point - self.poles[group], reaction.direction) / self.size;
        column[3 * group..3 * group + 3].copy_from_slice(&[reaction.direction.x, reaction.direction.y, moment]);
        Some(column)
    }

    /// Returns the rows of a joint's law over (N_0, N_1, T), and true if T is a variable: without friction T = 0 and
    /// slip is free.
    fn rows(&self, index: usize, first: usize) -> Result<(Vec<Row>, bool), String> {
        let joint = &self.assembly.joints[index];
        let facets = self.assembly.law(joint).and_then(|law| law.facets()).unwrap_or_default();
        let polygon = YieldPolygon::of(&facets);
        if polygon.greatest_normal().is_finite() || polygon.least_normal() == f64::NEG_INFINITY {
            return Err("joints that crush, or never open, have no linear rows".into());
        }
        let area = joint.height() * self.assembly.width;
        let row = |normal, flow, bound, slot: i64| Row { code: 4 * index as i64 + slot, first, normal, flow, bound };
        let tension = -polygon.least_normal() * area / 2.0;
        let mut own = vec![
            row([-1.0, 0.0, 0.0], [-1.0, 0.0, 0.0], tension, 0),
            row([0.0, -1.0, 0.0], [0.0, -1.0, 0.0], tension, 1),
        ];
        let sliding: Vec<&Facet> = facets.iter().filter(|f| f.normal[1] != 0.0).collect();
        if !sliding.is_empty() && sliding.iter().all(|f| f.normal[0] == 0.0 && f.bound == 0.0) {
            return Ok((own, false));
        }
        for (sense, slot) in [(1.0, 2), (-1.0, 3)] {
            let over = |v: [f64; 2]| [v[0], v[0], v[1]];
            match sliding.iter().filter(|f| f.normal[1] * sense > 0.0).collect::<Vec<_>>()[..] {
                [] => {}
                [f] => own.push(row(over(f.normal), over(f.flow), f.bound * area, slot)),
                _ => return Err("several facets bound sliding in one sense".into()),
            }
        }
        Ok((own, true))
    }
}

impl Rows {
    fn new(assembly: &Assembly, loads: &StageLoads) -> Result<Self, String> {
        let groups = Groups::new(assembly);
        // The least force of the fill is a fixed load; the force above it is a variable.
        let mut fixed = loads.fixed.clone();
        for (reaction, [least, _]) in assembly.fill_reactions().iter().zip(&loads.fill_bounds) {
            add_force(&mut fixed[reaction.body], reaction.point, reaction.direction, *least);
        }
        let (fixed, varying) = (groups.gather(&fixed), groups.gather(&loads.varying));
        let sum = |w: &[[f64; 3]]| w.iter().flatten().map(|x| x.abs()).sum::<f64>();
        let (dead, live) = (sum(&fixed), sum(&varying));
        if live == 0.0 {
            return Err("no load varies".into());
        }
        let force = if dead > 0.0 { dead } else { live };
        let unit = force / live;
        let (mut rows, mut forces, mut columns) = (Vec::new(), 0, Vec::new());
        for (index, joint) in assembly.joints.iter().enumerate() {
            if joint.bond == Bond::Bonded || groups.of_body[joint.minus] == groups.of_body[joint.plus] {
                continue;
            }
            let (own, shear) = groups.rows(index, forces)?;
            let width = if shear { 3 } else { 2 };
            rows.extend(own.into_iter().map(|row| Row { bound: row.bound / force, ..row }));
            columns.extend(groups.columns(joint).into_iter().take(width));
            forces += width;
        }
        for (index, (reaction, [least, greatest])) in
            assembly.fill_reactions().iter().zip(&loads.fill_bounds).enumerate()
        {
            let Some(column) = groups.fill_column(reaction).filter(|_| greatest > least) else { continue };
            let code = 4 * (assembly.joints.len() + index) as i64;
            let row = |sign: f64, bound: f64, slot: i64| {
                let normal = [sign, 0.0, 0.0];
                Row { code: code + slot, first: forces, normal, flow: normal, bound: bound / force }
            };
            rows.extend([row(-1.0, 0.0, 0), row(1.0, greatest - least, 1)]);
            columns.push(column);
            forces += 1;
        }
        let scaled = |w: &[[f64; 3]], by: f64| w.iter().flatten().map(|x| x * by).collect::<Vec<f64>>();
        columns.push(scaled(&varying, unit / force));
        columns.push(scaled(&fixed, 1.0 / force));
        let balance = DMatrix::from_fn(3 * groups.poles.len(), forces + 2, |i, j| columns[j][i]);
        Ok(Rows { rows, forces, balance, unit, force })
    }

    /// Returns U: every γ_i and p·q̇ of the motions that the flow rule allows.
    fn motions(&self) -> DMatrix<f64> {
        let (groups, count) = (self.balance.nrows(), self.rows.len());
        let mut flow = DMatrix::zeros(self.forces, groups + count);
        flow.view_mut((0, 0), (self.forces, groups)).tr_copy_from(&self.balance.columns(0, self.forces).into_owned());
        for (i, row) in self.rows.iter().enumerate() {
            for (k, d) in row.flow.iter().enumerate().filter(|(_, d)| **d != 0.0) {
                flow[(row.first + k, groups + i)] += d;
            }
        }
        let free = null_space(&flow);
        let power = self.balance.column(self.forces).transpose() * free.rows(0, groups);
        let mut all = free.rows(groups, count).into_owned().insert_row(count, 0.0);
        all.row_mut(count).copy_from(&power);
        orthonormal(all)
    }

    /// Returns V: every s_j, λ − a and t − λ of the fields in equilibrium.
    fn fields(&self, [a, t]: [f64; 2]) -> DMatrix<f64> {
        let free = null_space(&self.balance);
        let one = free.row(self.forces + 1).into_owned();
        let theta = free.row(self.forces).into_owned();
        let count = self.rows.len();
        let mut all = DMatrix::zeros(count + 2, free.ncols());
        for (j, row) in self.rows.iter().enumerate() {
            let mut slack = &one * row.bound;
            for (k, normal) in row.normal.iter().enumerate().filter(|(_, a)| **a != 0.0) {
                slack -= free.row(row.first + k) * *normal;
            }
            all.row_mut(j).copy_from(&slack);
        }
        all.row_mut(count).copy_from(&(&theta - &one * (a / self.unit)));
        all.row_mut(count + 1).copy_from(&(&one * (t / self.unit) - &theta));
        orthonormal(all)
    }

    /// Returns the difference between the bound of a step and the factor that it proves.
    fn shortfall(&self, motions: &DMatrix<f64>, step: &ProductStep, state: [f64; 2]) -> Result<f64, String> {
        let count = self.rows.len();
        let [a, t] = step.range;
        let fields = self.fields(step.range);
        let of: BTreeMap<i64, usize> = self.rows.iter().enumerate().map(|(i, row)| (row.code, i)).collect();
        let first = |code: i64| if code == FIRST { Some(count) } else { of.get(&code).copied() };
        let second = |code: i64| if code == LAST { Some(count + 1) } else { first(code) };
        let (unit, force) = (self.unit, self.force);
        // Scaled to order one: γ F/Λ, s/F and λ/Λ.
        let scale = |i: usize, j: usize| match (i < count, j < count) {
            (true, true) | (false, false) => 1.0,
            (true, false) => unit / force,
            (false, true) => force / unit,
        };
        let mut multipliers = DMatrix::zeros(count + 1, count + 2);
        for (i, row) in &step.multipliers {
            for (j, value) in row {
                let (Some(i), Some(j)) = (first(*i), second(*j)) else {
                    return Err(format!("no product of {i} with {j}"));
                };
                if !value.is_finite() || (*value < 0.0 && i != j) {
                    return Err(format!("the multiplier {value} of a product is not ≥ 0"));
                }
                multipliers[(i, j)] += value * scale(i, j);
            }
        }
        let mut left = -&multipliers;
        let share = (step.bound - a) / (t - a);
        left[(count, count)] += 1.0 - share;
        left[(count, count + 1)] -= share;
        let residual = motions.transpose() * left * &fields;
        multipliers += motions * residual * fields.transpose();
        let [gamma, slack] = [state[0] * force / unit, state[1] / force];
        let mut shortfall = 0.0;
        for j in 0..count + 2 {
            for i in (0..=count).filter(|&i| i != j || i == count) {
                let product = match (i < count, j < count) {
                    (true, true) => COVERED * gamma * slack,
                    (true, false) => COVERED * gamma * (t - a) / unit,
                    (false, true) => COVERED * slack,
                    (false, false) => (t - a) / unit,
                };
                let missing = -multipliers[(i, j)];
                // `max` would treat NaN as 0.
                shortfall += if missing.is_nan() { f64::NAN } else { missing.max(0.0) * product * unit };
            }
        }
        if shortfall.is_finite() { Ok(shortfall) } else { Err("the multipliers overflow".into()) }
    }
}

/// Returns orthonormal columns with the same span, longest first, each orthogonalised twice.
fn orthonormal(mut columns: DMatrix<f64>) -> DMatrix<f64> {
    let (rows, count) = columns.shape();
    let length = |columns: &DMatrix<f64>, j: usize| columns.column(j).norm();
    let longest = (0..count).map(|j| length(&columns, j)).fold(0.0, f64::max);
    let mut basis = DMatrix::zeros(rows, rows.min(count));
    let mut found = 0;
    while found < basis.ncols() {
        let best = (0..count).map(|j| (length(&columns, j), j)).fold((0.0, 0), |m, x| if x.0 > m.0 { x } else { m });
        if best.0 <= RANK * longest {
            break;
        }
        let mut next = columns.column(best.1) / best.0;
        for _ in 0..2 {
            let known = basis.columns(0, found);
            next -= known * (known.transpose() * &next);
        }
        next /= next.norm();
        let along = next.transpose() * &columns;
        columns.ger(-1.0, &next, &along.transpose(), 1.0);
        basis.column_mut(found).copy_from(&next);
        found += 1;
    }
    basis.columns(0, found).into_owned()
}

/// Returns orthonormal columns that span the solutions of matrix · x = 0.
fn null_space(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let rows = orthonormal(matrix.transpose());
    let rest = DMatrix::identity(matrix.ncols(), matrix.ncols()) - &rows * rows.transpose();
    let free = matrix.ncols() - rows.ncols();
    orthonormal(rest).columns(0, free).into_owned()
}
