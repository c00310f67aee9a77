//! A step: Newton's method with all modes changed at once, then with one change of mode at a time.

use super::iteration::iterate;
use crate::path::newton::model::control::Control;
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;

/// Solves a step by Newton's method from a guess. All modes change at once while their number decreases, otherwise one
/// by one, which detects modes that change without end (block principal pivoting with its fallback: Júdice & Pires
/// 1994, Computers & Ops. Res. 21). If that fails, it uses one change at a time from the start.
pub fn solve_step(
    system: &mut StepSystem,
    start: &State,
    guess: State,
    control: &Control,
) -> Result<(State, u64), String> {
    let found = iterate(system, start, guess.clone(), control, 8);
    if found.is_ok() || (!system.laws.responses.is_empty() && system.laws.polygons.is_empty()) {
        return found;
    }
    iterate(system, start, guess, control, 0)
}
