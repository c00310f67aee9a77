//! Rows, residuals and energies of contact points with laws of tractions from gaps.

use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::model::tractions::{TractionUpdates, update};

/// Updates the responses of the laws to a state's gaps, for a step from `start`.
pub fn update_tractions(system: &mut StepSystem, start: &State, state: &mut State) -> Result<(), String> {
    let count = system.laws.responses.count();
    if count > 0 {
        system.count("law_evaluations", count);
        let step = system.law_step(start, state.factor);
        state.updates = update(&system.laws.responses, &state.gap, &start.updates.memory, &step)?;
    }
    Ok(())
}

/// Gives the laws of a state the tangents of a load that acts at once, after a load step in time.
pub fn at_once(system: &StepSystem, state: &mut State) {
    if let Ok(updates) = update(&system.laws.responses, &state.gap, &state.updates.memory, &system.instant(state)) {
        state.updates = updates;
    }
}

/// Returns the scale and the scaled stiffness of a point's rows: σ F and σ U K.
pub fn traction_row(system: &StepSystem, state: &State, contact: usize) -> ([f64; 2], [[f64; 2]; 2]) {
    let u = system.units();
    let area = system.problem.contacts[contact].area;
    let stiffness = state.updates.points[contact].tangent.map(|row| row.map(|t| -area * t * u.displacement));
    let sigma = stiffness.map(|row| 1.0 / (u.force + row[0].abs() + row[1].abs()));
    let scaled = [0, 1].map(|k| stiffness[k].map(|s| s * sigma[k]));
    (sigma.map(|s| s * u.force), scaled)
}

/// Returns σ (r − A t).
pub fn traction_residual(system: &StepSystem, state: &State, contact: usize) -> [f64; 2] {
    let area = system.problem.contacts[contact].area;
    let (own, _) = traction_row(system, state, contact);
    let traction = state.updates.points[contact].traction;
    [0, 1].map(|k| own[k] * (state.force[contact][k] - area * traction[k]) / system.units().force)
}

/// Returns the greatest difference between forces and the responses of the laws, beyond rounding of the gaps, relative
/// to the greatest force. Between soft blocks a stiff law turns small errors of motions into a share of the forces.
pub fn traction_error(system: &StepSystem, state: &State) -> f64 {
    let largest = state.force.iter().flatten().map(|r| r.abs()).fold(system.units().force, f64::max);
    let moved = state.motion.iter().flat_map(|q| &q[..2]).chain(state.gap.iter().flatten());
    let moved = moved.fold(0.0, |a: f64, x| a.max(x.abs()));
    // Half of the tolerance of a certificate.
    let place = system.limits.place;
    let rounding = f64::EPSILON * if place > 0.0 { 256.0 * place } else { 32.0 * moved };
    let mut worst: f64 = 0.0;
    for c in system.laws.responses.points() {
        let (point, area) = (&state.updates.points[c], system.problem.contacts[c].area);
        for k in 0..2 {
            let stiffness = point.tangent[k][0].abs() + point.tangent[k][1].abs();
            let off = (state.force[c][k] - area * point.traction[k]).abs() - rounding * area * stiffness;
            worst = worst.max(off / largest);
        }
    }
    worst
}

/// Returns the energy that these laws dissipate in the step of an update \[J\].
pub fn dissipated_by(system: &StepSystem, updates: &TractionUpdates) -> f64 {
    let points = updates.points.iter().zip(&system.problem.contacts);
    points.map(|(point, c)| c.area * point.dissipated).sum()
}

/// Returns the energy that changing fields supply to these laws in the step of an update \[J\].
pub fn supplied_by(system: &StepSystem, updates: &TractionUpdates) -> f64 {
    let points = updates.points.iter().zip(&system.problem.contacts);
    points.map(|(point, c)| c.area * point.supplied).sum()
}

/// Returns the energy that these laws store \[J\].
pub fn stored_by_tractions(system: &StepSystem, state: &State) -> f64 {
    let points = state.updates.points.iter().zip(&system.problem.contacts);
    points.map(|(point, c)| c.area * point.stored).sum()
}

/// Returns true if a step from `start` is irreversible at some point.
pub fn tractions_dissipate(system: &StepSystem, state: &State) -> bool {
    let most = 1e-13 * (stored_by_tractions(system, state).abs() + system.units().energy());
    dissipated_by(system, &state.updates) > most
}
