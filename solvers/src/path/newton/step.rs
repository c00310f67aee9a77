//! A step: Newton's method, then a line search, then the homotopy.

use super::control::Control;
use super::homotopy::by_homotopy;
use super::iteration::iterate;
use super::line_search::NOTHING;
use super::state::State;
use super::system::{StepFailure, StepSystem};
use crate::optimise::line_search::LineSearch;

/// Newton's method from a guess. Modes change all at once as long as their number falls, else
/// one by one (block principal pivoting with its fallback: Júdice & Pires 1994, Computers & Ops.
/// Res. 21), so that modes that flip for ever are seen. Where that fails, by a line search, then
/// with one change at a time from the beginning; with small displacements and a given factor by
/// pivoting, with associated flow by the caller's (a line search finds nothing there that it does not).
pub(super) fn solve_step(
    system: &mut StepSystem,
    start: &State,
    guess: State,
    control: &Control,
) -> Result<(State, u64), StepFailure> {
    let found = iterate(system, start, guess.clone(), control, 8, None);
    if found.is_ok() || (!system.laws.responses.is_empty() && system.laws.polygons.is_empty()) {
        return found;
    }
    if system.finite() || !system.piecewise_linear() {
        if system.rules.line_search
            && let Ok(found) = line_searched(system, start, guess.clone(), control)
        {
            return Ok(found);
        }
        return iterate(system, start, guess, control, 0, None);
    }
    // Where flow is not associated pivoting may step over a limit point: from nothing only.
    match control {
        Control::Factor(factor) if system.monotone() || start.force.iter().flatten().all(|r| *r == 0.0) => {
            by_homotopy(system, start, &State { factor: *factor, ..guess }, control)
        }
        _ if system.rules.line_search && !system.monotone() => line_searched(system, start, guess, control).or(found),
        _ => found,
    }
}

/// Newton's method with all modes changed at once and a line search.
pub(super) fn line_searched(
    system: &mut StepSystem,
    start: &State,
    guess: State,
    control: &Control,
) -> Result<(State, u64), StepFailure> {
    let found = iterate(
        system,
        start,
        guess,
        control,
        u32::MAX,
        Some(LineSearch { nothing: NOTHING, ..LineSearch::of_pieces() }),
    );
    system.count("line_searched_steps", u64::from(found.is_ok()));
    found
}
