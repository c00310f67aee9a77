//! The linear system of a step: residual by regimes, rows of constraints, the matrix and its solution.
//!
//! CsrMatrix by regime:
//!
//! ```text
//! stuck     g − s = 0                     facet   a·r = b A,  Δg × d = 0
//! corner    r = corner A                  body    ∂Π/∂q = 0          control  c(increment) = length
//! response  r − A t(g) = 0 (see `response`)
//! ```
//!
//! The matrix that is factorised is shifted by ε: compliance ε C̄ in every contact, stiffness ε / C̄
//! in every body and in every yielding contact. That makes it quasi-definite (Vanderbei 1995, SIAM J.
//! Optim. 5) where regimes repeat a condition or leave a motion free; iterative refinement against
//! the true matrix removes the shift from the answer. Where refinement does not converge, the
//! regimes have no solution, and the step is refused. How it is factorised: see `border` and
//! [`condensed`](crate::linear::condensed).

use super::kinematics::{Curvature, Slopes};
use super::model::{Control, Model, Rate, State, load_size};
use crate::contact::mode::ContactMode as Regime;
use crate::linear::bordered::{BorderedFactors, BorderedSystem};
use crate::linear::csr::CsrMatrix;
use std::rc::Rc;
use voussoir_core::linear::Analysis;
use voussoir_core::model::geometry::turned;
use voussoir_core::path::{Constraint, Increment};

/// Backward error of every row that is rounding.
const ROUNDING: f64 = 4.0 * f64::EPSILON;

/// The shift of the factorised matrix.
pub(super) const SHIFT: f64 = 1e-9;

/// Factors with what they are of.
struct Kept {
    regimes: Vec<Regime>,
    /// Normals and flows of the laws' facets.
    directions: Vec<[f64; 4]>,
    held: Rc<BorderedFactors>,
}

/// What the last factorisation leaves to the next.
#[derive(Default)]
pub(super) struct SparseLdlt {
    /// The last ones, where nothing but regimes and laws makes the matrix.
    last: Option<Kept>,
    analysis: Analysis,
}

impl SparseLdlt {
    /// Another load grows.
    pub fn forget(&mut self) {
        self.last = None;
    }
}

impl Model<'_> {
    /// The row of a control over the scaled unknowns, at a state: the gradient of its constraint.
    pub(super) fn control_row(
        &self,
        start: &State,
        state: &State,
        control: &Control,
        constraint: &Constraint,
        curvature: &Curvature,
    ) -> Vec<f64> {
        let u = self.units;
        let (points, size) = (state.gap.len(), self.size());
        let last = size - 1;
        let mut row = vec![0.0; size];
        let by = constraint.derivative;
        row[last] += by.factor;
        let mut by_gap = vec![0.0; 2 * points];
        if by.motion != 0.0 {
            let value = self.increment(start, state).motion.max(1e-300);
            for body in 0..self.free.len() {
                let Some(free) = self.free[body] else { continue };
                for k in 0..3 {
                    let unit = if k == 2 { u.displacement / u.length } else { u.displacement };
                    let delta = (state.motion[body][k] - start.motion[body][k]) / unit;
                    row[2 * points + 3 * free + k] += by.motion * delta / (value * self.bodies_free as f64);
                }
            }
            for c in 0..points {
                for k in 0..2 {
                    let delta = (state.gap[c][k] - start.gap[c][k]) / u.displacement;
                    by_gap[2 * c + k] += by.motion * delta / (value * points as f64 * u.displacement);
                }
            }
        }
        if by.dissipation != 0.0 {
            let energy = u.force * u.displacement;
            let slopes = self.dissipation_slopes(start, state);
            by_gap.iter_mut().zip(slopes).for_each(|(w, slope)| *w += by.dissipation * slope / energy);
            for c in 0..points {
                let Some(law) = self.law(c) else { continue };
                let (kept, _) = law.irreversible(state.regime[c], self.step_gap(start, state, c));
                if kept != [0.0; 2] {
                    for k in 0..2 {
                        row[2 * c + k] -= by.dissipation * kept[k] * u.force / energy;
                        by_gap[2 * c + k] -= by.dissipation * state.force[c][k] / energy;
                    }
                }
            }
            self.add_plastic_work(&mut row, state, by.dissipation / energy);
        }
        if by.displacement != 0.0 {
            let loading = self.loaded.growing;
            let scale = by.displacement / load_size(self.problem, loading).max(1e-300);
            let mut wrench = vec![[0.0; 3]; self.free.len()];
            for (body, _, point, f) in &loading.forces {
                let arm = point - self.problem.bodies[*body].pole;
                let theta = if self.finite() { state.motion[*body][2] } else { 0.0 };
                let arm = nalgebra::Rotation2::new(theta) * arm;
                wrench[*body][0] += f.x;
                wrench[*body][1] += f.y;
                wrench[*body][2] += f.dot(&turned(arm));
            }
            for (body, b) in self.problem.bodies.iter().enumerate() {
                let Some(free) = self.free[body] else { continue };
                wrench[body][0] += b.mass * loading.acceleration.x;
                wrench[body][1] += b.mass * loading.acceleration.y;
                for k in 0..3 {
                    let unit = if k == 2 { 1.0 / u.length } else { 1.0 };
                    row[2 * points + 3 * free + k] += scale * wrench[body][k] * unit;
                }
            }
        }
        if let Control::Gaps { local, .. } = control {
            by_gap.iter_mut().zip(&local.by_gap).for_each(|(w, local)| *w += local);
        }
        self.add_gaps(&mut row, &by_gap, curvature);
        if matches!(control, Control::Spring { .. }) {
            for (i, value) in self.works(curvature) {
                if let Some((column, own)) = self.column(i) {
                    row[column] += value * own;
                }
            }
        }
        row
    }

    /// Adds weighted gaps to a row over the scaled unknowns.
    pub(super) fn add_gaps(&self, row: &mut [f64], by_gap: &[f64], curvature: &Curvature) {
        if by_gap.iter().all(|w| *w == 0.0) {
            return;
        }
        let rows = &curvature.rows(self).gaps;
        for (i, weight) in by_gap.iter().enumerate().filter(|(_, w)| **w != 0.0) {
            let by = weight * self.units.displacement;
            rows.row(i).iter().for_each(|&(j, value)| row[j] += by * value);
        }
    }

    pub(super) fn constraint(&self, start: &State, state: &State, control: &Control) -> (f64, Constraint) {
        match control {
            Control::Factor(target) => {
                let derivative = Increment { factor: 1.0, ..Increment::default() };
                ((state.factor - target) / self.units.factor, Constraint { value: 0.0, derivative })
            }
            Control::Strategy { strategy, previous, length } => {
                let c = strategy.constraint(&self.increment(start, state), previous.as_ref());
                (c.value - length, c)
            }
            Control::Gaps { local, length } => (local.value(start, state) - length, Constraint::default()),
            Control::Spring { weight, length } => {
                let derivative = Increment { factor: *weight, ..Increment::default() };
                let value =
                    weight * (state.factor - start.factor) / self.units.factor + self.work_between(start, state);
                (value - length, Constraint { value, derivative })
            }
        }
    }

    /// Derivatives of ∂Π/∂λ in units by force and motion, where they are not zero: global index and value.
    fn works<'m>(&self, curvature: &'m Curvature) -> impl Iterator<Item = (usize, f64)> + use<'m> {
        let unit = self.units.factor / (self.units.force * self.units.displacement);
        curvature.factor.iter().enumerate().filter(|(_, v)| **v != 0.0).map(move |(i, value)| (i, unit * value))
    }

    /// ∂Π/∂λ of differences of forces and motions, in units: p·Δq + g_p·Δr (small displacements).
    fn work_of(&self, force: impl Fn(usize, usize) -> f64, motion: impl Fn(usize, usize) -> f64) -> f64 {
        let Some(curvature) = &self.constant else { return 0.0 };
        let forces = 2 * self.problem.contacts.len();
        let by = |i: usize| match i.checked_sub(forces) {
            None => force(i / 2, i % 2),
            Some(k) if self.free[k / 3].is_some() => motion(k / 3, k % 3),
            Some(_) => 0.0,
        };
        self.works(curvature).map(|(i, value)| value * by(i)).sum()
    }

    /// ∂Π/∂λ between two states, in units.
    fn work_between(&self, start: &State, state: &State) -> f64 {
        self.work_of(|c, k| state.force[c][k] - start.force[c][k], |b, k| state.motion[b][k] - start.motion[b][k])
    }

    /// ∂Π/∂λ along a rate, in units.
    pub(super) fn work_along(&self, rate: &Rate) -> f64 {
        self.work_of(|c, k| rate.force[c][k], |b, k| rate.motion[b][k])
    }

    /// Residual of the regimes' equations in units.
    pub(super) fn residual(&self, start: &State, state: &State, slopes: &Slopes) -> Vec<f64> {
        let u = self.units;
        let points = state.gap.len();
        let mut out = vec![0.0; self.size()];
        for c in 0..points {
            if self.responses.is(c) {
                out[2 * c..2 * c + 2].copy_from_slice(&self.response_residual(state, c));
                continue;
            }
            let gap = self.step_gap(start, state, c).map(|g| g / u.displacement);
            let area = self.problem.contacts[c].area;
            let r = state.force[c];
            let rows = match (state.regime[c], self.law(c)) {
                (Regime::Facet(i), Some(law)) => {
                    let f = &law.facets[i as usize];
                    let yields = f.normal[0] * r[0] + f.normal[1] * r[1] - f.bound * area;
                    [yields / u.force, gap[0] * f.flow[1] - gap[1] * f.flow[0]]
                }
                (regime @ (Regime::Corner(..) | Regime::Open), Some(law)) => {
                    let corner = law.corner(regime).unwrap_or_default();
                    [(r[0] - corner[0] * area) / u.force, (r[1] - corner[1] * area) / u.force]
                }
                _ => gap,
            };
            out[2 * c] = rows[0];
            out[2 * c + 1] = rows[1];
        }
        for (body, balance) in slopes.balance.iter().enumerate() {
            if let Some(free) = self.free[body] {
                for k in 0..3 {
                    let unit = if k == 2 { u.force * u.length } else { u.force };
                    out[2 * points + 3 * free + k] = balance[k] / unit;
                }
            }
        }
        out
    }

    fn is_constant(&self, curvature: &Curvature) -> bool {
        self.constant.as_ref().is_some_and(|constant| std::ptr::eq(&**constant, curvature))
    }

    /// The regimes' linear equations, factorised: where nothing else than regimes makes them, those of
    /// the same regimes are taken again.
    fn factorised(&mut self, state: &State, curvature: &Curvature, row: &[f64]) -> Option<(Rc<BorderedFactors>, bool)> {
        let again = self.responses.is_empty() && self.is_constant(curvature);
        let directions: Vec<[f64; 4]> = self
            .polygons
            .iter()
            .flat_map(|law| law.facets.iter().map(|f| [f.normal[0], f.normal[1], f.flow[0], f.flow[1]]))
            .collect();
        if let Some(kept) = self.factorised.last.as_ref().filter(|_| again)
            && kept.regimes == state.regime
            && kept.directions == directions
            && kept.held.serves(row)
        {
            return Some((kept.held.clone(), true));
        }
        let equations = curvature.rows(self);
        let capacity = curvature.entries.len();
        let (mut rows, mut shifts) = (CsrMatrix::with_capacity(capacity), CsrMatrix::with_capacity(capacity));
        for (c, regime) in state.regime.iter().enumerate() {
            let answer = self.responses.is(c).then(|| self.response_row(state, c));
            for k in 0..2 {
                let (equation, shift) = (rows.open_row(), shifts.open_row());
                match &answer {
                    Some((own, stiffness)) => equations.response(c, k, own[k], stiffness[k], equation, shift),
                    None => equations.point(self.law(c), (c, k), *regime, false, equation, shift),
                }
                rows.end_row();
                shifts.end_row();
            }
        }
        equations.bodies(&mut rows, &mut shifts);
        self.count("factorisations", 1);
        let held = BorderedFactors::new(rows, shifts, state.regime.len(), row, &mut self.factorised.analysis)?;
        let held = Rc::new(held);
        self.factorised.last = again.then(|| Kept { regimes: state.regime.clone(), directions, held: held.clone() });
        Some((held, false))
    }

    /// Solves the regimes' linear equations for one right-hand side in units, and whether it is solved:
    /// where the equations contradict each other, what comes back is the answer of the shifted ones.
    pub(super) fn solve(
        &mut self,
        state: &State,
        curvature: &Curvature,
        row: &[f64],
        right: &[f64],
    ) -> Option<(Vec<f64>, bool)> {
        let (held, again) = self.factorised(state, curvature, row)?;
        let found = BorderedSystem::new(held, row).and_then(|bordered| refined(&bordered, right));
        if found.as_ref().is_some_and(|(_, solved)| *solved) || !again {
            return found;
        }
        // Another unknown held may serve this control better.
        self.factorised.last = None;
        let (held, _) = self.factorised(state, curvature, row)?;
        refined(&BorderedSystem::new(held, row)?, right)
    }
}

/// The solution of the equations without what was added, by refinement, and whether there is one.
fn refined(bordered: &BorderedSystem, right: &[f64]) -> Option<(Vec<f64>, bool)> {
    let mut x = vec![0.0; right.len()];
    let mut rest = right.to_vec();
    let mut before = f64::INFINITY;
    let norm = |v: &[f64]| v.iter().map(|x| x.abs()).fold(0.0, f64::max);
    let aim = norm(right);
    if aim == 0.0 {
        return Some((x, true));
    }
    let mut best = x.clone();
    for _ in 0..30 {
        let step = bordered.apply(&rest)?;
        x.iter_mut().zip(&step).for_each(|(x, s)| *x += s);
        let (left, error) = bordered.left(right, &x);
        rest = left;
        let now = norm(&rest);
        if now < before {
            best.copy_from_slice(&x);
        }
        if !now.is_finite() || now > 0.5 * before || now <= 1e-16 * aim || error <= ROUNDING {
            before = before.min(now);
            break;
        }
        before = now;
    }
    // What is left over is rounding of the solution's own size, or the system has no solution.
    let size = norm(&best).max(aim);
    Some((best, before <= 1e-9 * size))
}
