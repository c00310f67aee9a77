//! A step: Newton's method, then a line search, then one change of mode at a time.

use super::iteration::iterate;
use crate::optimise::line_search::LineSearch;
use crate::path::newton::model::control::Control;
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use crate::settings::SETTINGS;

/// Solves a step by Newton's method from a guess. All modes change at once while their number decreases, otherwise one
/// by one, which detects modes that change without end (block principal pivoting with its fallback: Júdice & Pires
/// 1994, Computers & Ops. Res. 21). If that fails, it uses a line search, then one change at a time from the start.
pub fn solve_step(
    system: &mut StepSystem,
    start: &State,
    guess: State,
    control: &Control,
) -> Result<(State, u64), String> {
    let found = iterate(system, start, guess.clone(), control, 8, None);
    if found.is_ok() || (!system.laws.responses.is_empty() && system.laws.polygons.is_empty()) {
        return found;
    }
    if let Ok(found) = line_searched(system, start, guess.clone(), control) {
        return Ok(found);
    }
    iterate(system, start, guess, control, 0, None)
}

/// Newton's method with all modes changed at once and a line search.
pub fn line_searched(
    system: &mut StepSystem,
    start: &State,
    guess: State,
    control: &Control,
) -> Result<(State, u64), String> {
    let found = iterate(
        system,
        start,
        guess,
        control,
        u32::MAX,
        Some(LineSearch { nothing: SETTINGS.admissible, ..LineSearch::of_pieces() }),
    );
    system.count("line_searched_steps", u64::from(found.is_ok()));
    found
}
