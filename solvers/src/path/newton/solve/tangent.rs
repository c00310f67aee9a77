//! Rates of converged states with their contact modes held, and the modes that a state requires.

use super::nearby::{Accuracy, solve};
use crate::contact::mode::ContactMode;
use crate::linear::largest;
use crate::path::newton::model::control::Control;
use crate::path::newton::model::equations::Equations;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::control_row::control_row;
use crate::settings::SETTINGS;
use std::rc::Rc;

pub fn apply_step(system: &StepSystem, state: &mut State, step: &[f64], share: f64) {
    add_step(system, &mut state.force, &mut state.motion, step, share);
    if share == 1.0 {
        // Removes the rounding error of a force that the mode determines.
        for (c, force) in state.force.iter_mut().enumerate() {
            if let Some(corner) = system.law(c).and_then(|law| law.corner(state.mode[c])) {
                let area = system.problem.contacts[c].area;
                *force = corner.map(|r| r * area);
            }
        }
    }
    state.factor += share * step[step.len() - 1] * system.units().factor;
    system.settle(&mut state.motion, state.factor);
}

/// Adds a share of a solution of the linear equations to forces and motions of the free bodies.
fn add_step(system: &StepSystem, force: &mut [[f64; 2]], motion: &mut [[f64; 3]], step: &[f64], share: f64) {
    let u = system.units();
    let points = force.len();
    for (c, force) in force.iter_mut().enumerate() {
        (0..2).for_each(|k| force[k] += share * step[2 * c + k] * u.force);
    }
    for (body, motion) in motion.iter_mut().enumerate() {
        let Some(free) = system.scaled.free[body] else { continue };
        for (k, motion) in motion.iter_mut().enumerate() {
            let unit = if k == 2 { u.displacement / u.length } else { u.displacement };
            *motion += share * step[2 * points + 3 * free + k] * unit;
        }
    }
}

/// Returns the rounding error of gaps, which are differences of motions \[m\].
pub fn gap_rounding(system: &StepSystem, state: &State) -> f64 {
    let gaps = state.gap.iter().flatten().map(|g| g.abs());
    let motions = state.motion.iter().map(|q| q[0].abs().max(q[1].abs()).max(q[2].abs() * system.units().length));
    8.0 * f64::EPSILON * gaps.chain(motions).fold(0.0, f64::max)
}

/// Returns the modes that the present forces and gaps require, and true if the laws hold in them: if flow is not
/// associated, the nearest mode need not be that of the return.
pub fn wanted_modes(system: &mut StepSystem, start: &State, state: &State) -> (Vec<ContactMode>, bool) {
    system.count("law_evaluations", state.gap.len() as u64);
    let greatest = largest(state.force.as_flattened());
    let unit = system.units().force;
    let weak = greatest <= system.limits.weak * unit;
    let greatest = greatest.max(if weak { SETTINGS.residual() * unit } else { unit });
    let rounding = gap_rounding(system, state);
    let mut holds = true;
    let modes = (0..state.gap.len())
        .map(|c| match system.law(c) {
            None => ContactMode::Stick,
            Some(law) => {
                // In a solution any ρ > 0 gives the same modes, unless rounding of a gap becomes a force.
                let stiffness = system.stiffness(c);
                let noise = rounding * stiffness[0].max(stiffness[1]);
                let rho = stiffness.map(|k| k * (SETTINGS.mode * greatest / noise).min(1.0));
                let gap = system.step_gap(start, state, c);
                let z = [state.force[c][0] - rho[0] * gap[0], state.force[c][1] - rho[1] * gap[1]];
                let tolerance = noise.clamp(1e-11 * greatest, SETTINGS.mode * greatest);
                let area = system.problem.contacts[c].area;
                let mode = law.mode(state.mode[c], z, rho, area, tolerance);
                holds &= mode != state.mode[c] || law.violation(mode, z, rho, area) <= tolerance;
                mode
            }
        })
        .collect();
    (modes, holds)
}

/// Returns the tangent of a converged state with its modes held, per unit of the control's gradient.
pub fn tangent_at(system: &mut StepSystem, state: &State, control: &Control, accuracy: Accuracy) -> Option<Tangent> {
    let equations = system.equations(state);
    let row = control_row(system, control, &equations);
    tangent_of_modes(system, state, &equations, &row, accuracy)
}

/// Returns the tangent of a state with its modes held, per unit of `row`.
pub fn tangent_of_modes(
    system: &mut StepSystem,
    state: &State,
    equations: &Rc<Equations>,
    row: &[f64],
    accuracy: Accuracy,
) -> Option<Tangent> {
    let mut right = vec![0.0; system.size()];
    *right.last_mut()? = 1.0;
    let (x, _) = solve(system, state, equations, (row, &right), accuracy).filter(|(_, solved)| *solved)?;
    Some(tangent_from(system, &x, state, equations))
}

/// Returns forces, motions and the factor of a solution of the linear equations, without the gaps.
pub fn tangent_without_gaps(system: &StepSystem, x: &[f64]) -> Tangent {
    let points = system.problem.contacts.len();
    let (mut force, mut motion) = (vec![[0.0; 2]; points], vec![[0.0; 3]; system.scaled.free.len()]);
    add_step(system, &mut force, &mut motion, x, 1.0);
    let factor = x[x.len() - 1] * system.units().factor;
    for (body, settlement) in &system.loads.growing.settlements {
        (0..3).for_each(|k| motion[*body][k] += factor * settlement[k]);
    }
    Tangent { force, motion, factor, gap: Vec::new() }
}

/// Returns the rate of a solution of the linear equations.
pub fn tangent_from(system: &StepSystem, x: &[f64], state: &State, equations: &Equations) -> Tangent {
    let along = equations.gaps.product(x);
    let gap = (0..state.gap.len()).map(|c| [along[2 * c], along[2 * c + 1]].map(|g| g * system.units().displacement));
    let gap = gap.collect();
    Tangent { gap, ..tangent_without_gaps(system, x) }
}
