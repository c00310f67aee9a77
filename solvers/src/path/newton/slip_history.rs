//! Whether a step is short enough for the history of slip (finite displacements, flow that is not associated).
//!
//! A step is implicit: what slides at its end has slid by what its gap says, whenever it began. While a point slides to
//! one side that is exact. Two things it misses:
//!
//! - a point that comes to rest within the step keeps the slip of its beginning and loses what it slid until then, at
//!   most its speed at the beginning times the step;
//! - a point that still slides at the end, but backwards at the rate there, has slid further in between. With speeds v₀
//!   and −v₁ at the ends it turned at the share v₀/(v₀ + v₁) of the step and loses ½ v₁²/(v₀ + v₁) of it.
//!
//! That is history, which no later step mends: where friction is not associated, all that follows depends on it. So
//! steps end where points come to rest. The place is found between states that are taken and one known to lie beyond
//! it: by the speeds at both ends where slip comes to rest smoothly, and where another point's event stops it, by the
//! predictor's share up to that event. Beyond it the steps are as long again as before.

use super::control::Control;
use super::following::{Arrest, Following};
use super::state::{State, Tangent};
use super::system::StepSystem;
use super::tangent::{modes_ahead, rough_tangent};
use super::tracer::{Tracer, moved_along};
use super::trial::{StepPlan, Trial};
use crate::contact::facet::slack;
use crate::contact::mode::ContactMode;
use voussoir_core::law::{Facet, FacetMode};
use voussoir_core::path::{Branching, LoadStepEnd};

/// Steps that are shortened, in all, beyond which none is after a peak.
const MOST_ARRESTS: u64 = 500;
/// What counts that they are used up.
const ENDED: &str = "arrests_ended";
/// Force that slip missed in a step may leave at a point, relative to the greatest force; and while blocks yield, whose
/// stresses follow the path of strain to first order in the step anyhow.
const MISSED: [f64; 2] = [1e-7, 1e-5];
/// What counts as far beyond it.
const PLAINLY: f64 = 10.0;
/// Length, relative to the first step, from which on steps are shortened for this.
const SHORTEST: f64 = 1e-7;
/// Shares of a step that misses slip within which the next one lies, and the one where nothing is known of the place.
const SHARES: [f64; 2] = [0.03, 0.97];
const UNKNOWN: f64 = 0.4;
/// Greatest such share after a step that was to end before the place and did not.
const AGAIN: f64 = 0.7;
/// How far before another point's event a step ends, as a share of it.
const BEFORE: f64 = 1e-4;

/// What a step misses of the slip of a point.
struct Missed {
    /// As a force, relative to the greatest.
    force: f64,
    /// Share of the step at which the point turned, if that is known.
    place: Option<f64>,
}

/// Length of the step that is to be tried instead of one that misses slip far beyond what it may, by a rate at its end that
/// costs no factorisation.
pub(super) fn plainly_missed_slip(
    tracer: &mut Tracer,
    following: &mut Following,
    plan: &StepPlan,
    trial: &Trial,
) -> Option<f64> {
    let short = following.length <= SHORTEST * following.limits.first;
    if short || is_enough(tracer, following) || !matches!(trial.control, Control::Strategy { .. }) {
        return None;
    }
    let Tracer { system, state, .. } = tracer;
    if !matters(system) || !system.solves_nearby() {
        return None;
    }
    let end = rough_tangent(system, state, (state, &trial.next), &trial.control)?;
    let worst = all_missed(tracer, following, plan, trial, &end).iter().fold(0.0, |a: f64, missed| a.max(missed.force));
    (worst > PLAINLY * MISSED[0]).then(|| missed_slip(tracer, following, plan, trial, &end)).flatten()
}

/// Whether the history of slip is of consequence.
fn matters(system: &StepSystem) -> bool {
    system.finite() && !system.joints_flow_associated()
}

fn goes_to_factor(following: &Following) -> bool {
    matches!(following.load_step.end, LoadStepEnd::Factor(_))
}

/// Whether the history of slip has been followed far enough. After a peak friction may let the path cycle in small loops:
/// history is followed on to other peaks within a budget, also where the load falls, for it shapes the peaks that follow. A
/// stage that goes to a factor has ended at its peak, but for what it snaps to.
fn is_enough(tracer: &Tracer, following: &Following) -> bool {
    let arrests = tracer.system.counters.get("arrests").copied().unwrap_or(0);
    tracer.limit.peak.is_some() && (goes_to_factor(following) || arrests >= MOST_ARRESTS)
}

/// What a step misses, by the rate at its end.
fn all_missed(tracer: &Tracer, following: &Following, plan: &StepPlan, trial: &Trial, end: &Tangent) -> Vec<Missed> {
    // The rate at the end is per unit of the factor where the step goes to one.
    let by_end = if trial.reaches { (trial.next.factor - tracer.state.factor).abs() } else { following.length };
    let rates = [(&following.branch.tangent, plan.step), (end, by_end)];
    let missed = |c: usize| missed_at(&tracer.system, &tracer.state, rates, &trial.next, c);
    (0..trial.next.gap.len()).filter_map(missed).collect()
}

/// Length of the step that is to be tried instead of one that misses slip; `end` is the rate at its end.
pub(super) fn missed_slip(
    tracer: &mut Tracer,
    following: &mut Following,
    plan: &StepPlan,
    trial: &Trial,
    end: &Tangent,
) -> Option<f64> {
    let matters = matters(&tracer.system);
    if !matters || is_enough(tracer, following) {
        if matters && !goes_to_factor(following) && !tracer.system.counters.contains_key(ENDED) {
            note_end(tracer);
        }
        following.arrest = None;
        return None;
    }
    let length = following.length;
    let all = all_missed(tracer, following, plan, trial, end);
    let tolerance = MISSED[usize::from(trial.next.yields())];
    let worst = all.iter().map(|missed| missed.force).fold(0.0, f64::max);
    if worst <= tolerance || length <= SHORTEST * following.limits.first {
        if worst > 0.0
            && let Some(arrest) = following.arrest
        {
            note_choice(tracer, following, (&following.branch.tangent, plan.step), &trial.next);
            following.arrest = Some(Arrest { beyond: 0.0, ..arrest });
        }
        return None;
    }
    tracer.system.count("arrests", 1);
    let counts = all.iter().filter(|missed| missed.force > tolerance);
    let smooth = counts.filter_map(|missed| missed.place).reduce(f64::min);
    let event = first_event(&tracer.system, &tracer.state, (&following.branch.tangent, plan.step), &trial.next);
    let kinked = event.map(|share| share * (1.0 - BEFORE));
    let share = smooth.into_iter().chain(kinked).reduce(f64::min).unwrap_or(UNKNOWN);
    // What was to lie before the place lies beyond it: what told it is not to be relied on.
    let again = following.arrest.is_some_and(|arrest| length < 0.999 * arrest.beyond);
    let most = if again { AGAIN } else { SHARES[1] };
    let whole = following.arrest.map_or(length, |arrest| arrest.whole);
    following.arrest = Some(Arrest { whole, beyond: length });
    Some(length * share.clamp(SHARES[0], most))
}

/// Says that the history of slip is followed no further: what comes later depends on the step.
fn note_end(tracer: &mut Tracer) {
    tracer.system.count(ENDED, 1);
    tracer.record.notes.push(format!(
        "from factor {} on steps no longer end where points come to rest, after {MOST_ARRESTS} that did: limit points that follow may depend on the step (5e-5 of themselves was seen)",
        tracer.state.factor
    ));
}

/// Names a place where points come to rest though all could go on as they are: with friction that is not associated
/// several branches may start at one state.
fn note_choice(tracer: &mut Tracer, following: &Following, (rate, share): (&Tangent, f64), next: &State) {
    let start = tracer.state.clone();
    let rests = |c: &usize| slides(&tracer.system, &start, *c).is_some() && next.mode[*c] == ContactMode::Stick;
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

/// The sense in which a point slides on one facet.
fn slides(system: &StepSystem, state: &State, c: usize) -> Option<f64> {
    let (ContactMode::Facet(i), Some(law)) = (state.mode[c], system.law(c)) else { return None };
    let facet = &law.facets[i as usize];
    (facet.mode == FacetMode::Sliding).then(|| -facet.flow[1].signum())
}

/// A slip by the force that it would release at its point, relative to the greatest force.
fn as_force(system: &StepSystem, state: &State, c: usize, slip: f64) -> f64 {
    let largest = state.force.iter().flatten().fold(system.units().force, |a: f64, r| a.max(r.abs()));
    (slip * system.stiffness(c)[1]).abs() / largest
}

/// What a step misses at a point, by the rates at both ends with the shares that make the step of them.
fn missed_at(
    system: &StepSystem,
    start: &State,
    [(begin, share), (end, by_end)]: [(&Tangent, f64); 2],
    next: &State,
    c: usize,
) -> Option<Missed> {
    let lost = |slip: f64, place: Option<f64>| Some(Missed { force: as_force(system, next, c, slip), place });
    let before = share * begin.gap[c][1];
    let (slid, sense) = (slides(system, start, c), slides(system, next, c));
    match (slid, sense) {
        // Slid on, or began to.
        (slid, Some(sense)) if slid.is_none_or(|before| before == sense) => {
            let after = sense * by_end * end.gap[c][1];
            if after >= 0.0 {
                return None;
            }
            let begun = slid.map_or(0.0, |_| (sense * before).max(0.0));
            lost(0.5 * after * after / (begun - after), slid.map(|_| begun / (begun - after)))
        }
        // Came to rest, or turned; one that slides back at the beginning already has nothing to lose.
        (Some(slid), Some(_)) => lost((slid * before).max(0.0), None),
        (Some(slid), None) if next.mode[c] == ContactMode::Stick => lost((slid * before).max(0.0), None),
        (None, None) if start.mode[c] != ContactMode::Stick && next.mode[c] == ContactMode::Stick => lost(before, None),
        _ => None,
    }
}

/// Share of the predictor at which the first point would leave its mode that does so in the step, other than by coming
/// to rest.
fn first_event(system: &StepSystem, start: &State, rate: (&Tangent, f64), next: &State) -> Option<f64> {
    let leaves = |c: &usize| match (start.mode[*c], next.mode[*c]) {
        (before, after) if before == after => false,
        (ContactMode::Facet(_), ContactMode::Stick | ContactMode::Facet(_)) => false,
        _ => true,
    };
    let points = (0..next.gap.len()).filter(leaves).filter_map(|c| predicted_event(system, start, rate, c));
    points.filter(|share| *share > 0.0 && *share < 1.0).reduce(f64::min)
}

/// Share of the predictor at which a point would leave its mode, other than by coming to rest.
pub(super) fn predicted_event(
    system: &StepSystem,
    start: &State,
    (rate, share): (&Tangent, f64),
    c: usize,
) -> Option<f64> {
    let law = system.law(c)?;
    let (area, force, gap) = (system.problem.contacts[c].area, start.force[c], start.gap[c]);
    if let ContactMode::Open | ContactMode::Corner(..) = start.mode[c] {
        let closes = -share * rate.gap[c][0];
        return (closes > 0.0).then(|| gap[0] / closes);
    }
    let after = [0, 1].map(|k| force[k] + share * rate.force[c][k]);
    let reached = |(i, facet): (usize, &Facet)| {
        let [now, then] = [slack(facet, force, area), slack(facet, after, area)];
        (!start.mode[c].flows_on(i) && then < 0.0 && now > 0.0).then(|| now / (now - then))
    };
    law.facets.iter().enumerate().filter_map(reached).reduce(f64::min)
}
