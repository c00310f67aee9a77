//! The last row of the linear equations of a step: the gradient of its control.

use super::control::Control;
use super::equations::Equations;
use super::inelastic::add_plastic_work;
use super::measure::increment_between;
use super::monitors::by_motion;
use super::response::dissipation_gradient;
use super::state::State;
use super::system::StepSystem;
use voussoir_core::path::{Constraint, Increment};

/// The row of a control over the scaled unknowns, at a state: the gradient of its constraint.
pub(super) fn control_row(
    system: &StepSystem,
    start: &State,
    state: &State,
    control: &Control,
    constraint: &Constraint,
    equations: &Equations,
) -> Vec<f64> {
    let mut row = vec![0.0; system.size()];
    let mut by_gap = vec![0.0; 2 * state.gap.len()];
    let by = constraint.derivative;
    row[system.size() - 1] += by.factor;
    if by.motion != 0.0 {
        add_size_of_motion(system, (start, state), by.motion, &mut row, &mut by_gap);
    }
    if by.dissipation != 0.0 {
        add_dissipation(system, (start, state), by.dissipation, &mut row, &mut by_gap);
    }
    if by.displacement != 0.0 {
        add_load_displacement(system, state, by.displacement, &mut row);
    }
    for (by, monitor) in by.monitored.iter().zip(&system.monitors).filter(|(by, _)| **by != 0.0) {
        for &(c, weight) in &monitor.gaps {
            by_gap[2 * c] += by * weight / system.units().displacement;
        }
        if let Some((body, point, direction)) = monitor.point {
            add_by_motion(system, body, by_motion(system, state, body, point, direction), *by, &mut row);
        }
    }
    if let Control::Along { row: along, .. } = control {
        row.iter_mut().zip(along.iter()).for_each(|(row, value)| *row += value);
    }
    if let Control::Gaps { local, .. } = control {
        by_gap.iter_mut().zip(&local.by_gap).for_each(|(w, local)| *w += local);
    }
    add_weighted_gaps(system, &mut row, &by_gap, equations);
    if matches!(control, Control::Mixed { .. }) {
        row.iter_mut().zip(&equations.factor).for_each(|(row, value)| *row += value);
    }
    row
}

/// Adds the gradient of the root mean square of motions and gaps.
fn add_size_of_motion(
    system: &StepSystem,
    (start, state): (&State, &State),
    by: f64,
    row: &mut [f64],
    by_gap: &mut [f64],
) {
    let (u, points) = (system.units(), state.gap.len());
    let value = increment_between(system, start, state).motion.max(1e-300);
    for body in 0..system.scaled.free.len() {
        let Some(free) = system.scaled.free[body] else { continue };
        for (k, unit) in u.motion().into_iter().enumerate() {
            let delta = (state.motion[body][k] - start.motion[body][k]) / unit;
            row[2 * points + 3 * free + k] += by * delta / (value * system.scaled.bodies as f64);
        }
    }
    for c in 0..points {
        for k in 0..2 {
            let delta = (state.gap[c][k] - start.gap[c][k]) / u.displacement;
            by_gap[2 * c + k] += by * delta / (value * points as f64 * u.displacement);
        }
    }
}

/// Adds the gradient of the dissipated energy.
fn add_dissipation(
    system: &StepSystem,
    (start, state): (&State, &State),
    by: f64,
    row: &mut [f64],
    by_gap: &mut [f64],
) {
    let (u, energy) = (system.units(), system.units().energy());
    let gradient = dissipation_gradient(system, start, state);
    by_gap.iter_mut().zip(gradient).for_each(|(w, slope)| *w += by * slope / energy);
    for c in 0..state.gap.len() {
        let Some(law) = system.law(c) else { continue };
        let (kept, _) = law.irreversible(state.mode[c], system.step_gap(start, state, c));
        if kept != [0.0; 2] {
            for k in 0..2 {
                row[2 * c + k] -= by * kept[k] * u.force / energy;
                by_gap[2 * c + k] -= by * state.force[c][k] / energy;
            }
        }
    }
    add_plastic_work(system, row, state, by / energy);
}

/// Adds the gradient of the work-conjugate displacement of the growing load, or of how far supports have moved.
fn add_load_displacement(system: &StepSystem, state: &State, by: f64, row: &mut [f64]) {
    let loading = system.loads.growing;
    let load = system.problem.load_size(loading);
    if load == 0.0 {
        let u = system.units();
        row[system.size() - 1] += by * system.problem.settlement_size(loading) * u.factor / u.displacement;
        return;
    }
    let scale = by / load.max(1e-300);
    let mut wrench = vec![[0.0; 3]; system.scaled.free.len()];
    for &(body, _, point, force) in &loading.forces {
        let own = by_motion(system, state, body, point, force);
        wrench[body].iter_mut().zip(own).for_each(|(w, own)| *w += own);
    }
    for (body, b) in system.problem.bodies.iter().enumerate() {
        wrench[body][0] += b.mass * loading.acceleration.x;
        wrench[body][1] += b.mass * loading.acceleration.y;
        add_by_motion(system, body, wrench[body], scale, row);
    }
}

/// Adds weights of the motion of a body, in the unit of displacement.
fn add_by_motion(system: &StepSystem, body: usize, weights: [f64; 3], scale: f64, row: &mut [f64]) {
    let Some(free) = system.scaled.free[body] else { return };
    for (k, weight) in weights.into_iter().enumerate() {
        let unit = if k == 2 { 1.0 / system.units().length } else { 1.0 };
        row[2 * system.scaled.contacts + 3 * free + k] += scale * weight * unit;
    }
}

/// Adds weighted gaps to a row over the scaled unknowns.
pub(super) fn add_weighted_gaps(system: &StepSystem, row: &mut [f64], by_gap: &[f64], equations: &Equations) {
    if by_gap.iter().all(|w| *w == 0.0) {
        return;
    }
    let weights: Vec<f64> = by_gap.iter().map(|weight| weight * system.units().displacement).collect();
    equations.gaps.add_weighted(&weights, row);
}

/// How far a control is from its aim, and its constraint.
pub(super) fn control_value(system: &StepSystem, start: &State, state: &State, control: &Control) -> (f64, Constraint) {
    match control {
        Control::Factor(target) => {
            let derivative = Increment { factor: 1.0, ..Increment::default() };
            ((state.factor - target) / system.units().factor, Constraint { value: 0.0, derivative })
        }
        Control::Strategy { strategy, previous, length } => {
            let c = strategy.constraint(&increment_between(system, start, state), previous.as_ref());
            (c.value - length, c)
        }
        Control::Along { row, length } => (along(system, start, state, row) - length, Constraint::default()),
        Control::Gaps { local, length } => (local.value(start, state) - length, Constraint::default()),
        Control::Mixed { weight, length } => {
            let derivative = Increment { factor: *weight, ..Increment::default() };
            let value =
                weight * (state.factor - start.factor) / system.units().factor + work_between(system, start, state);
            (value - length, Constraint { value, derivative })
        }
    }
}

/// row · (x − x_start) over the scaled motions and the scaled factor.
fn along(system: &StepSystem, start: &State, state: &State, row: &[f64]) -> f64 {
    let u = system.units();
    let first = 2 * system.scaled.contacts;
    let of_body = |(body, free): (usize, &Option<usize>)| -> f64 {
        let Some(free) = free else { return 0.0 };
        let unit = u.motion();
        let moved = |k: usize| (state.motion[body][k] - start.motion[body][k]) / unit[k];
        (0..3).map(|k| row[first + 3 * free + k] * moved(k)).sum()
    };
    let motions: f64 = system.scaled.free.iter().enumerate().map(of_body).sum();
    motions + row[row.len() - 1] * (state.factor - start.factor) / u.factor
}

/// ∂Π/∂λ of differences of forces and motions, in units: p·Δq + g_p·Δr (small displacements).
fn load_work(system: &StepSystem, force: impl Fn(usize, usize) -> f64, motion: impl Fn(usize, usize) -> f64) -> f64 {
    let Some(equations) = &system.cache.equations else { return 0.0 };
    let (u, forces) = (system.units(), 2 * system.scaled.contacts);
    let by_force = |i: usize| equations.factor[i] * force(i / 2, i % 2) / u.force;
    let by_motion = |(body, free): (usize, &Option<usize>)| -> f64 {
        let Some(free) = free else { return 0.0 };
        let unit = u.motion();
        (0..3).map(|k| equations.factor[forces + 3 * free + k] * motion(body, k) / unit[k]).sum()
    };
    (0..forces).map(by_force).sum::<f64>() + system.scaled.free.iter().enumerate().map(by_motion).sum::<f64>()
}

/// ∂Π/∂λ between two states, in units.
fn work_between(system: &StepSystem, start: &State, state: &State) -> f64 {
    load_work(system, |c, k| state.force[c][k] - start.force[c][k], |b, k| state.motion[b][k] - start.motion[b][k])
}
