//! Newton's method on the contact modes of a step.

use super::control::Control;
use super::control_row::{control_row, control_value};
use super::inelastic::{block_error, update_blocks};
use super::law::ContactMode;
use super::line_search::{LineSearch, advanced, searched};
use super::linearised::{residual_of, solve_linear};
use super::response::{traction_error, traction_row, update_tractions};
use super::state::State;
use super::system::{StepFailure, StepSystem};
use super::tangent::wanted_modes;

/// Contact points that want to change above which, twice running where eight times fewer did before, an
/// iteration is given up: it has left the neighbourhood of a solution, and change by change it does not
/// come back.
const ASTRAY: usize = 200;

/// Points that still change, and iterations in which they do not become fewer, with which a step of finite
/// displacements is given up: few points that go to and fro do so for ever.
const FEW: usize = 4;

const WITHOUT_GAIN: u32 = 24;

pub(super) fn iterate(
    system: &mut StepSystem,
    start: &State,
    guess: State,
    control: &Control,
    patience: u32,
    mut search: Option<LineSearch>,
) -> Result<(State, u64), StepFailure> {
    if !system.laws.responses.is_empty() {
        search = Some(LineSearch::of_tractions());
    }
    let mut state = guess;
    let factor = if let Control::Factor(target) = control { *target } else { state.factor };
    state.factor = factor;
    let mut motion = std::mem::take(&mut state.motion);
    system.settle(&mut motion, factor);
    state.motion = motion;
    update_blocks(system, &mut state)?;
    let mut gradient = system.gradient(&state);
    state.gap = gradient.gap.clone();
    system.residuals.clear();
    let refused = |why: String| StepFailure::new(why);
    update_tractions(system, start, &mut state).map_err(refused)?;
    // Small displacements round by their own size, which the residual is relative to; a law of
    // tractions from gaps must hold to that.
    let rounding = match (system.finite(), system.laws.responses.is_empty()) {
        (true, _) => 400.0 * f64::EPSILON * system.units().length / system.units().displacement,
        (false, true) => 0.0,
        (false, false) => 400.0 * f64::EPSILON,
    };
    let (mut changed, mut cycling) = (true, Vec::new());
    let (mut least, mut without_gain) = (usize::MAX, 0);
    let (mut fewest, mut budget) = (usize::MAX, patience);
    let (mut unsolved, mut astray) = (0, 0);
    let (mut last_norm, mut whole) = (f64::INFINITY, true);
    // A law that softens converges soon or not at all: shorter steps cost less than long iterations.
    let most = match (system.laws.responses.is_empty(), system.finite() && search.is_none()) {
        (false, _) => 25,
        (true, true) => 60 + (state.gap.len() as u64).min(200),
        (true, false) => 30,
    };
    for iteration in 0..most {
        let mut residual = residual_of(system, start, &state, &gradient);
        let (c, constraint) = control_value(system, start, &state, control);
        let last = residual.len() - 1;
        residual[last] = c;
        let norm = relative_residual(system, &residual, &state).max(block_error(system, &state));
        system.residuals.push(norm);
        if !norm.is_finite() {
            return Err(StepFailure { why: "an iteration left the numbers".into(), cycling });
        }
        // Rounding is what a whole step does not lower.
        let stays = whole && norm > 0.3 * last_norm;
        let settled = norm <= 1e-13 + rounding || (norm <= 1e-9 + 30.0 * rounding && stays);
        // Rounding of positions excuses gaps, not equilibrium.
        let balanced = !system.finite() || unbalanced_share(system, &residual, &state) <= 1e-10;
        if iteration > 0 && !changed && settled && balanced && traction_error(system, &state) <= 1e-9 {
            return Ok((state, iteration));
        }
        last_norm = norm;
        let hessian = system.hessian(&state, &gradient);
        let row = control_row(system, start, &state, control, &constraint, &hessian);
        let right: Vec<f64> = residual.iter().map(|x| -x).collect();
        system.count("newton_iterations", 1);
        let why = "the modes of the contact points leave no equilibrium";
        let Some((step, solved)) = solve_linear(system, &state, &hessian, &row, &right) else {
            return Err(StepFailure { why: why.into(), cycling });
        };
        // Regimes without a solution may be on the way to ones that have one: with small
        // displacements the shifted equations, a soft bedding, show which points close.
        unsolved += u32::from(!solved);
        if unsolved > if system.finite() { 0 } else { 10 } {
            return Err(StepFailure { why: why.into(), cycling });
        }
        // Rotations of an iteration stay where the linearisation means something.
        let share = if system.finite() {
            let points = state.gap.len();
            let turn = (0..system.unknowns.bodies)
                .map(|b| (step[2 * points + 3 * b + 2] * system.units().displacement / system.units().length).abs())
                .fold(0.0, f64::max);
            (0.1 / turn.max(1e-300)).min(1.0)
        } else {
            1.0
        };
        (state, gradient, whole) = match &mut search {
            Some(search) => searched(system, start, (&state, &gradient), control, (&step[..], share), search)?,
            None => {
                let (state, gradient) = advanced(system, start, &state, &step, share)?;
                (state, gradient, true)
            }
        };
        let (wanted, holds) = wanted_modes(system, start, &state);
        let differ: Vec<usize> = (0..wanted.len()).filter(|c| wanted[*c] != state.mode[*c]).collect();
        changed = !differ.is_empty() || !holds;
        let far = differ.len() > ASTRAY && differ.len() / 8 > fewest;
        astray = if far { astray + 1 } else { 0 };
        without_gain = if differ.len() < least { 0 } else { without_gain + 1 };
        least = least.min(differ.len());
        let to_and_fro = system.finite() && changed && least <= FEW && without_gain >= WITHOUT_GAIN;
        if search.is_none() && (astray > 1 || to_and_fro) {
            return Err(StepFailure { why: "the modes of contact points keep changing".into(), cycling: differ });
        }
        if differ.len() < fewest && (patience > 0 || differ.len() <= 1) {
            (fewest, budget) = (differ.len(), patience);
            state.mode = wanted;
        } else if budget > 0 {
            budget -= 1;
            state.mode = wanted;
        } else if let Some(&c) = differ.last() {
            state.mode[c] = wanted[c];
        }
        cycling = differ;
    }
    Err(StepFailure { why: "the modes of contact points keep changing".into(), cycling })
}

/// Greatest relative residual: balance and yielding against forces, gaps against motions.
pub(super) fn relative_residual(system: &StepSystem, residual: &[f64], state: &State) -> f64 {
    let u = system.units();
    let points = state.gap.len();
    let force = state.force.iter().flatten().map(|r| (r / u.force).abs()).fold(1.0, f64::max);
    let whole = largest_unknown(system, state);
    let by_row = |(i, x): (usize, &f64)| {
        let of_forces = if i < 2 * points && system.laws.responses.is(i / 2) {
            traction_row(system, state, i / 2).0[i % 2] > 0.5
        } else if i < 2 * points {
            match state.mode[i / 2] {
                ContactMode::Stick => false,
                ContactMode::Facet(_) => i % 2 == 0,
                ContactMode::Corner(_) => true,
            }
        } else {
            i + 1 < residual.len()
        };
        x.abs() / if of_forces { force } else { whole }
    };
    residual.iter().enumerate().map(by_row).fold(0.0, |worst, x| if x.is_nan() { x } else { worst.max(x) })
}

/// Greatest residual of equilibrium, relative to the greatest force.
fn unbalanced_share(system: &StepSystem, residual: &[f64], state: &State) -> f64 {
    let force = state.force.iter().flatten().map(|r| (r / system.units().force).abs()).fold(0.0, f64::max);
    let rows = &residual[2 * state.gap.len()..residual.len() - 1];
    rows.iter().map(|x| x.abs()).fold(0.0, f64::max) / force.max(1e-6)
}

fn largest_unknown(system: &StepSystem, state: &State) -> f64 {
    let u = system.units();
    let force = state.force.iter().flatten().map(|r| (r / u.force).abs()).fold(1.0, f64::max);
    let motion = state.motion.iter().map(|q| q[0].abs().max(q[1].abs()).max(q[2].abs() * u.length));
    force.max(motion.map(|m| m / u.displacement).fold(0.0, f64::max))
}
