//! The step problem: unknowns, units, residual by regimes, the linear system of Newton's method.
//!
//! Unknowns (r of all contact points, q of the free bodies, λ), each in its unit: force F, the size
//! of the loads; displacement U = F × mean compliance; rotation U / length; factor Λ. Rows by regime:
//!
//! ```text
//! stuck     g − s = 0                     facet   a·r = b A,  Δg × d = 0
//! corner    r = corner A                  body    ∂Π/∂q = 0          control  c(increment) = length
//! ```
//!
//! The matrix that is factorised is shifted by ε: compliance ε C̄ in every contact, stiffness ε / C̄
//! in every body and in every yielding contact. That makes it quasi-definite (Vanderbei 1995, SIAM J.
//! Optim. 5) where regimes repeat a condition or leave a motion free; iterative refinement against
//! the true matrix removes the shift from the answer. Where refinement does not converge, the
//! regimes have no solution, and the step is refused.

use super::kinematics::{Curvature, Kinematics, Loads, Slopes};
use super::law::{Polygon, Regime};
use crate::lu::SparseLu;
use voussoir_core::geometry::{Vec2, turned};
use voussoir_core::limit::Counters;
use voussoir_core::path::{Constraint, ContactLaw, Continuation, Increment, Loading, PathProblem};

/// The shift of the factorised matrix.
const SHIFT: f64 = 1e-9;

/// Units of the unknowns.
#[derive(Debug, Clone, Copy)]
pub(super) struct Units {
    pub force: f64,
    pub displacement: f64,
    pub length: f64,
    pub factor: f64,
}

/// A state with its history.
#[derive(Debug, Clone)]
pub(super) struct State {
    pub force: Vec<[f64; 2]>,
    pub motion: Vec<[f64; 3]>,
    pub factor: f64,
    pub gap: Vec<[f64; 2]>,
    pub regime: Vec<Regime>,
    /// s: irreversible gap.
    pub slip: Vec<[f64; 2]>,
}

/// Rate of a state per unit of its control.
#[derive(Debug, Clone)]
pub(super) struct Rate {
    pub force: Vec<[f64; 2]>,
    pub motion: Vec<[f64; 3]>,
    pub factor: f64,
    pub gap: Vec<[f64; 2]>,
}

impl Rate {
    pub fn scaled(&self, by: f64) -> Rate {
        Rate {
            force: self.force.iter().map(|r| r.map(|x| x * by)).collect(),
            motion: self.motion.iter().map(|q| q.map(|x| x * by)).collect(),
            factor: self.factor * by,
            gap: self.gap.iter().map(|g| g.map(|x| x * by)).collect(),
        }
    }
}

/// What fixes a step.
pub(super) enum Control<'a> {
    /// λ itself.
    Factor(f64),
    /// c(increment) = length.
    Strategy { strategy: &'a dyn Continuation, previous: Option<Increment>, length: f64 },
}

/// The present drive on top of what earlier ones left.
#[derive(Clone)]
pub(super) struct Loaded<'a> {
    pub earlier: Vec<(f64, &'a Loading)>,
    pub growing: &'a Loading,
    pub start: f64,
}

impl<'a> Loaded<'a> {
    pub fn at(&self, factor: f64) -> Loads<'a> {
        let mut parts = self.earlier.clone();
        parts.push((factor - self.start, self.growing));
        Loads { parts }
    }
}

pub(super) struct Model<'a> {
    pub problem: &'a PathProblem,
    pub kinematics: Kinematics<'a>,
    pub polygons: Vec<Polygon>,
    pub units: Units,
    /// Own compliance of every contact point, normal and tangential \[m/N\].
    pub compliance: Vec<[f64; 2]>,
    /// Index among the free bodies.
    free: Vec<Option<usize>>,
    pub bodies_free: usize,
    pub counters: Counters,
    pub loaded: Loaded<'a>,
    /// Second derivatives with small displacements, of the present drive.
    constant: Option<std::rc::Rc<Curvature>>,
}

/// Why a step was not found.
#[derive(Debug, Clone)]
pub(super) struct Refusal {
    pub why: String,
    /// Contact points that kept changing.
    pub restless: Vec<usize>,
}

impl<'a> Model<'a> {
    pub fn new(problem: &'a PathProblem, finite: bool) -> Result<Self, String> {
        let (mut mean, mut count) = (0.0, 0);
        let compliance: Vec<[f64; 2]> = problem
            .contacts
            .iter()
            .map(|c| {
                let mut own = c.compliance;
                for side in [c.minus, c.plus] {
                    if let (Some(slot), Some(flexibility)) = (side.slot, &problem.bodies[side.body].flexibility) {
                        let block = flexibility.fixed_view::<2, 2>(2 * slot, 2 * slot);
                        own[0] += (block * c.normal).dot(&c.normal);
                        own[1] += (block * c.tangent).dot(&c.tangent);
                    }
                }
                own
            })
            .collect();
        for c in compliance.iter().flatten().filter(|c| **c > 0.0) {
            mean += c;
            count += 1;
        }
        if count == 0 {
            return Err("nothing in the scene deforms: rigid blocks without joint compliance have no path before their collapse; limit analysis answers that".into());
        }
        mean /= f64::from(count);
        let mut free = vec![None; problem.bodies.len()];
        let mut bodies_free = 0;
        for (body, b) in problem.bodies.iter().enumerate().filter(|(_, b)| !b.held) {
            let _ = b;
            free[body] = Some(bodies_free);
            bodies_free += 1;
        }
        let size = |loading: &Loading| load_size(problem, loading);
        let sizes: Vec<f64> = problem.drives.iter().map(|d| size(&d.loading)).collect();
        let settlement = problem
            .drives
            .iter()
            .flat_map(|d| &d.loading.settlements)
            .map(|s| s.1[0].hypot(s.1[1]).max(s.1[2].abs() * problem.length))
            .fold(0.0, f64::max);
        let force = sizes.iter().copied().find(|s| *s > 0.0).unwrap_or(settlement / mean);
        let force = if force > 0.0 { force } else { 1.0 };
        let units = Units { force, displacement: force * mean, length: problem.length, factor: 1.0 };
        let polygons = problem.facets.iter().map(|f| Polygon::new(f)).collect();
        let loaded = Loaded { earlier: Vec::new(), growing: &problem.drives[0].loading, start: 0.0 };
        Ok(Model {
            kinematics: Kinematics::new(problem, finite),
            problem,
            polygons,
            units,
            compliance,
            free,
            bodies_free,
            counters: Counters::new(),
            loaded,
            constant: None,
        })
    }

    /// Begins a drive.
    pub fn load(&mut self, loaded: Loaded<'a>) {
        let size = load_size(self.problem, loaded.growing);
        let settlement = loaded
            .growing
            .settlements
            .iter()
            .map(|s| s.1[0].hypot(s.1[1]).max(s.1[2].abs() * self.units.length))
            .fold(0.0, f64::max);
        self.units.factor = match (size, settlement) {
            (s, _) if s > 0.0 => self.units.force / s,
            (_, s) if s > 0.0 => self.units.displacement / s,
            _ => 1.0,
        };
        self.loaded = loaded;
        self.constant = None;
    }

    pub fn count(&mut self, what: &str, by: u64) {
        *self.counters.entry(what.into()).or_default() += by;
    }

    fn size(&self) -> usize {
        2 * self.problem.contacts.len() + 3 * self.bodies_free + 1
    }

    pub fn finite(&self) -> bool {
        self.kinematics.finite
    }

    pub fn undeformed(&self) -> State {
        let points = self.problem.contacts.len();
        let motion = vec![[0.0; 3]; self.problem.bodies.len()];
        State {
            force: vec![[0.0; 2]; points],
            gap: self.problem.contacts.iter().map(|c| [c.gap, 0.0]).collect(),
            motion,
            factor: 0.0,
            regime: vec![Regime::Stuck; points],
            slip: vec![[0.0; 2]; points],
        }
    }

    pub fn law(&self, contact: usize) -> Option<&Polygon> {
        match self.problem.contacts[contact].law {
            ContactLaw::Bonded => None,
            ContactLaw::Law(law) => Some(&self.polygons[law]),
        }
    }

    /// Motions with the held bodies where their settlements put them.
    fn settle(&self, motion: &mut [[f64; 3]], factor: f64) {
        let settled = self.loaded.at(factor).settled(motion.len());
        for (body, motion) in motion.iter_mut().enumerate() {
            if self.free[body].is_none() {
                *motion = settled[body];
            }
        }
    }

    pub fn slopes(&self, state: &State) -> Slopes {
        self.kinematics.slopes(&state.force, &state.motion, &self.loaded.at(state.factor))
    }

    pub fn curvature(&mut self, state: &State, slopes: &Slopes) -> std::rc::Rc<Curvature> {
        if let Some(constant) = &self.constant {
            return constant.clone();
        }
        let loads = self.loaded.at(state.factor);
        let curvature = std::rc::Rc::new(self.kinematics.curvature(&state.force, &state.motion, &loads, slopes));
        if !self.finite() {
            self.constant = Some(curvature.clone());
        }
        curvature
    }

    /// Column of a global index, and its unit; `None` for held bodies.
    fn column(&self, index: usize) -> Option<(usize, f64)> {
        let base = 2 * self.problem.contacts.len();
        if index < base {
            return Some((index, self.units.force));
        }
        let (body, k) = ((index - base) / 3, (index - base) % 3);
        let unit = if k == 2 { self.units.displacement / self.units.length } else { self.units.displacement };
        self.free[body].map(|free| (base + 3 * free + k, unit))
    }

    /// Work-conjugate displacement of the growing load by rigid motions: Σ F·u / Σ|F| \[m\].
    pub fn displacement(&self, motion: &[[f64; 3]]) -> f64 {
        let loading = self.loaded.growing;
        let size = load_size(self.problem, loading);
        if size == 0.0 {
            return 0.0;
        }
        let forces: f64 =
            loading.forces.iter().map(|(body, _, point, f)| f.dot(&self.kinematics.rigid(*body, *point, motion))).sum();
        let bodies = self.problem.bodies.iter().zip(motion);
        let masses: f64 = bodies
            .filter(|(b, _)| !b.held)
            .map(|(b, q)| b.mass * loading.acceleration.dot(&Vec2::new(q[0], q[1])))
            .sum();
        (forces + masses) / size
    }

    /// Increment between two states in units, and the weights of its derivative: by gaps and directly.
    pub fn increment(&self, start: &State, state: &State) -> Increment {
        let u = self.units;
        let mut motion = 0.0;
        for body in (0..self.free.len()).filter(|b| self.free[*b].is_some()) {
            for k in 0..3 {
                let unit = if k == 2 { u.displacement / u.length } else { u.displacement };
                motion += ((state.motion[body][k] - start.motion[body][k]) / unit).powi(2) / self.bodies_free as f64;
            }
        }
        let mut dissipation = 0.0;
        let points = state.gap.len() as f64;
        for c in 0..state.gap.len() {
            for k in 0..2 {
                motion += ((state.gap[c][k] - start.gap[c][k]) / u.displacement).powi(2) / points;
            }
            if let Some(law) = self.law(c) {
                let (kept, _) = law.irreversible(state.regime[c], self.step_gap(start, state, c));
                dissipation -= kept[0] * state.force[c][0] + kept[1] * state.force[c][1];
            }
        }
        Increment {
            factor: (state.factor - start.factor) / u.factor,
            displacement: (self.displacement(&state.motion) - self.displacement(&start.motion)) / u.displacement,
            motion: motion.sqrt(),
            dissipation: dissipation / (u.force * u.displacement),
        }
    }

    /// Increment of a rate from a state.
    pub fn increment_of(&self, state: &State, rate: &Rate) -> Increment {
        let mut moved = state.clone();
        let small = 1e-6 / self.rate_size(rate).max(1e-300);
        // Linear in a step that is small: displacement and dissipation may not be.
        let step = rate.scaled(small);
        for c in 0..moved.gap.len() {
            (0..2).for_each(|k| moved.gap[c][k] += step.gap[c][k]);
        }
        for (q, dq) in moved.motion.iter_mut().zip(&step.motion) {
            (0..3).for_each(|k| q[k] += dq[k]);
        }
        moved.factor += step.factor;
        let mut base = state.clone();
        base.slip = base.gap.clone();
        let i = self.increment(&base, &moved);
        Increment {
            factor: rate.factor / self.units.factor,
            displacement: i.displacement / small,
            motion: i.motion / small,
            dissipation: i.dissipation / small,
        }
    }

    /// Size of a rate in units, all of it.
    pub fn rate_size(&self, rate: &Rate) -> f64 {
        let u = self.units;
        let force: f64 = rate.force.iter().flatten().map(|r| (r / u.force).powi(2)).sum();
        self.motion_size(rate).hypot(rate.factor / u.factor).hypot(force.sqrt())
    }

    /// Size of the motion of a rate in units.
    pub fn motion_size(&self, rate: &Rate) -> f64 {
        let u = self.units;
        let gap: f64 = rate.gap.iter().flatten().map(|g| (g / u.displacement).powi(2)).sum();
        let motion: f64 = rate
            .motion
            .iter()
            .map(|q| (q[0].powi(2) + q[1].powi(2) + (q[2] * u.length).powi(2)) / u.displacement.powi(2))
            .sum();
        (gap + motion).sqrt()
    }

    /// Δg of a step at a contact point.
    pub fn step_gap(&self, start: &State, state: &State, contact: usize) -> [f64; 2] {
        [state.gap[contact][0] - start.slip[contact][0], state.gap[contact][1] - start.slip[contact][1]]
    }

    /// Gradient of a constraint over the scaled unknowns.
    fn gradient(&self, start: &State, state: &State, constraint: &Constraint, curvature: &Curvature) -> Vec<f64> {
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
        self.add_gaps(&mut row, &by_gap, curvature);
        row
    }

    /// Adds weighted gaps to a row over the scaled unknowns.
    fn add_gaps(&self, row: &mut [f64], by_gap: &[f64], curvature: &Curvature) {
        if by_gap.iter().all(|w| *w == 0.0) {
            return;
        }
        for &(i, j, value) in &curvature.entries {
            if i < by_gap.len() && by_gap[i] != 0.0 {
                if let Some((column, unit)) = self.column(j) {
                    row[column] += by_gap[i] * value * unit;
                }
            }
        }
        let last = row.len() - 1;
        for (i, weight) in by_gap.iter().enumerate() {
            row[last] += weight * curvature.factor[i] * self.units.factor;
        }
    }

    fn constraint(&self, start: &State, state: &State, control: &Control) -> (f64, Constraint) {
        match control {
            Control::Factor(target) => {
                let derivative = Increment { factor: 1.0, ..Increment::default() };
                ((state.factor - target) / self.units.factor, Constraint { value: 0.0, derivative })
            }
            Control::Strategy { strategy, previous, length } => {
                let c = strategy.constraint(&self.increment(start, state), previous.as_ref());
                (c.value - length, c)
            }
        }
    }

    /// Residual of the regimes' equations in units.
    fn residual(&self, start: &State, state: &State, slopes: &Slopes) -> Vec<f64> {
        let u = self.units;
        let points = state.gap.len();
        let mut out = vec![0.0; self.size()];
        for c in 0..points {
            let gap = self.step_gap(start, state, c).map(|g| g / u.displacement);
            let area = self.problem.contacts[c].area;
            let r = state.force[c];
            let rows = match (state.regime[c], self.law(c)) {
                (Regime::Facet(i), Some(law)) => {
                    let f = &law.facets[i as usize];
                    let yields = f.normal[0] * r[0] + f.normal[1] * r[1] - f.bound * area;
                    [yields / u.force, gap[0] * f.flow[1] - gap[1] * f.flow[0]]
                }
                (Regime::Corner(k), Some(law)) => {
                    let corner = law.corners[k as usize].0;
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

    /// Solves the regimes' linear equations for one right-hand side in units. `None`: no solution.
    fn solve(&mut self, regimes: &[Regime], curvature: &Curvature, row: &[f64], right: &[f64]) -> Option<Vec<f64>> {
        let u = self.units;
        let (points, size) = (regimes.len(), self.size());
        let last = size - 1;
        let mut entries: Vec<(usize, usize, f64)> = Vec::with_capacity(curvature.entries.len() + 4 * size);
        let mut shifts: Vec<(usize, usize, f64)> = Vec::new();
        let row_unit = |i: usize| if (i - 2 * points) % 3 == 2 { u.force * u.length } else { u.force };
        let mut place = |i: usize, column: usize, value: f64| {
            // `value` in SI per scaled unknown.
            if i >= 2 * points {
                if let Some((free_row, _)) = self.column(i) {
                    entries.push((free_row, column, value / row_unit(i)));
                }
                return;
            }
            let (c, k) = (i / 2, i % 2);
            let value = value / u.displacement;
            match (regimes[c], self.law(c)) {
                (Regime::Facet(f), Some(law)) => {
                    let d = law.facets[f as usize].flow;
                    entries.push((2 * c + 1, column, value * if k == 0 { d[1] } else { -d[0] }));
                    let weight = d[k] / (d[0] * d[0] + d[1] * d[1]);
                    shifts.push((2 * c, column, SHIFT * weight * value));
                }
                (Regime::Corner(_), Some(_)) => shifts.push((i, column, SHIFT * value)),
                _ => entries.push((i, column, value)),
            }
        };
        for &(i, j, value) in &curvature.entries {
            if let Some((column, unit)) = self.column(j) {
                place(i, column, value * unit);
            }
        }
        for (i, value) in curvature.factor.iter().enumerate() {
            if *value != 0.0 {
                place(i, last, value * u.factor);
            }
        }
        for c in 0..points {
            match (regimes[c], self.law(c)) {
                (Regime::Facet(f), Some(law)) => {
                    let a = law.facets[f as usize].normal;
                    entries.push((2 * c, 2 * c, a[0]));
                    entries.push((2 * c, 2 * c + 1, a[1]));
                }
                (Regime::Corner(_), Some(_)) => {
                    entries.push((2 * c, 2 * c, 1.0));
                    entries.push((2 * c + 1, 2 * c + 1, 1.0));
                }
                _ => {
                    shifts.push((2 * c, 2 * c, SHIFT));
                    shifts.push((2 * c + 1, 2 * c + 1, SHIFT));
                }
            }
        }
        for free in 2 * points..last {
            shifts.push((free, free, -SHIFT));
        }
        for (j, value) in row.iter().enumerate() {
            if *value != 0.0 {
                entries.push((last, j, *value));
            }
        }
        self.count("factorisations", 1);
        let mut shifted = entries.clone();
        shifted.extend(shifts);
        let factors = SparseLu::new(size, &shifted)?;
        let mut x = vec![0.0; size];
        let mut rest = right.to_vec();
        let mut before = f64::INFINITY;
        let norm = |v: &[f64]| v.iter().map(|x| x.abs()).fold(0.0, f64::max);
        let aim = norm(right);
        if aim == 0.0 {
            return Some(x);
        }
        let mut best = x.clone();
        for _ in 0..30 {
            let step = factors.solve(&[rest], 0)?.swap_remove(0);
            x.iter_mut().zip(&step).for_each(|(x, s)| *x += s);
            rest = right.to_vec();
            for &(i, j, value) in &entries {
                rest[i] -= value * x[j];
            }
            let now = norm(&rest);
            if now < before {
                best.copy_from_slice(&x);
            }
            if !now.is_finite() || now > 0.5 * before || now <= 1e-16 * aim {
                before = before.min(now);
                break;
            }
            before = now;
        }
        // What is left over is rounding of the solution's own size, or the system has no solution.
        let size = norm(&best).max(aim);
        (before <= 1e-9 * size).then_some(best)
    }

    fn apply(&self, state: &mut State, step: &[f64], share: f64) {
        let u = self.units;
        let points = state.force.len();
        for c in 0..points {
            (0..2).for_each(|k| state.force[c][k] += share * step[2 * c + k] * u.force);
        }
        for body in 0..self.free.len() {
            if let Some(free) = self.free[body] {
                for k in 0..3 {
                    let unit = if k == 2 { u.displacement / u.length } else { u.displacement };
                    state.motion[body][k] += share * step[2 * points + 3 * free + k] * unit;
                }
            }
        }
        state.factor += share * step[step.len() - 1] * u.factor;
        self.settle(&mut state.motion, state.factor);
    }

    /// Regimes that the present forces and gaps ask for.
    fn wanted(&mut self, start: &State, state: &State) -> Vec<Regime> {
        self.count("law_evaluations", state.gap.len() as u64);
        let largest = state.force.iter().flatten().map(|r| r.abs()).fold(self.units.force, f64::max);
        let mean = self.units.displacement / self.units.force;
        (0..state.gap.len())
            .map(|c| match self.law(c) {
                None => Regime::Stuck,
                Some(law) => {
                    let rho = self.compliance[c].map(|own| 1.0 / if own > 1e-9 * mean { own } else { mean });
                    let gap = self.step_gap(start, state, c);
                    let z = [state.force[c][0] - rho[0] * gap[0], state.force[c][1] - rho[1] * gap[1]];
                    law.regime(state.regime[c], z, rho, self.problem.contacts[c].area, 1e-11 * largest)
                }
            })
            .collect()
    }

    /// Newton's method from a guess. Regimes change all at once as long as their number falls, else
    /// one by one (block principal pivoting with its fallback: Júdice & Pires 1994, Computers & Ops.
    /// Res. 21), so that regimes that flip for ever are seen.
    pub fn newton(&mut self, start: &State, guess: State, control: &Control) -> Result<(State, u64), Refusal> {
        let mut state = guess;
        let factor = if let Control::Factor(target) = control { *target } else { state.factor };
        state.factor = factor;
        let mut motion = std::mem::take(&mut state.motion);
        self.settle(&mut motion, factor);
        state.motion = motion;
        let mut slopes = self.slopes(&state);
        state.gap = slopes.gap.clone();
        let rounding = 400.0 * f64::EPSILON * self.units.length / self.units.displacement;
        let (mut changed, mut restless) = (true, Vec::new());
        let (mut fewest, mut budget) = (usize::MAX, 8);
        let mut last_norm = f64::INFINITY;
        for iteration in 0..60 + (state.gap.len() as u64).min(200) {
            let mut residual = self.residual(start, &state, &slopes);
            let (c, constraint) = self.constraint(start, &state, control);
            let last = residual.len() - 1;
            residual[last] = c;
            let norm = residual.iter().map(|x| x.abs()).fold(0.0, f64::max);
            let size = self.largest(&state);
            if !norm.is_finite() {
                return Err(Refusal { why: "an iteration left the numbers".into(), restless });
            }
            let tolerance = 1e-13 * size + rounding;
            let settled = norm <= tolerance || (norm <= 1e-9 * size + 30.0 * rounding && norm > 0.3 * last_norm);
            if iteration > 0 && !changed && settled {
                return Ok((state, iteration));
            }
            last_norm = norm;
            let curvature = self.curvature(&state, &slopes);
            let row = self.gradient(start, &state, &constraint, &curvature);
            let right: Vec<f64> = residual.iter().map(|x| -x).collect();
            self.count("newton_iterations", 1);
            let Some(step) = self.solve(&state.regime, &curvature, &row, &right) else {
                return Err(Refusal { why: "the regimes of the contact points leave no equilibrium".into(), restless });
            };
            // Rotations of an iteration stay where the linearisation means something.
            let share = if self.finite() {
                let points = state.gap.len();
                let turn = (0..self.bodies_free)
                    .map(|b| (step[2 * points + 3 * b + 2] * self.units.displacement / self.units.length).abs())
                    .fold(0.0, f64::max);
                (0.1 / turn.max(1e-300)).min(1.0)
            } else {
                1.0
            };
            self.apply(&mut state, &step, share);
            slopes = self.slopes(&state);
            state.gap = slopes.gap.clone();
            let wanted = self.wanted(start, &state);
            let differ: Vec<usize> = (0..wanted.len()).filter(|c| wanted[*c] != state.regime[*c]).collect();
            changed = !differ.is_empty();
            if differ.len() < fewest {
                (fewest, budget) = (differ.len(), 8);
                state.regime = wanted;
            } else if budget > 0 {
                budget -= 1;
                state.regime = wanted;
            } else if let Some(&c) = differ.last() {
                state.regime[c] = wanted[c];
            }
            restless = differ;
        }
        Err(Refusal { why: "the regimes of contact points keep changing".into(), restless })
    }

    fn largest(&self, state: &State) -> f64 {
        let u = self.units;
        let force = state.force.iter().flatten().map(|r| (r / u.force).abs()).fold(1.0, f64::max);
        let motion = state.motion.iter().map(|q| q[0].abs().max(q[1].abs()).max(q[2].abs() * u.length));
        force.max(motion.map(|m| m / u.displacement).fold(0.0, f64::max))
    }

    /// Rate of a converged state with its regimes held, per unit of the control's gradient.
    pub fn rate(&mut self, start: &State, state: &State, control: &Control) -> Option<Rate> {
        let slopes = self.slopes(state);
        let curvature = self.curvature(state, &slopes);
        let (_, constraint) = self.constraint(start, state, control);
        let row = self.gradient(start, state, &constraint, &curvature);
        self.rate_of(state, &curvature, &row)
    }

    /// Regimes that a small share of a rate asks for, from a converged state.
    pub fn regimes_ahead(&mut self, state: &State, ahead: &State) -> Vec<Regime> {
        let mut ahead = ahead.clone();
        ahead.gap = self.slopes(&ahead).gap;
        self.wanted(state, &ahead)
    }

    /// Rate with other regimes than the state's, per unit of the sum of the multipliers of the points
    /// that change: the branch on which they yield. `None` where there is none.
    pub fn rate_of_yielding(&mut self, state: &State, regimes: &[Regime]) -> Option<Rate> {
        let slopes = self.slopes(state);
        let curvature = self.curvature(state, &slopes);
        let mut by_gap = vec![0.0; 2 * state.gap.len()];
        for c in (0..state.gap.len()).filter(|c| regimes[*c] != state.regime[*c]) {
            let flow = match (regimes[c], self.law(c)) {
                (Regime::Facet(i), Some(law)) => law.facets[i as usize].flow,
                _ => [-1.0, 0.0],
            };
            (0..2).for_each(|k| by_gap[2 * c + k] = -flow[k] / self.units.displacement);
        }
        let mut row = vec![0.0; self.size()];
        self.add_gaps(&mut row, &by_gap, &curvature);
        let mut other = state.clone();
        other.regime = regimes.to_vec();
        self.rate_of(&other, &curvature, &row)
    }

    /// Rate of a state with its regimes held, per unit of `row`.
    fn rate_of(&mut self, state: &State, curvature: &Curvature, row: &[f64]) -> Option<Rate> {
        let mut right = vec![0.0; self.size()];
        right[self.size() - 1] = 1.0;
        let x = self.solve(&state.regime, curvature, row, &right)?;
        let mut zero = State {
            force: vec![[0.0; 2]; state.force.len()],
            motion: vec![[0.0; 3]; state.motion.len()],
            factor: 0.0,
            gap: vec![[0.0; 2]; state.gap.len()],
            regime: Vec::new(),
            slip: Vec::new(),
        };
        self.apply(&mut zero, &x, 1.0);
        let factor = zero.factor;
        let mut motion = vec![[0.0; 3]; state.motion.len()];
        for (body, settlement) in &self.loaded.growing.settlements {
            (0..3).for_each(|k| motion[*body][k] += factor * settlement[k]);
        }
        for body in (0..motion.len()).filter(|b| self.free[*b].is_some()) {
            motion[body] = zero.motion[body];
        }
        let points = state.gap.len();
        let mut gap = vec![[0.0; 2]; points];
        for &(i, j, value) in curvature.entries.iter().filter(|e| e.0 < 2 * points) {
            if let Some((column, unit)) = self.column(j) {
                gap[i / 2][i % 2] += value * unit * x[column];
            }
        }
        for c in 0..points {
            (0..2).for_each(|k| gap[c][k] += curvature.factor[2 * c + k] * factor);
        }
        Some(Rate { force: zero.force, motion, factor, gap })
    }

    /// The irreversible gaps of a step become history.
    pub fn keep(&self, start: &State, state: &mut State) {
        for c in 0..state.gap.len() {
            let gap = self.step_gap(start, state, c);
            state.slip[c] = start.slip[c];
            if let Some(law) = self.law(c) {
                let (kept, _) = law.irreversible(state.regime[c], gap);
                (0..2).for_each(|k| state.slip[c][k] += kept[k]);
            }
        }
    }
}

/// Σ|F| of a loading, weights of accelerated free bodies included \[N\].
pub(super) fn load_size(problem: &PathProblem, loading: &Loading) -> f64 {
    let forces: f64 = loading.forces.iter().map(|f| f.3.norm()).sum();
    let masses: f64 = problem.bodies.iter().filter(|b| !b.held).map(|b| b.mass).sum();
    forces + masses * loading.acceleration.norm()
}
