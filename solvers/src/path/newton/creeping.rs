//! Steps that only seem to follow the path (laws of facets): they creep.
//!
//! With flow that is not associated the modes that a step asks for at a corner may be those of no solution: whatever
//! its length, a point slips against its friction. A step so short that this is below the tolerance of the law
//! would still pass for converged, and the next, as short, again: the path would creep along what is no solution
//! of its rates. Such a step is refused: what it violates grows in proportion to it. Where a guess of the modes at
//! a corner is followed by no step, or steps creep, the rates are searched to their end instead ([`limit_point_test`](super::limit_point_test)).

use super::control::Control;
use super::measure::{increment_along, increment_between};
use super::state::{State, Tangent};
use super::system::{StepFailure, StepSystem};
use super::tangent::{gap_rounding, tangent_at};
use super::tracer::Tracer;

/// Why a step that creeps is refused.
pub(super) const CREEPS: &str = "a contact point slips against its friction, however short the step";

/// Violations below this share of the greatest force are rounding.
const ROUNDING: f64 = 1e-14;

/// Violations below this share of what the step adds to a point's own force change nothing.
const MATTERS: f64 = 1e-6;

/// What another step like the last adds to its violation, relative to it, where the step creeps.
const GROWTH: [f64; 2] = [0.3, 3.0];

/// The contact point, if any, whose law a step violates, within the tolerance, in proportion to its
/// length: with the rate of the modes at its end the violation grows by as much again.
fn creeping_point(system: &mut StepSystem, start: &State, next: &State, control: &Control) -> Option<usize> {
    if !system.piecewise_linear() || system.monotone() {
        return None;
    }
    let largest = next.force.iter().flatten().fold(0.0, |a: f64, r| a.max(r.abs()));
    let rounding = if system.finite() { gap_rounding(system, next) } else { 0.0 };
    let violation = |system: &StepSystem, c: usize, ahead: Option<(&Tangent, f64)>| {
        let Some(law) = system.law(c) else { return 0.0 };
        let rho = system.stiffness(c);
        let gap = system.step_gap(start, next, c);
        let z = [0, 1].map(|k| {
            let more = ahead.map_or(0.0, |(rate, share)| share * (rate.force[c][k] - rho[k] * rate.gap[c][k]));
            next.force[c][k] - rho[k] * gap[k] + more
        });
        law.violation(next.mode[c], z, rho, system.problem.contacts[c].area)
    };
    let violated: Vec<(usize, f64)> = (0..next.gap.len())
        .map(|c| (c, violation(system, c, None)))
        .filter(|&(c, now)| {
            let [n, t] = [0, 1].map(|k| next.force[c][k] - start.force[c][k]);
            let [a, b] = system.stiffness(c);
            now > (ROUNDING * largest).max(rounding * a.max(b)).max(MATTERS * n.hypot(t))
        })
        .collect();
    if violated.is_empty() {
        return None;
    }
    let rate = tangent_at(system, start, next, control)?;
    let (whole, step) = (increment_along(system, next, &rate), increment_between(system, start, next));
    let size = whole.motion.hypot(whole.factor);
    if size.is_nan() || size <= 0.0 {
        return None;
    }
    let along: f64 =
        (0..next.gap.len()).flat_map(|c| [0, 1].map(|k| (next.gap[c][k] - start.gap[c][k]) * rate.gap[c][k])).sum();
    let share = (step.motion.hypot(step.factor) / size).copysign(along);
    let grows = |&(c, now): &(usize, f64)| {
        let more = violation(system, c, Some((&rate, share))) / now - 1.0;
        (GROWTH[0]..=GROWTH[1]).contains(&more)
    };
    violated.into_iter().find(grows).map(|(c, _)| c)
}

/// Refuses a converged step that creeps.
pub(super) fn refuse_creeping(
    tracer: &mut Tracer,
    next: State,
    iterations: u64,
    control: &Control,
) -> Result<(State, u64), StepFailure> {
    let start = tracer.state.clone();
    match creeping_point(&mut tracer.system, &start, &next, control) {
        None => Ok((next, iterations)),
        Some(c) => {
            tracer.system.count("creeping_steps", 1);
            Err(StepFailure { why: CREEPS.into(), cycling: vec![c] })
        }
    }
}
