//! Newton's method on the contact modes of a step.

use super::linearised::residual_of;
use super::nearby::{Accuracy, solve};
use super::tangent::{apply_step, wanted_modes};
use crate::contact::mode::ContactMode;
use crate::contact::yield_polygon::YieldPolygon;
use crate::path::newton::model::control::Control;
use crate::path::newton::model::derivatives::Gradient;
use crate::path::newton::model::equations::Equations;
use crate::path::newton::model::limits::Iterations;
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::control_row::{control_row, control_value};
use crate::path::newton::quantities::inelastic::{block_error, update_blocks};
use crate::path::newton::quantities::response::{traction_error, traction_row, update_tractions};
use crate::settings::SETTINGS;
use std::rc::Rc;

/// Number of contact points with wrong modes above which an iteration is given up, if the number was eight times
/// smaller before, twice in succession: it has left the neighbourhood of a solution.
const MAX_WRONG_MODES: usize = 200;

/// Greatest number of changing points that may be in a cycle.
const MAX_CYCLING_POINTS: usize = 4;

/// Newton's method from a guess. All modes may change at once `patience` times without a decrease of their number.
/// Returns the result and the number of iterations.
pub fn iterate(
    system: &mut StepSystem,
    start: &State,
    guess: State,
    control: &Control,
    patience: u32,
) -> Result<(State, u64), String> {
    let (mut state, mut gradient) = first_state(system, start, guess, control)?;
    system.report.residuals.clear();
    let rounding = system.limits.rounding;
    let Iterations { unsolved: most_unsolved, iterations, cycle, .. } = system.limits.newton;
    let mut changes = ModeChanges::new(patience, cycle);
    let (mut unsolved, mut last_norm, mut whole) = (0, f64::INFINITY, true);
    let mut linearised = LinearisedAt::of(start, system.limits.nearby);
    for iteration in 0..iterations {
        let mut residual = residual_of(system, start, &state, &gradient);
        let last = residual.len() - 1;
        residual[last] = control_value(system, start, &state, control);
        let inner = block_error(system, &state);
        let norm = relative_residual(system, &residual, &state).max(inner);
        system.report.residuals.push(norm);
        if !norm.is_finite() {
            return Err("an iteration left the numbers".into());
        }
        // A residual that a full step does not lower is rounding.
        let stays = whole && norm > 0.3 * last_norm;
        let settled = norm <= system.found() + rounding || (norm <= SETTINGS.admissible + 30.0 * rounding && stays);
        let fine = !linearised.lags || norm <= SETTINGS.fine * (system.found() + rounding);
        let converged = settled && fine && holds_at(system, &residual, &state, (inner, rounding, stays));
        if iteration > 0 && !changes.changed && converged {
            return Ok((state, iteration));
        }
        let equations =
            linearised.equations(system, &state, !changes.changed && norm > SETTINGS.contraction * last_norm);
        last_norm = norm;
        let row = control_row(system, control, &equations);
        let right: Vec<f64> = residual.iter().map(|x| -x).collect();
        system.count("newton_iterations", 1);
        system.report.iterations += 1;
        let solution = solve(system, &state, &equations, (&row, &right), Accuracy::Rough);
        // Modes without a solution may lead to modes with one: with small displacements the shifted equations, which
        // act as a soft bedding, show the points that close.
        unsolved += u32::from(solution.as_ref().is_some_and(|(_, solved)| !solved));
        let Some((step, _)) = solution.filter(|_| unsolved <= most_unsolved) else {
            return Err("the modes of the contact points leave no equilibrium".into());
        };
        let share = rotation_bound(system, &step);
        (state, gradient) = advanced(system, start, &state, &step, share)?;
        whole = !linearised.lags;
        let (wanted, holds) = wanted_modes(system, start, &state);
        changes.update(&state, wanted, holds);
        if changes.hopeless() {
            return Err("the modes of contact points keep changing".into());
        }
        changes.take(&mut state);
    }
    Err("the modes of contact points keep changing".into())
}

/// The state at which the equations of an iteration are linearised. They are reused nearby while residuals fall.
pub struct LinearisedAt {
    /// That state; `None` if the equations are always those of the present state.
    place: Option<State>,
    /// True if they are not those of the present state.
    lags: bool,
}

impl LinearisedAt {
    /// Creates it for steps from a start; `serve` is true if its equations may be reused at nearby states.
    pub fn of(start: &State, serve: bool) -> Self {
        LinearisedAt { place: serve.then(|| start.clone()), lags: false }
    }

    /// Returns true if the last equations were not those of the present state.
    pub fn lags(&self) -> bool {
        self.lags
    }

    /// Returns true if a residual is small enough for the equations used.
    pub fn is_fine(&self, norm: f64, found: f64) -> bool {
        !self.lags || norm <= SETTINGS.fine * found
    }

    /// Returns equations for a state; `slow` if those of the last iteration reduced the residual too little.
    pub fn equations(&mut self, system: &mut StepSystem, state: &State, slow: bool) -> Rc<Equations> {
        let Some(place) = &mut self.place else { return system.equations(state) };
        self.lags = !(slow && self.lags) && turned_between(place, state) <= SETTINGS.small;
        if !self.lags {
            place.clone_from(state);
        }
        system.equations(place)
    }
}

/// Returns true if a state with a converged residual satisfies equilibrium, gaps, strengths and laws of tractions.
pub fn holds_at(
    system: &StepSystem,
    residual: &[f64],
    state: &State,
    (inner, rounding, stays): (f64, f64, bool),
) -> bool {
    // Rounding of positions allows errors of gaps, not of equilibrium.
    let holds = || {
        let (gap, force) = gap_error(system, residual, state);
        inner <= SETTINGS.inequality()
            && unbalanced_share(system, residual, state) <= SETTINGS.inequality()
            && gap <= SETTINGS.admissible + rounding / largest_unknown(system, state)
            && (stays || force <= SETTINGS.admissible)
            && is_admissible(system, state)
    };
    (!system.finite() || holds()) && traction_error(system, state) <= SETTINGS.admissible
}

/// Returns the guess as a state of the step, with its loads, blocks and responses of laws.
pub fn first_state(
    system: &mut StepSystem,
    start: &State,
    guess: State,
    control: &Control,
) -> Result<(State, Rc<Gradient>), String> {
    let mut state = guess;
    state.factor = if let Control::Factor(target) = control { *target } else { state.factor };
    system.settle(&mut state.motion, state.factor);
    update_blocks(system, &mut state)?;
    let gradient = system.gradient(&state);
    state.gap = gradient.gap.clone();
    update_tractions(system, start, &mut state)?;
    Ok((state, gradient))
}

/// Returns the state moved by a share of a step, with its blocks, gaps and tractions.
pub fn advanced(
    system: &mut StepSystem,
    start: &State,
    state: &State,
    step: &[f64],
    share: f64,
) -> Result<(State, Rc<Gradient>), String> {
    let mut next = state.clone();
    apply_step(system, &mut next, step, share);
    update_blocks(system, &mut next)?;
    let gradient = system.gradient(&next);
    next.gap = gradient.gap.clone();
    update_tractions(system, start, &mut next)?;
    Ok((next, gradient))
}

/// Returns the greatest rotation of a body from one state to another.
fn turned_between(start: &State, state: &State) -> f64 {
    let turns = state.motion.iter().zip(&start.motion).map(|(q, before)| (q[2] - before[2]).abs());
    turns.fold(0.0, f64::max)
}

/// Returns the share of an iteration for which its rotations are in the range of the linearisation.
pub fn rotation_bound(system: &StepSystem, step: &[f64]) -> f64 {
    let points = system.scaled.contacts;
    let turn = (0..system.scaled.bodies)
        .map(|b| (step[2 * points + 3 * b + 2] * system.units().displacement / system.units().length).abs())
        .fold(0.0, f64::max);
    (system.limits.rotation / turn.max(1e-300)).min(1.0)
}

/// The changes of contact modes between iterations: block principal pivoting with its fallback.
struct ModeChanges {
    patience: u32,
    /// Number of iterations without gain that count as a cycle.
    cycle: u32,
    changed: bool,
    /// Points with wrong modes, and the required modes of all points.
    differ: Vec<usize>,
    wanted: Vec<ContactMode>,
    /// Least number of wrong modes, and iterations since then.
    least: usize,
    without_gain: u32,
    /// Least number of wrong modes at a change of all modes, and how often all may change without a decrease.
    fewest: usize,
    budget: u32,
    /// Number of successive iterations with far more changes than before.
    astray: u32,
}

impl ModeChanges {
    fn new(patience: u32, cycle: u32) -> Self {
        let (differ, wanted) = (Vec::new(), Vec::new());
        let (least, fewest) = (usize::MAX, usize::MAX);
        let (without_gain, budget, astray) = (0, patience, 0);
        ModeChanges { patience, cycle, changed: true, differ, wanted, least, without_gain, fewest, budget, astray }
    }

    /// Records the modes that a state requires; `holds` is true if the laws hold in its own modes.
    fn update(&mut self, state: &State, wanted: Vec<ContactMode>, holds: bool) {
        self.differ = (0..wanted.len()).filter(|c| wanted[*c] != state.mode[*c]).collect();
        self.wanted = wanted;
        let count = self.differ.len();
        self.changed = count > 0 || !holds;
        self.astray = if count > MAX_WRONG_MODES && count / 8 > self.fewest { self.astray + 1 } else { 0 };
        self.without_gain = if count < self.least { 0 } else { self.without_gain + 1 };
        self.least = self.least.min(count);
    }

    /// Returns true if the iteration has left the neighbourhood of a solution, or if few points cycle.
    fn hopeless(&self) -> bool {
        let cycles = self.changed && self.least <= MAX_CYCLING_POINTS && self.without_gain >= self.cycle;
        self.astray > 1 || cycles
    }

    /// Changes all modes, or one of them.
    fn take(&mut self, state: &mut State) {
        let count = self.differ.len();
        if count < self.fewest && (self.patience > 0 || count <= 1) {
            (self.fewest, self.budget) = (count, self.patience);
            state.mode = std::mem::take(&mut self.wanted);
        } else if self.budget > 0 {
            self.budget -= 1;
            state.mode = std::mem::take(&mut self.wanted);
        } else if let Some(&c) = self.differ.last() {
            state.mode[c] = self.wanted[c];
        }
    }
}

/// Returns the greatest relative residual: balance and yielding relative to forces, gaps relative to motions.
pub fn relative_residual(system: &StepSystem, residual: &[f64], state: &State) -> f64 {
    let u = system.units();
    let points = state.gap.len();
    let force = state.force.iter().flatten().map(|r| (r / u.force).abs()).fold(1.0, f64::max);
    let whole = largest_unknown(system, state);
    let by_row = |(i, x): (usize, &f64)| {
        let of_forces = if i < 2 * points { !is_gap_row(system, state, i) } else { i + 1 < residual.len() };
        x.abs() / if of_forces { force } else { whole }
    };
    residual.iter().enumerate().map(by_row).fold(0.0, |worst, x| if x.is_nan() { x } else { worst.max(x) })
}

/// Returns true if a contact point's row is an equation of gaps, not of forces.
fn is_gap_row(system: &StepSystem, state: &State, row: usize) -> bool {
    let (point, k) = (row / 2, row % 2);
    if system.laws.responses.is(point) {
        return traction_row(system, state, point).0[k] <= 0.5;
    }
    match state.mode[point] {
        ContactMode::Stick => true,
        ContactMode::Facet(_) => k == 1,
        ContactMode::Corner(..) | ContactMode::Open => false,
    }
}

/// Returns the greatest residual of the gaps of facets, relative to the greatest unknown, and the force that the joint
/// would give for it, relative to the greatest force. Rounding of positions is an error in units of displacement, so it
/// is a smaller share of larger motions. Laws of tractions have a separate error.
pub fn gap_error(system: &StepSystem, residual: &[f64], state: &State) -> (f64, f64) {
    let u = system.units();
    let largest = state.force.iter().flatten().map(|r| r.abs()).fold(1e-6 * u.force, f64::max);
    let (mut greatest, mut force) = (0.0_f64, 0.0_f64);
    let of_facets = |row: &usize| !system.laws.responses.is(row / 2) && is_gap_row(system, state, *row);
    for row in (0..2 * state.gap.len()).filter(of_facets) {
        let [a, b] = system.stiffness(row / 2);
        greatest = greatest.max(residual[row].abs());
        force = force.max(residual[row].abs() * u.displacement * a.max(b) / largest);
    }
    (greatest / largest_unknown(system, state), force)
}

/// Returns true if all contact forces satisfy their strengths within twice the tolerance of modes: rounding of
/// positions allows errors of gaps, not of strengths.
fn is_admissible(system: &StepSystem, state: &State) -> bool {
    let largest = state.force.iter().flatten().map(|r| r.abs()).fold(system.units().force, f64::max);
    let keeps = |(c, r): (usize, &[f64; 2])| {
        let excess = |law: &YieldPolygon| law.excess(*r, system.problem.contacts[c].area);
        system.law(c).is_none_or(|law| excess(law) <= 2.0 * SETTINGS.mode * largest)
    };
    state.force.iter().enumerate().all(keeps)
}

/// Returns the greatest residual of equilibrium, relative to the greatest force.
pub fn unbalanced_share(system: &StepSystem, residual: &[f64], state: &State) -> f64 {
    let force = state.force.iter().flatten().map(|r| (r / system.units().force).abs()).fold(0.0, f64::max);
    let rows = &residual[2 * state.gap.len()..residual.len() - 1];
    rows.iter().map(|x| x.abs()).fold(0.0, f64::max) / force.max(1e-6)
}

pub fn largest_unknown(system: &StepSystem, state: &State) -> f64 {
    let u = system.units();
    let force = state.force.iter().flatten().map(|r| (r / u.force).abs()).fold(1.0, f64::max);
    let motion = state.motion.iter().map(|q| q[0].abs().max(q[1].abs()).max(q[2].abs() * u.length));
    force.max(motion.map(|m| m / u.displacement).fold(0.0, f64::max))
}
