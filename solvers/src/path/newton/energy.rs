//! The energy balance at converged states, and the state as others read it.

use super::blocks::yielded;
use super::derivatives::Gradient;
use super::inelastic::plastic_work;
use super::measure::load_displacement;
use super::response::{dissipated_by_tractions, stored_by_tractions};
use super::state::State;
use super::system::StepSystem;
use voussoir_core::model::geometry::Vec2;
use voussoir_core::path::PathState;

/// Energies so far \[J\].
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct EnergyBalance {
    pub dissipated: f64,
    pub work: f64,
}

impl EnergyBalance {
    /// Adds a step: work of loads and reactions of settled supports by the trapezoidal rule, exact
    /// where they change linearly during the step, and dissipation.
    pub fn add(&mut self, system: &StepSystem, start: &State, state: &State, gradient: [&Gradient; 2]) {
        self.dissipated += dissipated_by_tractions(system, state);
        for contact in 0..state.gap.len() {
            let Some(law) = system.law(contact) else { continue };
            let (kept, _) = law.irreversible(state.mode[contact], system.step_gap(start, state, contact));
            // Where the point yielded before on the same facet, the trapezoidal rule; where it began
            // to, its force when it began is not known: the force at the end.
            let same = start.mode[contact] == state.mode[contact];
            let (end, begun) = (state.force[contact], if same { start.force[contact] } else { state.force[contact] });
            self.dissipated -= 0.5 * ((begun[0] + end[0]) * kept[0] + (begun[1] + end[1]) * kept[1]);
        }
        self.dissipated += plastic_work(system, start, state) * system.units().energy();
        let problem = system.problem;
        let place = |state: &State, gradient: &Gradient, body: usize, slot: Option<usize>, point: Vec2| {
            let rigid = system.geometry.rigid(body, point, &state.motion);
            match slot {
                Some(slot) if !gradient.deformation[body].is_empty() => {
                    let v = &gradient.deformation[body];
                    let theta = if system.finite() { state.motion[body][2] } else { 0.0 };
                    rigid + nalgebra::Rotation2::new(theta) * Vec2::new(v[2 * slot], v[2 * slot + 1])
                }
                _ => rigid,
            }
        };
        let loads = [system.loads.at(start.factor), system.loads.at(state.factor)];
        for ((before, loading), (after, _)) in loads[0].parts.iter().zip(&loads[1].parts) {
            let mean = 0.5 * (before + after);
            for &(body, slot, point, force) in &loading.forces {
                let moved = place(state, gradient[1], body, slot, point) - place(start, gradient[0], body, slot, point);
                self.work += mean * force.dot(&moved);
            }
            for (body, b) in problem.bodies.iter().enumerate() {
                let (from, to) = (start.motion[body], state.motion[body]);
                self.work += mean * b.mass * loading.acceleration.dot(&Vec2::new(to[0] - from[0], to[1] - from[1]));
            }
        }
        for (body, _) in problem.bodies.iter().enumerate().filter(|(_, b)| b.held) {
            for k in 0..3 {
                let reaction = -0.5 * (gradient[0].balance[body][k] + gradient[1].balance[body][k]);
                self.work += reaction * (state.motion[body][k] - start.motion[body][k]);
            }
        }
    }

    /// The state as others read it.
    pub fn recorded(&self, system: &StepSystem, load_step: usize, state: &State, gradient: &Gradient) -> PathState {
        let mut stored = gradient.stored + stored_by_tractions(system, state);
        for contact in 0..state.gap.len() {
            let Some(law) = system.law(contact) else { continue };
            // A tensile strength that opens holds its force reversibly.
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
            dissipated: self.dissipated,
            work: self.work,
            displacement: load_displacement(system, &state.motion),
            memory: state.updates.before.clone(),
            yielded: yielded(&state.blocks),
        }
    }
}
