//! Data of a state for its record: the deformation of the blocks (gaps, energy stored in blocks and joints),
//! displacements of loaded points, and reactions of held blocks.
//!
//! Elastic energy of a block in equilibrium: ½ Σ f·u over its contact and load points (Clapeyron); the work of gravity
//! on the elastic displacements vanishes, since their mean does.

use crate::linear::dense::add_product;
use crate::linear::inner;
use crate::path::energy::WorkState;
use voussoir_core::model::geometry::{Vec2, turned};
use voussoir_core::path::{Attachment, Contact, PathProblem, PathState};

/// The deformation of the blocks of a state by their forces.
pub struct Deformation {
    /// Displacements (x, y) of every body's points relative to its rigid motion \[m\]; empty for a rigid body.
    points: Vec<Vec<f64>>,
    /// Elastic energy of blocks and joints \[J\].
    pub stored: f64,
}

impl Deformation {
    /// Computes the deformation from the contact forces and loads of a state.
    pub fn new(problem: &PathProblem, state: &PathState) -> Self {
        let of_joint = |(contact, f): (&Contact, &[f64; 2])| {
            0.5 * (contact.compliance[0] * f[0] * f[0] + contact.compliance[1] * f[1] * f[1])
        };
        let mut stored: f64 = problem.contacts.iter().zip(&state.force).map(of_joint).sum();
        let mut forces: Vec<f64> = Vec::new();
        let bodies = problem.bodies.iter().zip(problem.forces_on_points(state, false));
        let points = bodies.map(|(body, on_points)| {
            let Some(flexibility) = &body.flexibility else { return Vec::new() };
            forces.clear();
            on_points.iter().for_each(|f| forces.extend([f.x, f.y]));
            let mut moved = vec![0.0; forces.len()];
            add_product(&mut moved, flexibility, &forces);
            stored += 0.5 * inner(&forces, &moved);
            moved
        });
        Deformation { points: points.collect(), stored }
    }

    /// Returns the displacement of a point of a body relative to its rigid motion.
    fn at(&self, body: usize, slot: Option<usize>) -> Vec2 {
        let Some(own) = slot.and_then(|slot| self.points[body].get(2 * slot..2 * slot + 2)) else {
            return Vec2::zeros();
        };
        Vec2::new(own[0], own[1])
    }

    /// Returns the gaps of all contact points \[m\].
    pub fn gaps(&self, problem: &PathProblem, state: &PathState) -> Vec<[f64; 2]> {
        let place = |side: Attachment, point: Vec2| {
            problem.rigid_displacement(&state.motion, side.body, point, false) + self.at(side.body, side.slot)
        };
        let gap = |(contact, force): (&Contact, &[f64; 2])| {
            let apart = place(contact.plus, contact.position) - place(contact.minus, contact.position);
            let [n, t] = contact.compliance;
            [contact.gap + apart.dot(&contact.normal) + n * force[0], apart.dot(&contact.tangent) + t * force[1]]
        };
        problem.contacts.iter().zip(&state.force).map(gap).collect()
    }
}

/// Returns the data of a state, with its deformation, for the work of a step.
pub fn work_state(problem: &PathProblem, state: &PathState, deformation: &Deformation) -> WorkState {
    let place = |&(body, slot, point, _): &(usize, Option<usize>, Vec2, Vec2)| {
        problem.rigid_displacement(&state.motion, body, point, false) + deformation.at(body, slot)
    };
    let displacements = problem.load_steps.iter().map(|step| step.loading.forces.iter().map(place).collect());
    let factors = problem.applied(state.load_step, state.factor);
    // Only settlements do work on reactions.
    let settles = problem.load_steps.iter().any(|step| !step.loading.settlements.is_empty());
    let at_rest = || vec![[0.0; 3]; problem.bodies.len()];
    let unbalanced = if settles { unbalanced(problem, state, &factors) } else { at_rest() };
    let displacements = displacements.collect();
    WorkState { factors, displacements, motion: state.motion.clone(), unbalanced }
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
