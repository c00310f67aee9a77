//! A step that is tried: its predictor, its control, Newton's method and what it falls back on, and whether
//! what has converged lies along the path.

use super::control::Control;
use super::following::{Following, per_tangent};
use super::inelastic::plastic_work;
use super::measure::{increment_along, tangent_size};
use super::softening::softening_step;
use super::state::{State, Tangent};
use super::step::solve_step;
use super::system::StepFailure;
use super::tangent::tangent_at;
use super::tracer::{Tracer, moved_along};
use crate::contact::facet::{dot, slack};
use crate::contact::mode::ContactMode;
use voussoir_core::path::LoadStepEnd;

/// Length, relative to the first step, below which every means is taken.
const LAST: f64 = 1e-8;

/// Least length, relative to the first step, of one that goes to where a point slides first.
const PAST_SLIP: f64 = 1e-6;

/// A step to be tried.
#[derive(Clone, Copy)]
pub(super) struct StepPlan {
    /// What the strategy measures along the tangent.
    pub per_tangent: f64,
    /// Share of the tangent that the step takes, by the strategy.
    pub share: f64,
    /// The same with the last step shortened to the target.
    pub step: f64,
    /// Whether it goes to the target.
    pub reaches: bool,
}

/// A step that converged.
pub(super) struct Trial {
    pub next: State,
    pub iterations: u64,
    pub control: Control,
    pub reaches: bool,
}

/// The next step by the strategy and its bounds; `None` where what the strategy measures no longer grows.
pub(super) fn plan(tracer: &mut Tracer, following: &mut Following) -> Option<StepPlan> {
    let tangent = &following.branch.tangent;
    let per_tangent = per_tangent(tracer, tangent, following.previous.as_ref());
    if per_tangent.is_nan() || per_tangent <= 0.0 {
        return None;
    }
    let mut share = following.length / per_tangent;
    let moves = increment_along(&tracer.system, &tracer.state, tangent).motion * share;
    if moves > following.limits.largest {
        share *= following.limits.largest / moves;
        following.length = share * per_tangent;
    }
    if matches!(following.load_step.end, LoadStepEnd::Factor(_)) && tangent.factor != 0.0 {
        let most = (following.target - following.load_step.start).abs() / 16.0 / tangent.factor.abs();
        if share > most {
            share = most;
            following.length = share * per_tangent;
        }
    }
    if !tracer.strategy.passes_limit_points()
        && let Some(slip) = first_slip(tracer, tangent).filter(|slip| *slip < share)
    {
        // A point that is at its limit already must not shorten the steps without end.
        share = slip.max(PAST_SLIP * following.limits.first / per_tangent).min(share) * (1.0 + 1e-9);
        following.length = share * per_tangent;
    }
    let (from, target) = (tracer.state.factor, following.target);
    let reaches =
        (from + tangent.factor * share - target) * following.direction >= -1e-12 * tracer.system.units().factor;
    let step = if reaches { (target - from) / tangent.factor } else { share };
    Some(StepPlan { per_tangent, share, step, reaches })
}

/// Tries a step: by its control, by the factor, by gaps that soften.
pub(super) fn attempt(tracer: &mut Tracer, following: &Following, plan: &StepPlan) -> Result<Trial, StepFailure> {
    let (tangent, modes, reaches) = (&following.branch.tangent, &following.branch.modes, plan.reaches);
    let mut guess = moved_along(tracer, tangent, plan.step);
    if let Some(modes) = modes {
        guess.mode = modes.clone();
    }
    let control = if reaches {
        Control::Factor(following.target)
    } else {
        let strategy = tracer.strategy.clone();
        Control::Strategy { strategy, previous: following.previous, length: following.length }
    };
    let found = solve_step(&mut tracer.system, &tracer.state, guess.clone(), &control);
    let found = found.and_then(|(next, iterations)| {
        let back = following.tried.leads_back(&tracer.state, &next);
        if back || (modes.is_some() && next.mode == tracer.state.mode) {
            return Err(StepFailure::new("the step went back the way it came"));
        }
        judge(tracer, following, plan.step, &next, reaches)?;
        Ok((next, iterations))
    });
    let failure = match found {
        Ok((next, iterations)) => return Ok(Trial { next, iterations, control, reaches }),
        Err(failure) => failure,
    };
    // A step by arc length may go back; one by λ cannot.
    let last = tracer.strategy.passes_limit_points() && following.length < LAST * following.limits.first;
    if !reaches && tangent.factor * following.direction > 0.0 && (modes.is_some() || last) {
        let control = Control::Factor(guess.factor);
        if let Ok((next, iterations)) = solve_step(&mut tracer.system, &tracer.state, guess, &control)
            && judge(tracer, following, plan.step, &next, false).is_ok()
        {
            return Ok(Trial { next, iterations, control, reaches });
        }
    }
    let (next, iterations, local) =
        softening_step(tracer, tangent, plan.step, following.target, following.direction).ok_or(failure)?;
    Ok(Trial { next, iterations, control: local.control(plan.step), reaches: false })
}

/// Share of the rate after which the first stuck point whose slip is not associated would slide.
pub(super) fn first_slip(tracer: &Tracer, rate: &Tangent) -> Option<f64> {
    let mut first = f64::INFINITY;
    for c in 0..tracer.state.gap.len() {
        let (ContactMode::Stick, Some(law)) = (tracer.state.mode[c], tracer.system.law(c)) else { continue };
        for f in law.facets.iter().filter(|f| f.flow != f.normal) {
            let (r, dr) = (tracer.state.force[c], rate.force[c]);
            let speed = dot(f.normal, dr);
            if speed > 0.0 {
                first = first.min(slack(f, r, tracer.system.problem.contacts[c].area).max(0.0) / speed);
            }
        }
    }
    first.is_finite().then_some(first)
}

/// Whether a converged step is one along the path.
fn judge(
    tracer: &mut Tracer,
    following: &Following,
    share: f64,
    next: &State,
    reaches: bool,
) -> Result<(), StepFailure> {
    let (rate, target, direction) = (&following.branch.tangent, following.target, following.direction);
    let no = |why: &str| Err(StepFailure::new(why));
    if !reaches && (next.factor - target) * direction > 0.0 {
        return no("the step went beyond the factor asked for");
    }
    let u = tracer.system.units();
    let (mut along, mut size) = (0.0, 0.0);
    let mut force_jump = 0.0;
    for c in 0..next.gap.len() {
        for k in 0..2 {
            let moved = (next.gap[c][k] - tracer.state.gap[c][k]) / u.displacement;
            along += moved * rate.gap[c][k] / u.displacement;
            size += moved * moved;
            force_jump += ((next.force[c][k] - tracer.state.force[c][k]) / u.force).powi(2);
        }
    }
    for b in 0..next.motion.len() {
        for k in 0..3 {
            let unit = if k == 2 { u.displacement / u.length } else { u.displacement };
            let moved = (next.motion[b][k] - tracer.state.motion[b][k]) / unit;
            along += moved * rate.motion[b][k] / unit;
            size += moved * moved;
        }
    }
    along += (next.factor - tracer.state.factor) * rate.factor / (u.factor * u.factor);
    // Where a block softens the path may snap back sharply: what dissipates does not go back.
    if along <= 0.0 && plastic_work(&tracer.system, &tracer.state, next) <= 1e-9 * size {
        return no("the step turned back");
    }
    // Friction that is not associated: several states may belong to one load. A state far from
    // what both ends' rates can reach is another branch.
    let slides = (0..next.mode.len()).any(|c| {
        next.mode[c] != tracer.state.mode[c] && tracer.system.law(c).is_some_and(|law| law.is_non_associated())
    });
    if slides && !tracer.strategy.passes_limit_points() {
        let after = tangent_at(&mut tracer.system, &tracer.state, next, &Control::Factor(next.factor));
        let Some(after) = after else { return no("the state has no rate under growing load") };
        let before = tangent_size(&tracer.system, rate) * share;
        let after = tangent_size(&tracer.system, &after) * (next.factor - tracer.state.factor).abs() / u.factor;
        let jump = (size + force_jump).sqrt();
        if jump > 2.0 * (before + after) {
            return no("the state jumps to another branch");
        }
    }
    Ok(())
}
