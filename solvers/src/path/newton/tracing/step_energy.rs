//! Checks the length of a step by its energy balance: work is integrated by the trapezoidal rule.

use super::tracer::{Tracer, foreseen};
use crate::path::newton::model::state::State;
use crate::path::newton::quantities::recorded::recorded;
use crate::settings::SETTINGS;

/// The energy error of a step, relative to its stage.
pub struct StepEnergy {
    /// Factor on the length of the next step (below 1 it must shrink).
    pub growth: f64,
    /// True if the step is accepted.
    pub holds: bool,
}

/// Evaluates a converged step.
pub fn step_energy(tracer: &mut Tracer, next: &State) -> StepEnergy {
    let gradient = tracer.system.gradient(next);
    let (energy, _) = foreseen(tracer, next, &gradient);
    let after = recorded(&energy, &tracer.system, tracer.in_force.load_step, next, &gradient);
    let (problem, finite, before) = (tracer.system.problem, tracer.settings.finite, &tracer.record.state);
    let (balance, left) = tracer.record.balance.after(problem, finite, before, &after);
    let scale = balance.scale(after.stored).max(SETTINGS.admissible * tracer.system.units().energy());
    let growth = (SETTINGS.fine * scale / left.abs().max(1e-300)).sqrt();
    let most = tracer.system.limits.energy;
    let moved = problem.gross_work(before, &after, finite) + (after.dissipated - before.dissipated).abs();
    let in_budget = left.abs() <= most * scale && balance.left().abs() <= SETTINGS.energy_of_stage * scale;
    StepEnergy { growth, holds: in_budget || left.abs() <= (most * moved).max(SETTINGS.admissible * scale) }
}
