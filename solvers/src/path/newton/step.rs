//! Newton's method on the regimes of a step, and rates of converged states.

use super::kinematics::Curvature;
use super::line_search::of_tractions;
use super::model::{Control, Model, Rate, Refusal, State};
use crate::contact::mode::ContactMode as Regime;
use crate::optimise::line_search::LineSearch;

/// Contact points that want to change above which, twice running where eight times fewer did before, an
/// iteration is given up: it has left the neighbourhood of a solution, and change by change it does not
/// come back.
const ASTRAY: usize = 200;
/// Points that still change, and iterations in which they do not become fewer, with which a step of finite
/// displacements is given up: few points that go to and fro do so for ever.
const FEW: usize = 4;
const WITHOUT_GAIN: u32 = 24;

impl Model<'_> {
    pub(super) fn apply(&self, state: &mut State, step: &[f64], share: f64) {
        self.add(&mut state.force, &mut state.motion, step, share);
        state.factor += share * step[step.len() - 1] * self.units.factor;
        self.settle(&mut state.motion, state.factor);
    }

    /// Adds a share of a solution of the linear equations to forces and motions of the free bodies.
    fn add(&self, force: &mut [[f64; 2]], motion: &mut [[f64; 3]], step: &[f64], share: f64) {
        let u = self.units;
        let points = force.len();
        for (c, force) in force.iter_mut().enumerate() {
            (0..2).for_each(|k| force[k] += share * step[2 * c + k] * u.force);
        }
        for (body, motion) in motion.iter_mut().enumerate() {
            let Some(free) = self.free[body] else { continue };
            for (k, motion) in motion.iter_mut().enumerate() {
                let unit = if k == 2 { u.displacement / u.length } else { u.displacement };
                *motion += share * step[2 * points + 3 * free + k] * unit;
            }
        }
    }

    /// Regimes that the present forces and gaps ask for, and whether the laws hold in them: where flow is not
    /// associated the nearest regime need not be the return.
    pub(super) fn wanted(&mut self, start: &State, state: &State) -> (Vec<Regime>, bool) {
        self.count("law_evaluations", state.gap.len() as u64);
        let largest = state.force.iter().flatten().map(|r| r.abs()).fold(self.units.force, f64::max);
        let gaps = state.gap.iter().flatten().map(|g| g.abs());
        let motions = state.motion.iter().map(|q| q[0].abs().max(q[1].abs()).max(q[2].abs() * self.units.length));
        // Gaps are differences of motions: beyond rounding of those a gap means nothing.
        let rounding = 8.0 * f64::EPSILON * gaps.chain(motions).fold(0.0, f64::max);
        let mut holds = true;
        let regimes = (0..state.gap.len())
            .map(|c| match self.law(c) {
                None => Regime::Stick,
                Some(law) => {
                    let rho = self.stiffness(c);
                    let gap = self.step_gap(start, state, c);
                    let z = [state.force[c][0] - rho[0] * gap[0], state.force[c][1] - rho[1] * gap[1]];
                    // A certificate allows 1e-8 of the greatest force.
                    let tolerance = (rounding * rho[0].max(rho[1])).clamp(1e-11 * largest, 3e-9 * largest);
                    let area = self.problem.contacts[c].area;
                    let regime = law.mode(state.regime[c], z, rho, area, tolerance);
                    holds &= regime != state.regime[c] || law.violation(regime, z, rho, area) <= tolerance;
                    regime
                }
            })
            .collect();
        (regimes, holds)
    }

    /// Newton's method from a guess. Regimes change all at once as long as their number falls, else
    /// one by one (block principal pivoting with its fallback: Júdice & Pires 1994, Computers & Ops.
    /// Res. 21), so that regimes that flip for ever are seen. Where that fails, by a line search, then
    /// with one change at a time from the beginning; with small displacements and a given factor by
    /// pivoting, with associated flow by the caller's (a line search finds nothing there that it does not).
    pub fn newton(&mut self, start: &State, guess: State, control: &Control) -> Result<(State, u64), Refusal> {
        let found = self.iterate(start, guess.clone(), control, 8, None);
        if found.is_ok() || (!self.responses.is_empty() && self.polygons.is_empty()) {
            return found;
        }
        if self.finite() || !self.piecewise_linear() {
            if self.searches
                && let Ok(found) = self.line_searched(start, guess.clone(), control)
            {
                return Ok(found);
            }
            return self.iterate(start, guess, control, 0, None);
        }
        // Where flow is not associated pivoting may step over a limit point: from nothing only.
        match control {
            Control::Factor(factor) if self.monotone() || start.force.iter().flatten().all(|r| *r == 0.0) => {
                self.pivoted(start, &State { factor: *factor, ..guess }, control)
            }
            _ if self.searches && !self.monotone() => self.line_searched(start, guess, control).or(found),
            _ => found,
        }
    }

    /// Greatest relative residual: balance and yielding against forces, gaps against motions.
    pub(super) fn error(&self, residual: &[f64], state: &State) -> f64 {
        let u = self.units;
        let points = state.gap.len();
        let force = state.force.iter().flatten().map(|r| (r / u.force).abs()).fold(1.0, f64::max);
        let whole = self.largest(state);
        let by_row = |(i, x): (usize, &f64)| {
            let of_forces = if i < 2 * points && self.responses.is(i / 2) {
                self.response_row(state, i / 2).0[i % 2] > 0.5
            } else if i < 2 * points {
                match state.regime[i / 2] {
                    Regime::Stick => false,
                    Regime::Facet(_) => i % 2 == 0,
                    Regime::Corner(..) | Regime::Open => true,
                }
            } else {
                i + 1 < residual.len()
            };
            x.abs() / if of_forces { force } else { whole }
        };
        residual.iter().enumerate().map(by_row).fold(0.0, |worst, x| if x.is_nan() { x } else { worst.max(x) })
    }

    /// Greatest residual of equilibrium, relative to the greatest force.
    fn unbalanced(&self, residual: &[f64], state: &State) -> f64 {
        let force = state.force.iter().flatten().map(|r| (r / self.units.force).abs()).fold(0.0, f64::max);
        let rows = &residual[2 * state.gap.len()..residual.len() - 1];
        rows.iter().map(|x| x.abs()).fold(0.0, f64::max) / force.max(1e-6)
    }

    pub(super) fn iterate(
        &mut self,
        start: &State,
        guess: State,
        control: &Control,
        patience: u32,
        mut search: Option<LineSearch>,
    ) -> Result<(State, u64), Refusal> {
        if !self.responses.is_empty() {
            search = Some(of_tractions());
        }
        let mut state = guess;
        let factor = if let Control::Factor(target) = control { *target } else { state.factor };
        state.factor = factor;
        let mut motion = std::mem::take(&mut state.motion);
        self.settle(&mut motion, factor);
        state.motion = motion;
        self.deform(&mut state)?;
        let mut slopes = self.slopes(&state);
        state.gap = slopes.gap.clone();
        self.residuals.clear();
        let refused = |why: String| Refusal { why, restless: Vec::new() };
        self.respond(start, &mut state).map_err(refused)?;
        // Small displacements round by their own size, which the residual is relative to; a law of
        // tractions from gaps must hold to that.
        let rounding = match (self.finite(), self.responses.is_empty()) {
            (true, _) => 400.0 * f64::EPSILON * self.units.length / self.units.displacement,
            (false, true) => 0.0,
            (false, false) => 400.0 * f64::EPSILON,
        };
        let (mut changed, mut restless) = (true, Vec::new());
        let (mut least, mut without_gain) = (usize::MAX, 0);
        let (mut fewest, mut budget) = (usize::MAX, patience);
        let (mut unsolved, mut astray) = (0, 0);
        let (mut last_norm, mut whole) = (f64::INFINITY, true);
        // A law that softens converges soon or not at all: shorter steps cost less than long iterations.
        let most = match (self.responses.is_empty(), self.finite() && search.is_none()) {
            (false, _) => 25,
            (true, true) => 60 + (state.gap.len() as u64).min(200),
            (true, false) => 30,
        };
        for iteration in 0..most {
            let mut residual = self.residual(start, &state, &slopes);
            let (c, constraint) = self.constraint(start, &state, control);
            let last = residual.len() - 1;
            residual[last] = c;
            let norm = self.error(&residual, &state).max(self.inner_error(&state));
            self.residuals.push(norm);
            if !norm.is_finite() {
                return Err(Refusal { why: "an iteration left the numbers".into(), restless });
            }
            // Rounding is what a whole step does not lower.
            let stays = whole && norm > 0.3 * last_norm;
            let settled = norm <= 1e-13 + rounding || (norm <= 1e-9 + 30.0 * rounding && stays);
            // Rounding of positions excuses gaps, not equilibrium.
            let balanced = !self.finite() || self.unbalanced(&residual, &state) <= 1e-10;
            if iteration > 0 && !changed && settled && balanced && self.law_error(&state) <= 1e-9 {
                return Ok((state, iteration));
            }
            last_norm = norm;
            let curvature = self.curvature(&state, &slopes);
            let row = self.control_row(start, &state, control, &constraint, &curvature);
            let right: Vec<f64> = residual.iter().map(|x| -x).collect();
            self.count("newton_iterations", 1);
            let why = "the regimes of the contact points leave no equilibrium";
            let Some((step, solved)) = self.solve(&state, &curvature, &row, &right) else {
                return Err(Refusal { why: why.into(), restless });
            };
            // Regimes without a solution may be on the way to ones that have one: with small
            // displacements the shifted equations, a soft bedding, show which points close.
            unsolved += u32::from(!solved);
            if unsolved > if self.finite() { 0 } else { 10 } {
                return Err(Refusal { why: why.into(), restless });
            }
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
            (state, slopes, whole) = match &mut search {
                Some(search) => self.searched(start, (&state, &slopes), control, (&step[..], share), search)?,
                None => {
                    let (state, slopes) = self.advanced(start, &state, &step, share)?;
                    (state, slopes, true)
                }
            };
            let (wanted, holds) = self.wanted(start, &state);
            let differ: Vec<usize> = (0..wanted.len()).filter(|c| wanted[*c] != state.regime[*c]).collect();
            changed = !differ.is_empty() || !holds;
            let far = differ.len() > ASTRAY && differ.len() / 8 > fewest;
            astray = if far { astray + 1 } else { 0 };
            without_gain = if differ.len() < least { 0 } else { without_gain + 1 };
            least = least.min(differ.len());
            let to_and_fro = self.finite() && changed && least <= FEW && without_gain >= WITHOUT_GAIN;
            if search.is_none() && (astray > 1 || to_and_fro) {
                return Err(Refusal { why: "the regimes of contact points keep changing".into(), restless: differ });
            }
            if differ.len() < fewest && (patience > 0 || differ.len() <= 1) {
                (fewest, budget) = (differ.len(), patience);
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
        let row = self.control_row(start, state, control, &constraint, &curvature);
        self.rate_of(state, &curvature, &row)
    }

    /// Regimes that a small share of a rate asks for, from a converged state.
    pub fn regimes_ahead(&mut self, state: &State, ahead: &State) -> Vec<Regime> {
        let mut ahead = ahead.clone();
        ahead.gap = self.slopes(&ahead).gap;
        self.wanted(state, &ahead).0
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
        let (x, _) = self.solve(state, curvature, row, &right).filter(|(_, solved)| *solved)?;
        Some(self.rate_from(&x, state, curvature))
    }

    /// Forces, motions and the factor of a solution of the linear equations, without the gaps.
    pub(super) fn moving(&self, x: &[f64]) -> Rate {
        let points = self.problem.contacts.len();
        let (mut force, mut motion) = (vec![[0.0; 2]; points], vec![[0.0; 3]; self.free.len()]);
        self.add(&mut force, &mut motion, x, 1.0);
        let factor = x[x.len() - 1] * self.units.factor;
        for (body, settlement) in &self.loaded.growing.settlements {
            (0..3).for_each(|k| motion[*body][k] += factor * settlement[k]);
        }
        Rate { force, motion, factor, gap: Vec::new() }
    }

    /// The rate of a solution of the linear equations.
    pub(super) fn rate_from(&self, x: &[f64], state: &State, curvature: &Curvature) -> Rate {
        let rows = &curvature.rows(self).gaps;
        let along = |i: usize| rows.row_dot(i, x) * self.units.displacement;
        let gap = (0..state.gap.len()).map(|c| [along(2 * c), along(2 * c + 1)]).collect();
        Rate { gap, ..self.moving(x) }
    }
}
