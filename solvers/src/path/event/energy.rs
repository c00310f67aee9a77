//! Data of a state for its record: displacements of loaded points, reactions of held blocks, and the elastic energy.
//!
//! Elastic energy of blocks and joints (Clapeyron): E = ½ (Σ F·u + Σ r·(g − g_0) + Σ R·q) with loads F, displacements u of their
//! points, contact forces r, gaps g, reactions R of held blocks and their motions q. The work of gravity on the elastic
//! displacements vanishes, since their mean does.

use crate::path::energy::WorkState;
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::path::{PathProblem, PathState};

/// Returns the data of a state for the work of a step, and the elastic energy of blocks and joints \[J\].
pub fn work_state(problem: &PathProblem, state: &PathState) -> (WorkState, f64) {
    let factors = problem.applied(state.load_step, state.factor);
    let place = |&(body, slot, point, _): &(usize, Option<usize>, Vec2, Vec2)| {
        let mut place = problem.rigid_displacement(&state.motion, body, point, false);
        let Some((slot, flexibility)) = slot.zip(problem.bodies[body].flexibility.as_ref()) else { return place };
        for (contact, f) in problem.contacts.iter().zip(&state.force) {
            for (side, sense) in [(contact.plus, 1.0), (contact.minus, -1.0)] {
                if let (true, Some(at)) = (side.body == body, side.slot) {
                    let force = (contact.normal * f[0] + contact.tangent * f[1]) * sense;
                    place += flexibility.fixed_view::<2, 2>(2 * slot, 2 * at) * force;
                }
            }
        }
        let loads = problem.load_steps.iter().zip(&factors);
        loads.fold(place, |place, (step, factor)| place + problem.deformation(&step.loading, body, slot) * *factor)
    };
    let displacements = problem.load_steps.iter().map(|step| step.loading.forces.iter().map(place).collect());
    let displacements: Vec<Vec<Vec2>> = displacements.collect();
    // Only settlements do work on reactions.
    let settles = problem.load_steps.iter().any(|step| !step.loading.settlements.is_empty());
    let at_rest = || vec![[0.0; 3]; problem.bodies.len()];
    let unbalanced = if settles { unbalanced(problem, state, &factors) } else { at_rest() };
    let points = problem.contacts.iter().zip(state.force.iter().zip(&state.gap));
    let by_gaps: f64 = points.map(|(contact, (f, gap))| f[0] * (gap[0] - contact.gap) + f[1] * gap[1]).sum();
    let reactions = unbalanced.as_flattened().iter().zip(state.motion.as_flattened());
    let mut twice = by_gaps - reactions.map(|(reaction, moved)| reaction * moved).sum::<f64>();
    for ((step, factor), places) in problem.load_steps.iter().zip(&factors).zip(&displacements) {
        let pushed = step.loading.forces.iter().zip(places).map(|(force, place)| force.3.dot(place));
        let weights = problem.bodies.iter().zip(&state.motion);
        let lifted = weights.map(|(body, q)| body.mass * step.loading.acceleration.dot(&Vec2::new(q[0], q[1])));
        twice += factor * (pushed.sum::<f64>() + lifted.sum::<f64>());
    }
    (WorkState { factors, displacements, motion: state.motion.clone(), unbalanced }, 0.5 * twice)
}

/// Returns the unbalanced loads and contact forces of every body about its pole.
fn unbalanced(problem: &PathProblem, state: &PathState, factors: &[f64]) -> Vec<[f64; 3]> {
    let mut all = vec![[0.0; 3]; problem.bodies.len()];
    for (contact, f) in problem.contacts.iter().zip(&state.force) {
        let on_plus = contact.normal * f[0] + contact.tangent * f[1];
        for (body, sign) in [(contact.plus.body, 1.0), (contact.minus.body, -1.0)] {
            let moment = on_plus.dot(&turned(contact.position - problem.bodies[body].pole));
            for (sum, part) in all[body].iter_mut().zip([on_plus.x, on_plus.y, moment]) {
                *sum += sign * part;
            }
        }
    }
    for (step, factor) in problem.load_steps.iter().zip(factors) {
        for (sum, wrench) in all.iter_mut().zip(problem.wrenches(&step.loading)) {
            (0..3).for_each(|k| sum[k] += factor * wrench[k]);
        }
    }
    all
}
