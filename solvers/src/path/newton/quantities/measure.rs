//! Sizes of states, rates and steps in the units of the unknowns, for continuation strategies.

use super::inelastic::{plastic_power, plastic_work};
use super::monitors::monitored;
use super::response::dissipated_by;
use crate::path::newton::model::state::{State, Tangent};
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::model::tractions::update;
use voussoir_core::path::Increment;

/// Returns the greatest rate of a body's displacement \[m\]: of its pole, or by its rotation over the scene's size.
pub fn fastest(system: &StepSystem, motion: &[[f64; 3]]) -> f64 {
    let size = system.units().length;
    motion.iter().map(|q| q[0].hypot(q[1]).max(q[2].abs() * size)).fold(0.0, f64::max)
}

/// Returns the work-conjugate displacement of the growing load, or the movement of the supports \[m\].
pub fn load_displacement(system: &StepSystem, motion: &[[f64; 3]], factor: f64) -> f64 {
    let rigid = |body, point| system.geometry.rigid(body, point, motion);
    system.problem.load_displacement((system.loads.growing, factor), motion, rigid)
}

/// Returns the mean of the changes of motions and gaps in their units.
fn mean_change(system: &StepSystem, motion: impl Fn(usize, usize) -> f64, gap: impl Fn(usize, usize) -> f64) -> f64 {
    let (u, points) = (system.units(), system.scaled.contacts);
    let units = u.motion();
    let free = (0..system.scaled.free.len()).filter(|body| system.scaled.free[*body].is_some());
    let motions: f64 =
        free.flat_map(|body| (0..3).map(move |k| (body, k))).map(|(b, k)| (motion(b, k) / units[k]).powi(2)).sum();
    let gaps: f64 = (0..2 * points).map(|i| (gap(i / 2, i % 2) / u.displacement).powi(2)).sum();
    (motions / system.scaled.bodies.max(1) as f64 + gaps / points.max(1) as f64).sqrt()
}

/// Returns the work of contact forces on the irreversible part of changes of gaps, for laws of facets \[J\].
fn dissipated_by_facets(system: &StepSystem, state: &State, gap: impl Fn(usize) -> [f64; 2]) -> f64 {
    let at_point = |c: usize| {
        let (kept, _) = system.law(c)?.irreversible(state.mode[c], gap(c));
        Some(-(kept[0] * state.force[c][0] + kept[1] * state.force[c][1]))
    };
    (0..state.gap.len()).filter_map(at_point).sum()
}

/// Returns the increment between two states in units.
pub fn increment_between(system: &StepSystem, start: &State, state: &State) -> Increment {
    let u = system.units();
    let place = |of: &State, body: usize, point| system.geometry.rigid(body, point, &of.motion);
    let dissipation = dissipated_by(system, &state.updates)
        + dissipated_by_facets(system, state, |c| system.step_gap(start, state, c))
        + plastic_work(start, state);
    Increment {
        factor: (state.factor - start.factor) / u.factor,
        displacement: (load_displacement(system, &state.motion, state.factor)
            - load_displacement(system, &start.motion, start.factor))
            / u.displacement,
        motion: mean_change(
            system,
            |body, k| state.motion[body][k] - start.motion[body][k],
            |c, k| state.gap[c][k] - start.gap[c][k],
        ),
        dissipation: dissipation / u.energy(),
        monitored: monitored(
            system,
            |c| state.gap[c][0] - start.gap[c][0],
            |body, point| place(state, body, point) - place(start, body, point),
        ),
    }
}

/// Returns the increment of a rate from a state.
pub fn increment_along(system: &StepSystem, state: &State, rate: &Tangent) -> Increment {
    let u = system.units();
    let velocity = |body, point| system.geometry.velocity(body, point, &state.motion, &rate.motion);
    let moved = system.problem.load_displacement((system.loads.growing, rate.factor), &rate.motion, velocity);
    // The dissipation of bonds is computed in a small step. If the law fails there, the rest still counts.
    let small = 1e-6 / tangent_size(system, rate).max(1e-300);
    let ahead = |(g, dg): (&[f64; 2], &[f64; 2])| [0, 1].map(|k| g[k] + small * dg[k]);
    let gaps: Vec<[f64; 2]> = state.gap.iter().zip(&rate.gap).map(ahead).collect();
    let updates =
        update(&system.laws.responses, &gaps, &state.updates.memory, &system.instant(state)).unwrap_or_default();
    let dissipation = dissipated_by(system, &updates) / small
        + dissipated_by_facets(system, state, |c| rate.gap[c])
        + plastic_power(system, state, rate);
    Increment {
        factor: rate.factor / u.factor,
        displacement: moved / u.displacement,
        motion: mean_change(system, |body, k| rate.motion[body][k], |c, k| rate.gap[c][k]),
        dissipation: dissipation / u.energy(),
        monitored: monitored(system, |c| rate.gap[c][0], velocity),
    }
}

/// Returns the size of a rate in units, over all unknowns.
pub fn tangent_size(system: &StepSystem, rate: &Tangent) -> f64 {
    let u = system.units();
    let force: f64 = rate.force.iter().flatten().map(|r| (r / u.force).powi(2)).sum();
    motion_size(system, rate).hypot(rate.factor / u.factor).hypot(force.sqrt())
}

/// Returns the size of the motion of a rate in units.
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
