//! Newton's method with the modes of all contact points fixed.
//!
//! The equations of a piece are smooth: without a change of mode Newton's method converges quadratically from a
//! predictor that is near enough. What it finds may violate the inequalities of its modes; [`monitors`](super::monitors)
//! tell.

use super::super::control::Control;
use super::super::control_row::{control_row, control_value};
use super::super::inelastic::block_error;
use super::super::iteration::{
    LinearisedAt, first_state, gap_error, largest_unknown, relative_residual, rotation_bound, rounding,
    unbalanced_share,
};
use super::super::line_search::advanced;
use super::super::linearised::residual_of;
use super::super::nearby::{Accuracy, solve};
use super::super::response::traction_error;
use super::super::state::State;
use super::super::system::StepSystem;

/// Number of iterations after which a shorter step is cheaper.
const MOST: u32 = 12;
/// Relative residual of a state that is found: some hundred times rounding.
const FOUND: f64 = 1e-13;
/// Relative residual that is taken if a whole iteration does not lower it.
const LOWEST: f64 = 1e-9;
/// Share of the last residual above which an iteration has not lowered it.
const STAYS: f64 = 0.3;
/// Greatest residual of equilibrium relative to the forces: a tenth of what certificates allow.
const BALANCED: f64 = 1e-10;

/// The state on the piece that starts at `start`, from a guess with its modes. Returns `None` if the iterations do not
/// converge.
pub(super) fn correct(system: &mut StepSystem, start: &State, guess: State, control: &Control) -> Option<State> {
    let first = first_state(system, start, guess, control);
    let (mut state, mut gradient) = first.map_err(|why| system.failure = Some(why)).ok()?;
    let rounding = rounding(system);
    let mut last = f64::INFINITY;
    let mut whole = true;
    let mut linearised = LinearisedAt::of(system, start);
    for iteration in 0..MOST {
        let mut residual = residual_of(system, start, &state, &gradient);
        *residual.last_mut()? = control_value(system, start, &state, control);
        let norm = relative_residual(system, &residual, &state);
        if !norm.is_finite() {
            return None;
        }
        let stays = whole && norm > STAYS * last;
        let settled = norm <= FOUND + rounding || (norm <= LOWEST + 30.0 * rounding && stays);
        if iteration > 0
            && settled
            && linearised.is_fine(norm, FOUND + rounding)
            && holds(system, &residual, &state, rounding, stays)
        {
            return Some(state);
        }
        let slow = norm > 0.1 * last;
        if slow && iteration > 3 && norm > 0.5 * last {
            return None;
        }
        let equations = linearised.equations(system, &state, slow);
        last = norm;
        let row = control_row(system, control);
        let right: Vec<f64> = residual.iter().map(|x| -x).collect();
        system.count("newton_iterations", 1);
        let (step, solved) = solve(system, &state, &equations, (&row, &right), Accuracy::Rough)?;
        if !solved {
            return None;
        }
        let share = rotation_bound(system, &step);
        whole = share == 1.0 && !linearised.lags();
        let next = advanced(system, start, &state, &step, share);
        (state, gradient) = next.map_err(|why| system.failure = Some(why)).ok()?;
    }
    None
}

/// Returns true if equilibrium and the gaps of a state hold, whatever its modes allow.
fn holds(system: &StepSystem, residual: &[f64], state: &State, rounding: f64, stays: bool) -> bool {
    let (gap, force) = gap_error(system, residual, state);
    unbalanced_share(system, residual, state) <= BALANCED
        && gap <= LOWEST + rounding / largest_unknown(system, state)
        && (stays || force <= LOWEST)
        && traction_error(system, state) <= LOWEST
        && block_error(system, state) <= LOWEST
}
