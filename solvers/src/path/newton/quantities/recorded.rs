//! Records of converged states: their energies, and the state for results.

use super::inelastic::plastic_work;
use super::measure::load_displacement;
use super::response::{dissipated_by, stored_by_tractions, supplied_by};
use crate::path::energy::{EnergyBalance, WorkState};
use crate::path::newton::model::blocks::yielded;
use crate::path::newton::model::derivatives::Gradient;
use crate::path::newton::model::state::State;
use crate::path::newton::model::system::StepSystem;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::{Loading, PathState};

/// Returns the data of a state for the work of a step.
pub fn work_state(system: &StepSystem, state: &State, gradient: &Gradient) -> WorkState {
    let place = |&(body, slot, point, _): &(usize, Option<usize>, Vec2, Vec2)| {
        let rigid = system.geometry.rigid(body, point, &state.motion);
        match slot {
            Some(slot) if !gradient.deformation[body].is_empty() => {
                let v = &gradient.deformation[body];
                rigid + system.geometry.turn(state.motion[body][2]) * Vec2::new(v[2 * slot], v[2 * slot + 1])
            }
            _ => rigid,
        }
    };
    let parts = system.loads.at(state.factor).parts;
    WorkState {
        factors: parts.iter().map(|(factor, _)| *factor).collect(),
        displacements: parts.iter().map(|(_, loading)| loading.forces.iter().map(place).collect()).collect(),
        motion: state.motion.clone(),
        unbalanced: gradient.balance.clone(),
    }
}

/// Returns the energies after a step: work between its ends, and dissipation.
pub fn energy_after(
    before: EnergyBalance,
    system: &StepSystem,
    (start, from): (&State, &WorkState),
    (state, to): (&State, &WorkState),
) -> EnergyBalance {
    let mut energy = before;
    energy.dissipated += dissipated_by(system, &state.updates);
    energy.work += supplied_by(system, &state.updates);
    for contact in 0..state.gap.len() {
        let Some(law) = system.law(contact) else { continue };
        let (kept, _) = law.irreversible(state.mode[contact], system.step_gap(start, state, contact));
        // Trapezoidal rule if the point yielded before on the same facet, or yields from zero force. Otherwise its
        // force at the start of yielding is unknown: the force at the end is used.
        let from_nothing = start.force[contact] == [0.0; 2] && law.facets.iter().all(|f| f.bound == 0.0);
        let same = from_nothing || start.mode[contact] == state.mode[contact];
        let (end, begun) = (state.force[contact], if same { start.force[contact] } else { state.force[contact] });
        energy.dissipated -= 0.5 * ((begun[0] + end[0]) * kept[0] + (begun[1] + end[1]) * kept[1]);
    }
    energy.dissipated += plastic_work(start, state);
    let loadings: Vec<&Loading> = system.loads.at(state.factor).parts.iter().map(|(_, loading)| *loading).collect();
    energy.add_work(system.problem, &loadings, from, to);
    energy
}

/// Returns the state for results.
pub fn recorded(
    energy: &EnergyBalance,
    system: &StepSystem,
    load_step: usize,
    state: &State,
    gradient: &Gradient,
) -> PathState {
    let mut stored = gradient.stored + stored_by_tractions(system, state);
    for contact in 0..state.gap.len() {
        let Some(law) = system.law(contact) else { continue };
        // A tensile strength that opens keeps its force reversibly.
        let gap = [state.gap[contact][0] - state.slip[contact][0], 0.0];
        if law.opens(state.mode[contact]) && state.force[contact][0] < 0.0 {
            stored -= state.force[contact][0] * gap[0].max(0.0);
        }
    }
    PathState {
        load_step,
        factor: state.factor,
        force: state.force.clone(),
        gap: state.gap.clone(),
        motion: state.motion.clone(),
        stored,
        dissipated: energy.dissipated,
        work: energy.work,
        displacement: load_displacement(system, &state.motion, state.factor),
        memory: state.updates.before.clone(),
        step_gap: state.updates.previous_gap.clone(),
        time_step: state.updates.time_step,
        yielded: yielded(&state.blocks),
        stable_under_load: None,
    }
}
