//! Continuation strategies: how a path solver chooses the next point of a path.
//!
//! A strategy is a pure function of the increment since the last converged state, in units that do
//! not depend on the unit system (see [`Increment`](voussoir_core::path::Increment)). The solver
//! keeps the length of the step.

pub mod arc_length;
pub mod crack_opening;
pub mod displacement_control;
pub mod dissipation;
pub mod load_control;

use voussoir_core::plugin::{Parameter, Quantity, Range};

const FIRST_STEP: Parameter = Parameter::number(
    "first_step",
    Quantity::Ratio,
    Range::POSITIVE,
    "first step of a load step, as a share of the load's own size taken up elastically",
)
.default("0.1");

const LARGEST_STEP: Parameter = Parameter::number(
    "largest_step",
    Quantity::Ratio,
    Range::POSITIVE,
    "greatest movement in a step, as a share of the scene's size",
)
.optional("without bound with small displacements, 0.002 with finite ones");

/// Movement in a step with finite displacements if the strategy sets no bound, as a share of the size of the scene.
pub const LARGEST_FINITE_STEP: f64 = crate::settings::SETTINGS.largest_finite_step;

fn first_step() -> f64 {
    0.1
}

#[cfg(test)]
mod tests;
