//! Whether a step is short enough for its energy: work is integrated by the trapezoidal rule, what is stored is a
//! function of the state.

use super::recorded::recorded;
use super::state::State;
use super::tracer::{Tracer, foreseen};

/// Share of the energy of a stage that a step may leave over before the next one is made shorter, and that the stage
/// may, half of what a certificate allows.
const STEP: f64 = 1e-4;
const STAGE: f64 = 5e-4;
/// Energies below this share of the unit of energy, and of those of the stage, are rounding.
const NOTHING: f64 = 1e-9;
const ROUNDING: f64 = 1e-9;

/// How well a step keeps the energy of its stage.
pub(super) struct StepEnergy {
    /// By how much the next step may grow (below 1: must shrink).
    pub growth: f64,
    /// Whether the step may stand.
    pub holds: bool,
}

/// Of a step that converged.
pub(super) fn step_energy(tracer: &mut Tracer, next: &State) -> StepEnergy {
    let gradient = tracer.system.gradient(next);
    let (energy, _) = foreseen(tracer, next, &gradient);
    let after = recorded(&energy, &tracer.system, tracer.load_step, next, &gradient);
    let (problem, finite, before) = (tracer.system.problem, tracer.system.finite(), &tracer.record.state);
    let (balance, left) = tracer.record.balance.after(problem, finite, before, &after);
    let scale = balance.scale(after.stored).max(NOTHING * tracer.system.units().energy());
    let growth = (STEP * scale / left.abs().max(1e-300)).sqrt();
    // Bonds that soften are followed more closely step by step.
    let most = if tracer.system.laws.responses.is_empty() { STAGE } else { STEP };
    let moved = problem.gross_work(before, &after, finite) + (after.dissipated - before.dissipated).abs();
    let in_budget = left.abs() <= most * scale && balance.left().abs() <= STAGE * scale;
    StepEnergy { growth, holds: in_budget || left.abs() <= (most * moved).max(ROUNDING * scale) }
}
