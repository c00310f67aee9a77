//! Blocks with yielding material: their inner iteration, which runs together with Newton's method on contact forces and
//! motions.
//!
//! In an iteration such a block has u = C f + c at its points, the linearisation at the displacements of its nodes
//! ([`Linearisation`]). After forces and motions have changed, the nodes follow by the same linearisation, stresses are
//! updated, and the block is linearised again. This is Newton's method on all unknowns together, with the nodes
//! condensed. The residual of inner equilibrium is part of the residual of the step. History is that of the last
//! converged step until [`StepSystem::keep`].

use crate::path::newton::model::blocks::YieldingBlock;
use crate::path::newton::model::deformation::by_forces;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;
use std::rc::Rc;

/// Moves the nodes of all blocks with forces and motions, and linearises the blocks at their new positions.
pub fn update_blocks(system: &mut StepSystem, state: &mut State) -> Result<(), String> {
    let loads = system.loads.at(state.factor);
    for index in 0..state.blocks.len() {
        let (Some(inner), Some(inelastic)) = (&state.blocks[index], &system.problem.bodies[index].inelastic) else {
            continue;
        };
        let forces = system.geometry.body_forces(index, &state.force, &state.motion, &loads);
        let displacement = inelastic.displaced(&inner.linear, &forces);
        system.count("stress_updates", inelastic.gauss_points() as u64);
        let linear = inelastic.linearise(displacement, &inner.base).map_err(|why| format!("block {index}: {why}"))?;
        system.count("block_factorisations", linear.factorisations);
        state.blocks[index] = Some(YieldingBlock { linear: Rc::new(linear), base: inner.base.clone() });
    }
    Ok(())
}

/// Returns the numbers of Gauss points of some blocks at which something irreversible happens, with the nodes moved as by
/// [`update_blocks`] but without a linearisation.
pub fn yielding_points(system: &mut StepSystem, state: &State, blocks: &[usize]) -> Result<Vec<usize>, String> {
    let loads = system.loads.at(state.factor);
    let mut counts = Vec::with_capacity(blocks.len());
    for &index in blocks {
        let (Some(inner), Some(inelastic)) = (&state.blocks[index], &system.problem.bodies[index].inelastic) else {
            continue;
        };
        let forces = system.geometry.body_forces(index, &state.force, &state.motion, &loads);
        system.count("stress_updates", inelastic.gauss_points() as u64);
        let displacement = inelastic.displaced(&inner.linear, &forces);
        counts.push(inelastic.yielding(&displacement, &inner.base).map_err(|why| format!("block {index}: {why}"))?);
    }
    Ok(counts)
}

/// Returns the greatest unbalanced force on a node, relative to the greatest contact force.
pub fn block_error(system: &StepSystem, state: &State) -> f64 {
    let loads = system.loads.at(state.factor);
    let force = state.force.iter().flatten().map(|r| r.abs()).fold(system.units().force, f64::max);
    let mut worst: f64 = 0.0;
    for (index, inner) in state.blocks.iter().enumerate() {
        let (Some(inner), Some(inelastic)) = (inner, &system.problem.bodies[index].inelastic) else { continue };
        let forces = system.geometry.body_forces(index, &state.force, &state.motion, &loads);
        let left = inelastic.residual(&inner.linear, &forces) / force;
        if left.is_nan() {
            return left;
        }
        worst = worst.max(left);
    }
    worst
}

/// Returns the plastic work of a step \[J\].
pub fn plastic_work(start: &State, state: &State) -> f64 {
    let both = start.blocks.iter().flatten().zip(state.blocks.iter().flatten());
    both.map(|(from, to)| to.linear.end.dissipated - from.base.dissipated).sum()
}

/// Returns ∂(plastic work)/∂(forces on the points) of every yielding block.
fn plastic_work_by_force(system: &StepSystem, state: &State) -> Vec<(usize, Vec<f64>)> {
    let yielding = state.blocks.iter().enumerate().filter_map(|(index, inner)| {
        let (inner, inelastic) = (inner.as_ref()?, system.problem.bodies[index].inelastic.as_ref()?);
        // If the law fails beside this state, the power counts as 0; the certificate reports the failure.
        let by_force = || inelastic.dissipation_by_force(&inner.linear, &inner.base).ok();
        Some((index, (inner.linear.yielding > 0).then(by_force)??))
    });
    yielding.collect()
}

/// Returns the plastic work per unit of a rate \[J\].
pub fn plastic_power(system: &StepSystem, state: &State, rate: &Tangent) -> f64 {
    let loads = system.loads.at(state.factor);
    let mut power = 0.0;
    for (body, weight) in plastic_work_by_force(system, state) {
        let place = (&state.force[..], &state.motion[..]);
        let by_factor = by_forces(&system.geometry, body, &weight, place, &loads, |i, value| {
            power += value * rate.force[i / 2][i % 2];
        });
        power += by_factor * rate.factor;
    }
    power
}
