//! Energies of the steps of a damped descent. The decrease of the potential of constant loads is the sum of the work of
//! friction and the work of the viscous wrenches. Both works follow from the trapezoidal rule, so that a step which is
//! too long leaves an energy error.

use crate::path::energy::{EnergyBalance, WorkState};
use crate::path::newton::model::loads::Damping;
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use crate::path::newton::quantities::recorded::{energy_after, recorded, work_state};
use crate::settings::SETTINGS;

/// The data of a state of a descent for the energies of a step that starts or ends at it.
pub struct DescentState {
    /// Data for the work of loads.
    work: WorkState,
    /// Stored energy \[J\].
    stored: f64,
    /// Viscous force on each motion, in units; empty if the state has none.
    viscous: Vec<f64>,
}

impl DescentState {
    /// Evaluates a state and its viscous forces.
    pub fn of(system: &StepSystem, state: &State, damping: Option<&Damping>) -> Self {
        let gradient = system.gradient(state);
        let stored = recorded(&EnergyBalance::default(), system, 0, state, &gradient).stored;
        let forces = |damping: &Damping| {
            free_motions(system, &damping.from, &state.motion).map(|motion| damping.rate * motion).collect()
        };
        DescentState {
            work: work_state(system, state, &gradient),
            stored,
            viscous: damping.map(forces).unwrap_or_default(),
        }
    }
}

/// Energies of a step of a descent.
#[derive(Debug, Clone, Copy)]
pub struct DescentStep {
    /// Decrease of the potential \[J\].
    pub fall: f64,
    /// Work of friction \[J\].
    pub dissipated: f64,
    /// Error of the balance of these and the work of the viscous wrenches, relative to the accepted one.
    pub error: f64,
}

/// Returns the energies of a step between two states.
pub fn descent_step(
    system: &StepSystem,
    (start, from): (&State, &DescentState),
    (state, to): (&State, &DescentState),
) -> DescentStep {
    let energy = energy_after(EnergyBalance::default(), system, (start, &from.work), (state, &to.work));
    let fall = energy.work - (to.stored - from.stored);
    let force = |k: usize| 0.5 * [from, to].iter().filter_map(|end| end.viscous.get(k)).sum::<f64>();
    let motions = free_motions(system, &start.motion, &state.motion);
    let viscous: f64 = motions.enumerate().map(|(k, motion)| force(k) * motion).sum();
    let unit = system.units().energy();
    let error = (fall - energy.dissipated - viscous * unit).abs();
    let rounding = SETTINGS.admissible * to.stored.abs().max(unit);
    let allowed = SETTINGS.small * fall.abs().max(energy.dissipated) + rounding;
    DescentStep { fall, dissipated: energy.dissipated, error: error / allowed }
}

/// Returns the motions of the free bodies from one state to another, in their units.
pub fn free_motions<'a>(
    system: &'a StepSystem,
    from: &'a [[f64; 3]],
    to: &'a [[f64; 3]],
) -> impl Iterator<Item = f64> + 'a {
    let units = system.units().motion();
    let free = (0..to.len()).filter(|body| system.scaled.free[*body].is_some());
    free.flat_map(move |body| (0..3).map(move |k| (to[body][k] - from[body][k]) / units[k]))
}
