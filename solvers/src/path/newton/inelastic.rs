//! Blocks whose material yields: their inner iteration, which goes along with Newton's method on contact
//! forces and motions.
//!
//! An iteration sees such a block as u = C f + c at its points, the linearisation at the displacements of
//! its nodes ([`Linearisation`]). Once forces and motions have moved, the nodes follow by the same
//! linearisation, stresses are updated there, and the block is linearised again: Newton's method on all
//! unknowns together, the nodes condensed. What stresses leave of inner equilibrium counts in the
//! residual of the step. History is that of the last converged step until [`Model::keep`].

use super::model::{Model, Rate, Refusal, State};
use std::rc::Rc;
use std::sync::Arc;
use voussoir_core::elastic::{InelasticState, Linearisation};
use voussoir_core::path::{PathProblem, Yielded};

/// A body whose material yields, within a step.
#[derive(Debug, Clone)]
pub(super) struct Inner {
    /// At the present displacements of its nodes.
    pub linear: Rc<Linearisation>,
    /// What it remembered when the step began.
    pub base: Arc<InelasticState>,
}

/// All bodies that may yield, undeformed.
pub(super) fn undeformed(problem: &PathProblem) -> Result<Vec<Option<Inner>>, String> {
    if !problem.yields() {
        return Ok(Vec::new());
    }
    let body = |body: &voussoir_core::path::PathBody| {
        let Some(inelastic) = &body.inelastic else { return Ok(None) };
        let base = Arc::new(inelastic.initial());
        let linear = Rc::new(inelastic.linearise(vec![0.0; 2 * inelastic.nodes()], &base)?);
        Ok(Some(Inner { linear, base }))
    };
    problem.bodies.iter().map(body).collect()
}

/// The bodies that have yielded, as others read them.
pub(super) fn yielded(blocks: &[Option<Inner>]) -> Vec<Option<Yielded>> {
    let record = |inner: &Inner| {
        let (displacement, state) = (inner.linear.displacement.clone(), inner.linear.end.clone());
        state.yielded.then_some(Yielded { displacement, state })
    };
    blocks.iter().map(|inner| inner.as_ref().and_then(record)).collect()
}

impl Model<'_> {
    /// The nodes of all blocks follow forces and motions; blocks are linearised where they come to lie.
    pub fn deform(&mut self, state: &mut State) -> Result<(), Refusal> {
        if state.blocks.is_empty() {
            return Ok(());
        }
        let loads = self.loaded.at(state.factor);
        for index in 0..state.blocks.len() {
            let (Some(inner), Some(inelastic)) = (&state.blocks[index], &self.problem.bodies[index].inelastic) else {
                continue;
            };
            let forces = self.kinematics.body_forces(index, &state.force, &state.motion, &loads);
            let displacement = inelastic.displaced(&inner.linear, &forces);
            self.count("stress_updates", inelastic.gauss_points() as u64);
            let linear = inelastic
                .linearise(displacement, &inner.base)
                .map_err(|why| Refusal { why: format!("block {index}: {why}"), restless: Vec::new() })?;
            self.count("block_factorisations", linear.factorisations);
            state.blocks[index] = Some(Inner { linear: Rc::new(linear), base: inner.base.clone() });
        }
        Ok(())
    }

    /// Greatest force on a node that stresses leave, relative to the greatest contact force.
    pub fn inner_error(&self, state: &State) -> f64 {
        if state.blocks.is_empty() {
            return 0.0;
        }
        let loads = self.loaded.at(state.factor);
        let force = state.force.iter().flatten().map(|r| r.abs()).fold(self.units.force, f64::max);
        let mut worst: f64 = 0.0;
        for (index, inner) in state.blocks.iter().enumerate() {
            let (Some(inner), Some(inelastic)) = (inner, &self.problem.bodies[index].inelastic) else { continue };
            let forces = self.kinematics.body_forces(index, &state.force, &state.motion, &loads);
            let left = inelastic.residual(&inner.linear, &forces) / force;
            if left.is_nan() {
                return left;
            }
            worst = worst.max(left);
        }
        worst
    }

    /// Plastic work of a step in the unit of energy.
    pub fn plastic_work(&self, start: &State, state: &State) -> f64 {
        let both = start.blocks.iter().flatten().zip(state.blocks.iter().flatten());
        let work: f64 = both.map(|(from, to)| to.linear.end.dissipated - from.base.dissipated).sum();
        work / (self.units.force * self.units.displacement)
    }

    /// ∂(plastic work)/∂(forces on the points) of every block that yields.
    fn plastic_work_by_force(&self, state: &State) -> Vec<(usize, Vec<f64>)> {
        let yielding = state.blocks.iter().enumerate().filter_map(|(index, inner)| {
            let (inner, inelastic) = (inner.as_ref()?, self.problem.bodies[index].inelastic.as_ref()?);
            (inner.linear.yielding > 0).then(|| (index, inelastic.dissipation_by_force(&inner.linear)))
        });
        yielding.collect()
    }

    /// Adds the gradient of the plastic work to a row over the scaled unknowns; rotations of the forces
    /// are left out.
    pub fn add_plastic_work(&self, row: &mut [f64], state: &State, scale: f64) {
        let (loads, last) = (self.loaded.at(state.factor), row.len() - 1);
        for (body, weight) in self.plastic_work_by_force(state) {
            let place = (&state.force[..], &state.motion[..]);
            let by_factor = self.kinematics.by_forces(body, &weight, place, &loads, |i, value| {
                row[i] += scale * value * self.units.force;
            });
            row[last] += scale * by_factor * self.units.factor;
        }
    }

    /// Plastic work per unit of a rate \[J\].
    pub fn plastic_power(&self, state: &State, rate: &Rate) -> f64 {
        let loads = self.loaded.at(state.factor);
        let mut power = 0.0;
        for (body, weight) in self.plastic_work_by_force(state) {
            let place = (&state.force[..], &state.motion[..]);
            let by_factor = self.kinematics.by_forces(body, &weight, place, &loads, |i, value| {
                power += value * rate.force[i / 2][i % 2];
            });
            power += by_factor * rate.factor;
        }
        power
    }
}
