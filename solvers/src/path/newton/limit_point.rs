//! Whether a limit point is one: no rate with a growing factor leaves it.

use super::limit_point_test::{LimitPointTest, limit_point_test};
use super::state::{State, Tangent};
use super::tracer::Tracer;
use crate::contact::mode::ContactMode;

/// Branches with growing λ that are taken at one factor.
const MOST_BRANCHES: u32 = 3;

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
