//! Rows, residuals, energies and local controls of contact points with laws of tractions from gaps.

use super::control::LocalControl;
use super::state::{State, Tangent};
use super::system::StepSystem;

/// Brings what the laws say in line with a state's gaps, for a step from `start`.
pub(super) fn update_tractions(system: &mut StepSystem, start: &State, state: &mut State) -> Result<(), String> {
    let count = system.laws.responses.count();
    if count > 0 {
        system.count("law_evaluations", count);
        state.updates = system.laws.responses.update(&state.gap, &start.updates.memory)?;
    }
    Ok(())
}

/// The same without a step: what the laws say when nothing has moved yet.
pub(super) fn update_at_rest(system: &mut StepSystem, state: &mut State) {
    let same = state.clone();
    // The update has succeeded at this very gap.
    _ = update_tractions(system, &same, state);
}

/// Scale and scaled stiffness of a point's rows: σ F and σ U K.
pub(super) fn traction_row(system: &StepSystem, state: &State, contact: usize) -> ([f64; 2], [[f64; 2]; 2]) {
    let u = system.units();
    let area = system.problem.contacts[contact].area;
    let stiffness = state.updates.points[contact].tangent.map(|row| row.map(|t| -area * t * u.displacement));
    let sigma = stiffness.map(|row| 1.0 / (u.force + row[0].abs() + row[1].abs()));
    let scaled = [0, 1].map(|k| stiffness[k].map(|s| s * sigma[k]));
    (sigma.map(|s| s * u.force), scaled)
}

/// σ (r − A t).
pub(super) fn traction_residual(system: &StepSystem, state: &State, contact: usize) -> [f64; 2] {
    let area = system.problem.contacts[contact].area;
    let (own, _) = traction_row(system, state, contact);
    let traction = state.updates.points[contact].traction;
    [0, 1].map(|k| own[k] * (state.force[contact][k] - area * traction[k]) / system.units().force)
}

/// Greatest difference between forces and what the laws say, beyond rounding of the gaps, relative to the greatest
/// force: between soft blocks a stiff law turns what is small among motions into a share of the forces.
pub(super) fn traction_error(system: &StepSystem, state: &State) -> f64 {
    if system.laws.responses.is_empty() {
        return 0.0;
    }
    let largest = state.force.iter().flatten().map(|r| r.abs()).fold(system.units().force, f64::max);
    let moved = state.motion.iter().flat_map(|q| &q[..2]).chain(state.gap.iter().flatten());
    let moved = moved.fold(0.0, |a: f64, x| a.max(x.abs()));
    // Half of what a certificate allows.
    let rounding = f64::EPSILON * if system.finite() { 256.0 * system.units().length } else { 32.0 * moved };
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

/// Energy that these laws dissipate in a step \[J\].
pub(super) fn dissipated_by_tractions(system: &StepSystem, state: &State) -> f64 {
    let points = state.updates.points.iter().zip(&system.problem.contacts);
    points.map(|(point, c)| c.area * point.dissipated).sum()
}

/// Energy that these laws store \[J\].
pub(super) fn stored_by_tractions(system: &StepSystem, state: &State) -> f64 {
    let points = state.updates.points.iter().zip(&system.problem.contacts);
    points.map(|(point, c)| c.area * point.stored).sum()
}

/// Whether a step from `start` is irreversible at some point.
pub(super) fn tractions_dissipate(system: &StepSystem, state: &State) -> bool {
    let most = 1e-13 * (stored_by_tractions(system, state).abs() + system.units().energy());
    dissipated_by_tractions(system, state) > most
}

/// Points that change what they do between two states.
pub(super) fn branch_changes(system: &StepSystem, start: &State, state: &State) -> usize {
    let of = |state: &State, c: usize| state.updates.points[c].branch;
    system.laws.responses.points().filter(|c| of(start, *c) != of(state, *c)).count()
}

/// Derivative of the dissipated energy by the gaps \[J/m\], by central differences: a law gives none.
/// It steers Newton's method and no answer depends on it.
pub(super) fn dissipation_gradient(system: &StepSystem, start: &State, state: &State) -> Vec<f64> {
    let mut gradient = vec![0.0; 2 * state.gap.len()];
    if system.laws.responses.is_empty() {
        return gradient;
    }
    let length = |c: usize| {
        let moved = (state.gap[c][0] - start.gap[c][0]).hypot(state.gap[c][1] - start.gap[c][1]);
        1e-6 * moved.max(1e-9 * system.units().displacement)
    };
    for k in 0..2 {
        let sides = [1.0, -1.0].map(|side| {
            let mut gaps = state.gap.clone();
            system.laws.responses.points().for_each(|c| gaps[c][k] += side * length(c));
            system.laws.responses.update(&gaps, &start.updates.memory)
        });
        let [Ok(high), Ok(low)] = sides else { continue };
        for c in system.laws.responses.points() {
            let rise = high.points[c].dissipated - low.points[c].dissipated;
            gradient[2 * c + k] = system.problem.contacts[c].area * rise / (2.0 * length(c));
        }
    }
    gradient
}

/// Controls of the gaps of the points that a rate softens, along that rate: monotone through the
/// sharpest snap-back, where the length of the path is not. First all of them, then those alone
/// that begin to. Empty where nothing softens.
pub(super) fn local_controls(
    system: &mut StepSystem,
    state: &State,
    ahead: &State,
    rate: &Tangent,
) -> Vec<LocalControl> {
    let mut moved = ahead.clone();
    if update_tractions(system, state, &mut moved).is_err() {
        return Vec::new();
    }
    let dissipates = |c: &usize| moved.updates.points[*c].dissipated > 0.0;
    let active: Vec<usize> = system.laws.responses.points().filter(dissipates).collect();
    let begins = |c: &usize| moved.updates.points[*c].branch != state.updates.points[*c].branch;
    let new: Vec<usize> = active.iter().copied().filter(begins).collect();
    let mut all: Vec<LocalControl> = LocalControl::along(&active, &rate.gap).into_iter().collect();
    if new.len() < active.len() {
        all.extend(LocalControl::along(&new, &rate.gap));
    }
    all
}

/// Control of the gaps of the points that dissipated in a step, 1 at its end.
pub(super) fn local_control_of_step(system: &StepSystem, start: &State, next: &State) -> Option<LocalControl> {
    let active: Vec<usize> =
        system.laws.responses.points().filter(|c| next.updates.points[*c].dissipated > 0.0).collect();
    let moved: Vec<[f64; 2]> = (0..next.gap.len()).map(|c| [0, 1].map(|k| next.gap[c][k] - start.gap[c][k])).collect();
    LocalControl::along(&active, &moved)
}
