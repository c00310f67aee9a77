//! Whether a limit point is one: no rate with a growing factor leaves it.

use super::control::Control;
use super::limit_point_test::{LimitPointTest, limit_point_test};
use super::measure::{increment_along, increment_between, motion_size};
use super::state::{State, Tangent};
use super::step::solve_step;
use super::tracer::{Tracer, moved};
use crate::contact::mode::ContactMode;

/// Branches with growing λ that are taken at one factor.
const MOST_BRANCHES: u32 = 3;

/// Motions, in units, of the steps that are tried along a rate.
const SHARES: [f64; 3] = [1e-1, 1e-3, 1e-5];

/// Motion of a step that follows a rate, by what the rate says.
const FOLLOWS: f64 = 3.0;

/// Looks for a rate with growing λ where there should be none. Where that
/// is not decided, or not gone on with, the limit point is not proven. Where blocks flow, combinations
/// of modes say nothing of their Gauss points: there the path itself shows its limit point.
pub(super) fn test_limit_point(
    tracer: &mut Tracer,
    state: &State,
    direction: f64,
) -> Option<(Tangent, Vec<ContactMode>)> {
    if !tracer.system.laws.responses.is_empty() || state.yields() {
        return None;
    }
    match limit_point_test(&mut tracer.system, state, direction) {
        LimitPointTest::None => {
            tracer.limit.unproven = None;
            tracer.limit.proven = Some(state.factor);
        }
        LimitPointTest::Unknown(why) => tracer.limit.unproven = Some(why),
        LimitPointTest::Tangent(rate, modes) => {
            tracer.limit.unproven = Some("there is a rate on which the load grows".into());
            return Some((rate, modes));
        }
    }
    None
}

/// A branch with growing λ, where there should be none; a few times at most at one factor. Otherwise
/// the limit point is proven, or not decided.
pub(super) fn rising_branch(tracer: &mut Tracer, state: &State, direction: f64) -> Option<(Tangent, Vec<ContactMode>)> {
    let other = test_limit_point(tracer, state, direction)?;
    if tracer.system.finite() && !goes_on(tracer, state, &other, direction) {
        // A rate that no step follows: points that carry next to nothing admit many.
        tracer.limit.unproven = None;
        return None;
    }
    let same = |factor: f64| (state.factor - factor) * direction <= 1e-10 * factor.abs();
    let times = match tracer.limit.rose {
        Some((factor, times)) if same(factor) => times + 1,
        _ => 1,
    };
    if times > MOST_BRANCHES {
        return None;
    }
    tracer.limit.rose = Some((state.factor, times));
    tracer.limit.unproven = None;
    tracer.system.count("branches", 1);
    Some(other)
}

/// Whether some step, however short, follows a rate with growing λ from a state.
fn goes_on(tracer: &mut Tracer, state: &State, (rate, modes): &(Tangent, Vec<ContactMode>), direction: f64) -> bool {
    let before = tracer.state.clone();
    let mut start = state.clone();
    tracer.system.keep(&before, &mut start);
    let size = motion_size(&tracer.system, rate).max(1e-300);
    SHARES.into_iter().any(|share| {
        let share = share / size;
        let mut guess = moved(&start, rate, share);
        guess.mode = modes.clone();
        let control = Control::Factor(guess.factor);
        let Ok((next, _)) = solve_step(&mut tracer.system, &start, guess, &control) else { return false };
        let moved = increment_between(&tracer.system, &start, &next);
        let told = increment_along(&tracer.system, &start, rate).motion * share;
        moved.factor * direction > 0.0 && moved.motion <= FOLLOWS * told
    })
}
