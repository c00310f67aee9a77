//! Newton's method with the modes of all contact points fixed.
//!
//! The equations of a piece are smooth: without a change of mode Newton's method converges quadratically from a
//! predictor that is near enough. The result may violate the inequalities of its modes; [`monitors`](super::monitors)
//! check them.

use crate::path::newton::model::control::Control;
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::control_row::{control_row, control_value};
use crate::path::newton::quantities::inelastic::block_error;
use crate::path::newton::quantities::response::traction_error;
use crate::path::newton::solve::iteration::{
    LinearisedAt, advanced, first_state, gap_error, largest_unknown, relative_residual, rotation_bound,
    unbalanced_share,
};
use crate::path::newton::solve::linearised::residual_of;
use crate::path::newton::solve::nearby::{Accuracy, solve};
use crate::settings::SETTINGS;

/// Number of iterations after which a shorter step is cheaper.
const MAX_ITERATIONS: u32 = 12;

/// Computes the state on the piece that starts at `start`, from a guess with its modes. `None` without convergence.
pub(super) fn correct(system: &mut StepSystem, start: &State, guess: State, control: &Control) -> Option<State> {
    let first = first_state(system, start, guess, control);
    let (mut state, mut gradient) = first.map_err(|why| system.report.failure = Some(why)).ok()?;
    let rounding = system.limits.rounding;
    let mut last = f64::INFINITY;
    let mut whole = true;
    let mut linearised = LinearisedAt::of(start, system.limits.nearby);
    for iteration in 0..MAX_ITERATIONS {
        let mut residual = residual_of(system, start, &state, &gradient);
        *residual.last_mut()? = control_value(system, start, &state, control);
        let norm = relative_residual(system, &residual, &state);
        if !norm.is_finite() {
            return None;
        }
        let stays = whole && norm > SETTINGS.stays * last;
        let settled = norm <= system.found() + rounding || (norm <= SETTINGS.admissible + 30.0 * rounding && stays);
        if iteration > 0
            && settled
            && linearised.is_fine(norm, system.found() + rounding)
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
        let row = control_row(system, control, &equations);
        let right: Vec<f64> = residual.iter().map(|x| -x).collect();
        system.count("newton_iterations", 1);
        system.report.iterations += 1;
        let (step, solved) = solve(system, &state, &equations, (&row, &right), Accuracy::Rough)?;
        if !solved {
            return None;
        }
        let share = rotation_bound(system, &step);
        whole = share == 1.0 && !linearised.lags();
        let next = advanced(system, start, &state, &step, share);
        (state, gradient) = next.map_err(|why| system.report.failure = Some(why)).ok()?;
    }
    None
}

/// Returns true if equilibrium and the gaps of a state hold, whatever its modes allow.
fn holds(system: &StepSystem, residual: &[f64], state: &State, rounding: f64, stays: bool) -> bool {
    let (gap, force) = gap_error(system, residual, state);
    unbalanced_share(system, residual, state) <= SETTINGS.inequality()
        && gap <= SETTINGS.admissible + rounding / largest_unknown(system, state)
        && (stays || force <= SETTINGS.admissible)
        && traction_error(system, state) <= SETTINGS.admissible
        && block_error(system, state) <= SETTINGS.admissible
}
