//! Whether a step up to the first peak is short enough for the history of slip (finite displacements, flow that is not
//! associated).
//!
//! A step is implicit: what slides at its end has slid by what its gap says, whenever it began. Two things it misses:
//!
//! - a point that comes to rest within the step keeps the slip of its beginning and loses what it slid until then, at
//!   most its speed at the beginning times the step;
//! - a point that begins to slide may have come to rest again before the end: two halves of the step say whether.
//!
//! That is history, which no later step mends: where friction is not associated, all that follows depends on it. Such
//! a step is shortened until what is missed is a force that does not matter.

use super::control::Control;
use super::following::Following;
use super::state::{State, Tangent};
use super::step::solve_step;
use super::system::StepSystem;
use super::tangent::modes_ahead;
use super::tracer::{Tracer, moved_along};
use super::trial::{StepPlan, Trial};
use crate::contact::mode::ContactMode;
use voussoir_core::law::FacetMode;
use voussoir_core::path::Branching;

/// Force that slip missed in a step may leave at a point, relative to the greatest force.
const MISSED: f64 = 1e-7;
/// The same by the slip of a step from which on its halves are looked at.
const MATTERS: f64 = 1e-4;
/// The same by which two halves of a step may differ from the whole.
const APART: f64 = 1e-6;
/// Length, relative to the first step, from which on steps are shortened for this.
const SHORTEST: f64 = 1e-7;

/// Length of the step that is to be tried instead of one that misses slip.
pub(super) fn missed_slip(
    tracer: &mut Tracer,
    following: &mut Following,
    plan: &StepPlan,
    trial: &Trial,
) -> Option<f64> {
    // After a peak friction may let the path cycle in small loops: following them closely leads nowhere.
    let short = following.length <= SHORTEST * following.limits.first;
    let matters = tracer.system.finite() && !tracer.system.joints_flow_associated();
    if !matters || tracer.limit.peak.is_some() || short {
        return None;
    }
    let missed = at_rest(&tracer.system, &tracer.state, (&following.branch.tangent, plan.step), &trial.next) / MISSED;
    if missed > 1.0 {
        tracer.system.count("arrests", 1);
        following.rests = true;
        return Some(following.length * (0.5 / missed).clamp(0.1, 0.5));
    }
    if std::mem::take(&mut following.rests) {
        note_choice(tracer, following, (&following.branch.tangent, plan.step), &trial.next);
    }
    let begins = |c: usize| slides(&tracer.system, &trial.next, c) && !slides(&tracer.system, &tracer.state, c);
    let slip = |c: usize| trial.next.gap[c][1] - tracer.state.slip[c][1];
    let begun: Vec<usize> = (0..trial.next.gap.len()).filter(|c| begins(*c)).collect();
    let most = begun.iter().map(|c| as_force(&tracer.system, &trial.next, *c, slip(*c))).fold(0.0, f64::max);
    if most <= MATTERS {
        return None;
    }
    tracer.system.count("halved_steps", 1);
    let apart = by_halves(tracer, following, plan, trial)? / APART;
    (apart > 1.0).then(|| following.length * (1.0 / apart).sqrt().clamp(0.2, 0.5))
}

/// Names a place where points come to rest though all could go on as they are: with friction that is not associated
/// several branches may start at one state.
fn note_choice(tracer: &mut Tracer, following: &Following, (rate, share): (&Tangent, f64), next: &State) {
    let start = tracer.state.clone();
    let rests = |c: &usize| slides(&tracer.system, &start, *c) && next.mode[*c] == ContactMode::Stick;
    let Some(rests) = (0..next.mode.len()).find(rests) else { return };
    let ahead = moved_along(tracer, rate, share);
    if following.branch.modes.is_some() || modes_ahead(&mut tracer.system, &start, &ahead) != start.mode {
        return;
    }
    let (joint, load_step, factor) = (tracer.system.problem.contacts[rests].joint, tracer.load_step, start.factor);
    tracer.record.branchings.push(Branching { load_step, factor, snaps: false, released: 0.0, twins: false });
    tracer.record.notes.push(format!(
        "at factor {factor} a point of joint {joint} comes to rest that could slide on: friction that is not associated leaves more than one branch"
    ));
}

/// Whether a point slides on one facet.
fn slides(system: &StepSystem, state: &State, c: usize) -> bool {
    match (state.mode[c], system.law(c)) {
        (ContactMode::Facet(i), Some(law)) => law.facets[i as usize].mode == FacetMode::Sliding,
        _ => false,
    }
}

/// A slip by the force that it would release at its point, relative to the greatest force.
fn as_force(system: &StepSystem, state: &State, c: usize, slip: f64) -> f64 {
    let largest = state.force.iter().flatten().fold(system.units().force, |a: f64, r| a.max(r.abs()));
    (slip * system.stiffness(c)[1]).abs() / largest
}

/// Greatest slip, as a force, that points lose which come to rest, or turn, in a step with a share of a rate for its
/// predictor.
fn at_rest(system: &StepSystem, start: &State, (rate, share): (&Tangent, f64), next: &State) -> f64 {
    let of_point = |c: usize| {
        let Some(law) = system.law(c) else { return 0.0 };
        let turns = match (start.mode[c], next.mode[c]) {
            (ContactMode::Stick, _) => false,
            (_, ContactMode::Stick) => true,
            (ContactMode::Facet(i), ContactMode::Facet(j)) => {
                law.facets[i as usize].flow[1] * law.facets[j as usize].flow[1] < 0.0
            }
            _ => false,
        };
        if turns { as_force(system, next, c, share * rate.gap[c][1]) } else { 0.0 }
    };
    (0..next.gap.len()).map(of_point).fold(0.0, f64::max)
}

/// How far, as a force, slip at the end of a step differs from that of two halves. `None` where they are not found.
fn by_halves(tracer: &mut Tracer, following: &Following, plan: &StepPlan, trial: &Trial) -> Option<f64> {
    let start = tracer.state.clone();
    let half = match &trial.control {
        Control::Strategy { strategy, previous, length } => {
            Control::Strategy { strategy: strategy.clone(), previous: *previous, length: 0.5 * length }
        }
        _ => Control::Factor(0.5 * (start.factor + trial.next.factor)),
    };
    let guess = moved_along(tracer, &following.branch.tangent, 0.5 * plan.step);
    let (mut middle, _) = solve_step(&mut tracer.system, &start, guess, &half).ok()?;
    tracer.system.keep(&start, &mut middle);
    let control = Control::Factor(trial.next.factor);
    let (end, _) = solve_step(&mut tracer.system, &middle, trial.next.clone(), &control).ok()?;
    let apart = |c: usize| as_force(&tracer.system, &end, c, end.gap[c][1] - trial.next.gap[c][1]);
    Some((0..end.gap.len()).filter(|c| slides(&tracer.system, &trial.next, *c)).map(apart).fold(0.0, f64::max))
}
