//! Damped descent from an unstable equilibrium with its loads and settlements held (finite displacements, laws of
//! facets): viscous wrenches act on the bodies,
//!
//! ```text
//! Gqᵀ r + w + λ p = κ B q̇,   step by step (q − q₀) κ B,   B = 1 in the units of the motions
//! ```
//!
//! Each step is an equilibrium with the additional stiffness κ B. It is unique if κ is greater than the magnitude of
//! the least, negative eigenvalue of K. A step at whose end κ is smaller is repeated with more damping, and so is a step
//! whose energies are not in balance. The first step is repeated with a smaller push along the critical mode instead:
//! next to a bifurcation a stable state may be near. Friction keeps its history from step to step. In every step the
//! potential falls by the dissipation of the wrenches and of friction. The descent therefore ends in the equilibrium to
//! which the state would fall slowly, never in one beyond a rise of its energy. The end counts as an equilibrium if it
//! holds without damping and has positive second-order work. The work of the viscous wrenches is the energy that a real
//! fall releases: the decrease of the potential minus the work of friction.

use super::descent_energy::{DescentState, descent_step, free_motions};
use crate::path::newton::model::control::Control;
use crate::path::newton::model::loads::Damping;
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::solve::iteration::iterate;
use crate::path::newton::solve::second_order::second_order_work;
use crate::path::stability::SecondOrderWork;
use crate::settings::SETTINGS;

/// Greatest number of steps of a descent.
const MAX_STEPS: usize = 400;
/// Greatest number of successive repetitions of a step.
const MAX_FAILURES: u32 = 12;

/// The end of a descent.
pub struct Relaxation {
    /// The last state of the descent with its history, and the equilibrium next to it.
    pub before: State,
    pub next: State,
    /// Its distance along the critical mode, in units.
    pub side: f64,
    /// Decrease of the potential up to `next` \[J\].
    pub fall: f64,
    /// Its part that is not work of friction \[J\].
    pub released: f64,
    /// Energy dissipated by friction up to `before` \[J\].
    pub dissipated: f64,
}

/// Returns the descents from a state along its critical mode, one in each sense, that end in stable equilibria.
pub fn relaxations(system: &mut StepSystem, state: &State, work: &SecondOrderWork) -> Vec<Relaxation> {
    if system.limits.remembers {
        return Vec::new();
    }
    [1.0, -1.0].into_iter().filter_map(|sense| descent(system, state, work, sense)).collect()
}

/// Computes a descent in one sense of the critical mode.
fn descent(system: &mut StepSystem, from: &State, work: &SecondOrderWork, sense: f64) -> Option<Relaxation> {
    let mode = &work.critical_mode()?;
    let (u, control) = (system.units(), Control::Factor(from.factor));
    let size = mode.iter().fold(0.0, |a: f64, z| a.max(z.abs()));
    let mut anchor = from.motion.clone();
    for (body, q) in anchor.iter_mut().enumerate() {
        let Some(free) = system.scaled.free[body] else { continue };
        (0..3).for_each(|k| q[k] += sense * SETTINGS.visible * u.motion()[k] * mode[3 * free + k] / size);
    }
    // With this damping each step is unique, and an unstable motion grows by a third in it.
    let unique = |turned: f64| 4.0 * turned.max(SETTINGS.active);
    let mut rate = unique(work.curvature.abs());
    let (mut state, mut energies) = (from.clone(), DescentState::of(system, from, None));
    let (mut fall, mut dissipated, mut failures, mut begun) = (0.0, 0.0, 0, false);
    for _ in 0..MAX_STEPS {
        let damping = Damping { rate, from: anchor.clone() };
        system.loads.damping = Some(damping.clone());
        let found = iterate(system, &state, state.clone(), &control, 8).ok();
        system.count("relaxation_steps", 1);
        system.loads.damping = None;
        let work = found.as_ref().and_then(|(next, _)| second_order_work(system, next));
        let turned = work.filter(|work| work.turned > 0).map_or(0.0, |work| work.curvature.abs());
        // A state that is unstable in spite of its damping may not be the next one of the descent.
        let step = found.filter(|_| turned <= rate).map(|(next, _)| {
            let end = DescentState::of(system, &next, Some(&damping));
            (descent_step(system, (&state, &energies), (&next, &end)), next, end)
        });
        let longer = step.as_ref().map_or(0.0, |(step, ..)| 0.9 / step.error.sqrt()).clamp(0.25, 2.0);
        let step = step.filter(|(step, ..)| step.error <= 1.0);
        // The first step is as long as its push; the others are shorter with more damping.
        if begun || step.is_some() {
            rate /= longer;
        } else {
            let push = anchor.as_flattened_mut().iter_mut().zip(from.motion.as_flattened());
            push.for_each(|(anchor, from)| *anchor = from + longer * (*anchor - from));
        }
        rate = rate.max(unique(turned));
        let Some((step, mut next, end)) = step else {
            failures += 1;
            if failures > MAX_FAILURES {
                return None;
            }
            continue;
        };
        (failures, begun) = (0, true);
        let moved = distance(system, &state, &next);
        (fall, dissipated) = (fall + step.fall, dissipated + step.dissipated);
        let start = state.clone();
        system.keep(&start, &mut next);
        (state, anchor, energies) = (next.clone(), next.motion, end);
        if fallen(system, from, &state) {
            return None;
        }
        let stable = turned == 0.0;
        let next = stable.then(|| settled(system, &state, &control, moved, damping.rate)).flatten();
        if let Some(next) = next {
            let end = DescentState::of(system, &next, None);
            let last = descent_step(system, (&state, &energies), (&next, &end));
            let fall = fall + last.fall;
            let released = (fall - dissipated - last.dissipated).max(0.0);
            let side = along(system, from, &next, mode);
            return Some(Relaxation { before: state, next, fall, released, dissipated, side });
        }
    }
    None
}

/// Returns the stable equilibrium next to a state of a descent; its last step has `moved` this far with a damping of
/// `rate`.
fn settled(system: &mut StepSystem, state: &State, control: &Control, moved: f64, rate: f64) -> Option<State> {
    let (next, _) = iterate(system, state, state.clone(), control, 8).ok()?;
    let work = second_order_work(system, &next).filter(|work| work.negative == 0 || work.turned == 0)?;
    // By the equation of the damped step, the remaining distance is about κ / k times the step.
    let left = moved * (1.0 + rate / work.curvature.abs().max(1e-12));
    (distance(system, state, &next) <= 4.0 * left).then_some(next)
}

/// Returns the Euclidean distance of the motions of two states in their units.
fn distance(system: &StepSystem, a: &State, b: &State) -> f64 {
    free_motions(system, &a.motion, &b.motion).map(|motion| motion * motion).sum::<f64>().sqrt()
}

/// Returns the distance of a state from another along a mode, in units.
fn along(system: &StepSystem, from: &State, state: &State, mode: &[f64]) -> f64 {
    free_motions(system, &from.motion, &state.motion).zip(mode).map(|(motion, mode)| motion * mode).sum()
}

/// Returns true if a body has moved so far that the structure has fallen.
fn fallen(system: &StepSystem, from: &State, state: &State) -> bool {
    let length = system.units().length;
    let pairs = from.motion.iter().zip(&state.motion);
    pairs
        .map(|(a, b)| (a[0] - b[0]).hypot(a[1] - b[1]).max(length * (a[2] - b[2]).abs()))
        .any(|d| d > SETTINGS.fallen * length)
}
