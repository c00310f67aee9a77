//! Sizes of states, rates and steps in the units of the unknowns: what continuation strategies measure.

use super::inelastic::{plastic_power, plastic_work};
use super::monitors::monitored;
use super::response::dissipated_by_tractions;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;
use voussoir_core::path::Increment;

/// Greatest rate of a body's displacement \[m\]: of its pole, or by its rotation over the scene's size.
pub fn fastest(system: &StepSystem, motion: &[[f64; 3]]) -> f64 {
    let size = system.units().length;
    motion.iter().map(|q| q[0].hypot(q[1]).max(q[2].abs() * size)).fold(0.0, f64::max)
}

/// Work-conjugate displacement of the growing load, or how far supports have moved \[m\].
pub fn load_displacement(system: &StepSystem, motion: &[[f64; 3]], factor: f64) -> f64 {
    let rigid = |body, point| system.geometry.rigid(body, point, motion);
    system.problem.load_displacement((system.loads.growing, factor), motion, rigid)
}

/// Increment between two states in units, and the weights of its derivative: by gaps and directly.
pub fn increment_between(system: &StepSystem, start: &State, state: &State) -> Increment {
    let u = system.units();
    let mut motion = 0.0;
    for body in (0..system.scaled.free.len()).filter(|b| system.scaled.free[*b].is_some()) {
        for k in 0..3 {
            let unit = if k == 2 { u.displacement / u.length } else { u.displacement };
            motion += ((state.motion[body][k] - start.motion[body][k]) / unit).powi(2) / system.scaled.bodies as f64;
        }
    }
    let mut dissipation = dissipated_by_tractions(system, state);
    let points = state.gap.len() as f64;
    for c in 0..state.gap.len() {
        for k in 0..2 {
            motion += ((state.gap[c][k] - start.gap[c][k]) / u.displacement).powi(2) / points;
        }
        if let Some(law) = system.law(c) {
            let (kept, _) = law.irreversible(state.mode[c], system.step_gap(start, state, c));
            dissipation -= kept[0] * state.force[c][0] + kept[1] * state.force[c][1];
        }
    }
    dissipation += plastic_work(system, start, state);
    Increment {
        factor: (state.factor - start.factor) / u.factor,
        displacement: (load_displacement(system, &state.motion, state.factor)
            - load_displacement(system, &start.motion, start.factor))
            / u.displacement,
        motion: motion.sqrt(),
        dissipation: dissipation / u.energy(),
        monitored: monitored(system, start, state),
    }
}

/// Increment of a rate from a state.
pub fn increment_along(system: &StepSystem, state: &State, rate: &Tangent) -> Increment {
    let mut moved = state.clone();
    let mut small = 1e-6 / tangent_size(system, rate).max(1e-300);
    if !system.finite() && system.laws.responses.is_empty() {
        // Everything is linear: from nothing, without a difference of what may be large.
        moved.gap.fill([0.0; 2]);
        moved.motion.fill([0.0; 3]);
        small = 1.0;
    }
    let origin = moved.clone();
    // Linear in a step that is small: displacement and dissipation may not be.
    let step = rate.scaled(small);
    for c in 0..moved.gap.len() {
        (0..2).for_each(|k| moved.gap[c][k] += step.gap[c][k]);
    }
    for (q, dq) in moved.motion.iter_mut().zip(&step.motion) {
        (0..3).for_each(|k| q[k] += dq[k]);
    }
    moved.factor += step.factor;
    // Where the law fails so close to a state, the rest of the rate still counts.
    moved.updates = system.laws.responses.update(&moved.gap, &state.updates.memory).unwrap_or_default();
    let mut base = origin;
    base.slip = base.gap.clone();
    (base.blocks, moved.blocks) = (Vec::new(), Vec::new());
    let i = increment_between(system, &base, &moved);
    Increment {
        factor: rate.factor / system.units().factor,
        displacement: i.displacement / small,
        motion: i.motion / small,
        monitored: i.monitored.map(|value| value / small),
        dissipation: i.dissipation / small + plastic_power(system, state, rate) / system.units().energy(),
    }
}

/// Size of a rate in units, all of it.
pub fn tangent_size(system: &StepSystem, rate: &Tangent) -> f64 {
    let u = system.units();
    let force: f64 = rate.force.iter().flatten().map(|r| (r / u.force).powi(2)).sum();
    motion_size(system, rate).hypot(rate.factor / u.factor).hypot(force.sqrt())
}

/// Size of the motion of a rate in units.
pub fn motion_size(system: &StepSystem, rate: &Tangent) -> f64 {
    let u = system.units();
    let gap: f64 = rate.gap.iter().flatten().map(|g| (g / u.displacement).powi(2)).sum();
    let motion: f64 = rate
        .motion
        .iter()
        .map(|q| (q[0].powi(2) + q[1].powi(2) + (q[2] * u.length).powi(2)) / u.displacement.powi(2))
        .sum();
    (gap + motion).sqrt()
}
