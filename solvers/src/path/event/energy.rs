//! What the energy balance needs of a state: displacements of loaded points, reactions of held blocks, energy stored
//! in blocks and joints.
//!
//! Elastic energy of a block in equilibrium: ½ Σ f·u over its contact and load points (Clapeyron);
//! the work of gravity on the elastic displacements vanishes, since their mean does.

use crate::linear::dense::add_product;
use crate::linear::inner;
use crate::path::energy::WorkState;
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::path::{Contact, PathProblem, PathState};

/// Displacement of a point by the rigid motion of its body.
pub fn rigid(problem: &PathProblem, motion: &[[f64; 3]], body: usize, point: Vec2) -> Vec2 {
    let [x, y, theta] = motion[body];
    Vec2::new(x, y) + turned(point - problem.bodies[body].pole) * theta
}

/// What the work of a step needs of a state, and the elastic energy of blocks and joints \[J\].
pub fn energies(problem: &PathProblem, state: &PathState) -> (WorkState, f64) {
    let of_joint = |(contact, f): (&Contact, &[f64; 2])| {
        0.5 * (contact.compliance[0] * f[0] * f[0] + contact.compliance[1] * f[1] * f[1])
    };
    let mut stored: f64 = problem.contacts.iter().zip(&state.force).map(of_joint).sum();
    let mut elastic: Vec<Option<Vec<f64>>> = Vec::with_capacity(problem.bodies.len());
    for (body, f) in problem.bodies.iter().zip(&problem.forces_on_points(state, false)) {
        elastic.push(body.flexibility.as_ref().map(|flexibility| {
            let flat: Vec<f64> = f.iter().flat_map(|f| [f.x, f.y]).collect();
            let mut u = vec![0.0; flat.len()];
            add_product(&mut u, flexibility, &flat);
            stored += 0.5 * inner(&flat, &u);
            u
        }));
    }
    let place = |&(body, slot, point, _): &(usize, Option<usize>, Vec2, Vec2)| {
        let own = elastic[body].as_ref().zip(slot).map(|(u, slot)| Vec2::new(u[2 * slot], u[2 * slot + 1]));
        rigid(problem, &state.motion, body, point) + own.unwrap_or_else(Vec2::zeros)
    };
    let displacements = problem.load_steps.iter().map(|step| step.loading.forces.iter().map(place).collect());
    let factors = problem.applied(state.load_step, state.factor);
    let unbalanced = unbalanced(problem, state, &factors);
    let displacements = displacements.collect();
    (WorkState { factors, displacements, motion: state.motion.clone(), unbalanced }, stored)
}

/// What loads and contact forces leave on every body about its pole.
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
