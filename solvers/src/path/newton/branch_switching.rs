//! Branch switching: where a path leads from a state at which no step converges.
//!
//! There some contact points are active. The modes that the last rate asks for are one
//! candidate; it is a solution of the rate problem only if it asks for the same modes itself (a point
//! that slides goes on sliding in its sense, one that opens opens). Where it is not, the linear
//! complementarity problem of the rates ([`limit_point_test`](super::limit_point_test)) is searched to its end for a rate on
//! which λ goes on in its sense. If there is none the path folds: what is left is to unload, which friction
//! always allows. Other points may then slide, and the path goes on at another place; if it comes back to
//! the same fold it ends there.

use super::control::Control;
use super::following::Following;
use super::inelastic::{plastic_power, update_blocks};
use super::limit_point_test::{LimitPointTest, all_rates, limit_point_test};
use super::measure::{cosine, motion_size};
use super::orientation::Orientation;
use super::state::{State, Tangent};
use super::tangent::{modes_ahead, tangent_at, tangent_of_yielding};
use super::tracer::{Tracer, moved_along};
use crate::contact::mode::ContactMode;

/// A rate with the modes on which it starts.
type Start = (Tangent, Vec<ContactMode>);

/// Cosine of the angle to the arriving rate below which another one is the way back.
const BACK: f64 = -1.0 + 1e-6;

/// Shares of the motion of a first step ahead at which a rate is asked for its modes.
const AHEAD: [f64; 5] = [1e-5, 1e-4, 1e-3, 1e-2, 1e-1];

/// Shares of a first step ahead at which the arriving rate is asked for other modes: a first step may be long for events
/// that lie close together.
const BEYOND: [f64; 3] = [1e-3, 1e-5, 1e-7];

/// The rates on which the points at their limit yield, where a small share of `rate` asks for that, the longest share first.
fn yielding_branches(tracer: &mut Tracer, rate: &Tangent, share: f64) -> Vec<Start> {
    let state = tracer.state.clone();
    let mut all: Vec<Vec<ContactMode>> = vec![state.mode.clone()];
    for beyond in BEYOND {
        let ahead = moved_along(tracer, rate, beyond * share);
        let modes = modes_ahead(&mut tracer.system, &state, &ahead);
        if !all.contains(&modes) {
            all.push(modes);
        }
    }
    let rate = |modes: Vec<ContactMode>| Some((tangent_of_yielding(&mut tracer.system, &state, &modes)?, modes));
    all.into_iter().skip(1).filter_map(rate).collect()
}

/// The rate on which blocks yield that a small share of `rate` takes beyond their strength, in the sense
/// in which they dissipate. Their next predictor is that of the yielding tangent.
pub(super) fn yielding_blocks_branch(tracer: &mut Tracer, rate: &Tangent, share: f64) -> Option<Tangent> {
    let mut ahead = moved_along(tracer, rate, share);
    update_blocks(&mut tracer.system, &mut ahead).ok()?;
    let mut turning = tracer.state.clone();
    turning.blocks = ahead.blocks;
    if !turning.yields() {
        return None;
    }
    let other = tangent_at(&mut tracer.system, &tracer.state, &turning, &Control::Factor(tracer.state.factor))?;
    let power = plastic_power(&tracer.system, &turning, &other);
    tracer.state.blocks = turning.blocks;
    Some(other.scaled(if power < 0.0 { -1.0 } else { 1.0 }))
}

/// Whether the motions of two rates make an acute angle.
fn forwards(rate: &Tangent, other: &Tangent) -> bool {
    cosine(&rate.motion, &other.motion) > 0.0
}

/// The rate that leads on where that of `following` does not, with its modes, if one was found; an error says why
/// none does.
pub(super) fn branch_beyond_fold(
    tracer: &mut Tracer,
    following: &Following,
    share: f64,
) -> Result<Option<Start>, String> {
    let rate = &following.branch.tangent;
    let all = yielding_branches(tracer, rate, share);
    let own = all.first().cloned();
    // Other rates have other sizes: as far as this one moves.
    let reach = share * motion_size(&tracer.system, rate);
    if !tracer.system.rules.oriented || !tracer.system.piecewise_linear() {
        return Ok(own);
    }
    for (other, modes) in &all {
        if agrees(tracer, other, modes, reach) && continues(tracer, following, other, modes) {
            return Ok(Some((other.clone(), modes.clone())));
        }
    }
    // A point that is about to close is open still: with the modes beyond the fold it counts among those that may turn.
    let here = tracer.state.mode.clone();
    let beyond = all.iter().map(|(_, modes)| modes.clone());
    let mut starting = StartingRates::new(std::iter::once(here).chain(beyond));
    for leads_on in [is_onward as Onward, closes] {
        if let Some(found) = starting.only(tracer, following, leads_on, reach) {
            tracer.system.count("branches", 1);
            return Ok(Some(found));
        }
    }
    for (other, modes) in &all {
        if continues(tracer, following, other, modes) {
            continue;
        }
        // At a sharp fold the modes beyond it are right and the sense is not: that of the factor tells it.
        let reversed = other.scaled(-1.0);
        if agrees(tracer, &reversed, modes, reach) && continues(tracer, following, &reversed, modes) {
            tracer.system.count("sharp_folds", 1);
            return Ok(Some((reversed, modes.clone())));
        }
    }
    if let Some(found) = starting.only(tracer, following, opens, reach) {
        tracer.system.count("branches", 1);
        return Ok(Some(found));
    }
    let state = tracer.state.clone();
    match limit_point_test(&mut tracer.system, &state, rate.factor.signum()) {
        // Where the load falls anyway, unloading is a rate of the same sense: one of several, and none that is wanted.
        LimitPointTest::Tangent(other, modes)
            if modes != state.mode && forwards(rate, &other) && agrees(tracer, &other, &modes, reach) =>
        {
            tracer.system.count("branches", 1);
            Ok(Some((other, modes)))
        }
        LimitPointTest::Tangent(..) | LimitPointTest::Unknown(_) => Ok(own),
        LimitPointTest::None
            if !tracer.post_peak.cycles.folds_again([tracer.record.state.displacement, state.factor]) =>
        {
            Ok(own)
        }
        LimitPointTest::None => {
            let sense = if rate.factor > 0.0 { "growing" } else { "falling" };
            Err(format!(
                "at factor {} no rate of equilibrium goes on with a {sense} factor: all modes of the active contact points are excluded; unloading from there has come back to this place",
                state.factor
            ))
        }
    }
}

/// Whether points yield in some modes, other than by opening.
fn dissipates(tracer: &Tracer, modes: &[ContactMode]) -> bool {
    let yields = |(c, mode): (usize, &ContactMode)| {
        *mode != ContactMode::Stick && tracer.system.law(c).is_some_and(|law| !law.opens(*mode))
    };
    modes.iter().enumerate().any(yields)
}

/// Whether a rate is elastic unloading of a state that was arrived at with points sliding: nothing slides on it, and it
/// leads against the arriving motion. That is a solution from any such state, and no branch that goes on.
fn unloads(tracer: &Tracer, following: &Following, rate: &Tangent, modes: &[ContactMode]) -> bool {
    dissipates(tracer, &tracer.state.mode) && !dissipates(tracer, modes) && !forwards(&following.branch.tangent, rate)
}

/// Whether a rate with its modes goes on along the branch on which the path has arrived, and is no elastic unloading.
fn continues(tracer: &mut Tracer, following: &Following, rate: &Tangent, modes: &[ContactMode]) -> bool {
    !unloads(tracer, following, rate, modes) && keeps_orientation(tracer, following, rate, modes)
}

/// Whether a rate with its modes goes on along the branch on which the path has arrived, by their second-order work:
/// the way back does not.
fn keeps_orientation(tracer: &mut Tracer, following: &Following, rate: &Tangent, modes: &[ContactMode]) -> bool {
    let Some(before) = &following.orientation else { return true };
    let turned = State { mode: modes.to_vec(), ..tracer.state.clone() };
    let after = Orientation::along(&mut tracer.system, &turned, rate, following.direction);
    after.is_none_or(|after| before.is_singular() || after.is_singular() || before.leads_over_kink_to(&after))
}

/// Whether a rate goes on along the branch, and is not the way back.
fn is_onward(tracer: &mut Tracer, following: &Following, rate: &Tangent, modes: &[ContactMode]) -> bool {
    cosine(&following.branch.tangent.motion, &rate.motion) > BACK && continues(tracer, following, rate, modes)
}

/// Whether on a rate that goes on along the branch a joint closes that was open, and with it all that slides comes to
/// rest: no elastic unloading of the state, which would open it.
fn closes(tracer: &mut Tracer, following: &Following, rate: &Tangent, modes: &[ContactMode]) -> bool {
    changes_contact(tracer, following, (rate, modes), false)
}

/// The same where a point opens that was closed: the way back leaves it closed.
fn opens(tracer: &mut Tracer, following: &Following, rate: &Tangent, modes: &[ContactMode]) -> bool {
    changes_contact(tracer, following, (rate, modes), true)
}

/// Whether a rate that goes on along the branch opens a point that is closed, or closes one that is open.
fn changes_contact(
    tracer: &mut Tracer,
    following: &Following,
    (rate, modes): (&Tangent, &[ContactMode]),
    opens: bool,
) -> bool {
    let open = |c: usize, mode: ContactMode| tracer.system.law(c).is_some_and(|law| law.opens(mode));
    let mut pairs = tracer.state.mode.iter().zip(modes).enumerate();
    pairs.any(|(c, (before, after))| open(c, *before) != opens && open(c, *after) == opens)
        && cosine(&following.branch.tangent.motion, &rate.motion) > BACK
        && keeps_orientation(tracer, following, rate, modes)
}

/// Which rates may lead on.
type Onward = fn(&mut Tracer, &Following, &Tangent, &[ContactMode]) -> bool;

/// All rates that start at the present state, each set of modes that are looked at enumerated once, when it is asked for.
struct StartingRates(Vec<(Vec<ContactMode>, Option<Vec<Start>>)>);

impl StartingRates {
    fn new(modes: impl Iterator<Item = Vec<ContactMode>>) -> Self {
        StartingRates(modes.map(|modes| (modes, None)).collect())
    }

    /// The one rate, in the first of these modes or those of points that may leave them, that leads on; `None` where there
    /// are several, or none was found.
    fn only(&mut self, tracer: &mut Tracer, following: &Following, leads_on: Onward, reach: f64) -> Option<Start> {
        following.orientation.as_ref().filter(|before| !before.is_singular())?;
        self.0.iter_mut().find_map(|(modes, rates)| {
            let rates = rates.get_or_insert_with(|| {
                let state = State { mode: modes.clone(), ..tracer.state.clone() };
                all_rates(&mut tracer.system, &state).unwrap_or_default()
            });
            let mut onward = rates.iter().filter(|(other, modes)| {
                // The arriving rate itself has failed: it may look as if it led on for less than is left to the fold.
                let arriving =
                    *modes == tracer.state.mode && cosine(&following.branch.tangent.motion, &other.motion) > -BACK;
                !arriving && leads_on(tracer, following, other, modes) && agrees(tracer, other, modes, reach)
            });
            let found = onward.next()?.clone();
            onward.next().is_none().then_some(found)
        })
    }
}

/// Whether a rate asks for the modes that it was computed with. The nearest state to a fold lies before it by what the
/// iterations leave, so that near by a joint that is to close may be open still: a longer way along the rate tells.
fn agrees(tracer: &mut Tracer, rate: &Tangent, modes: &[ContactMode], reach: f64) -> bool {
    let state = tracer.state.clone();
    let size = motion_size(&tracer.system, rate).max(1e-300);
    AHEAD.iter().any(|ahead| {
        let mut ahead = moved_along(tracer, rate, ahead * reach / size);
        ahead.mode = modes.to_vec();
        modes_ahead(&mut tracer.system, &state, &ahead) == modes
    })
}
