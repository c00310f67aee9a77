//! Continuation strategies: how a path solver chooses the next point of a path.
//!
//! A strategy is a pure function of the increment since the last converged state, in units that do
//! not depend on the unit system (see [`Increment`](voussoir_core::path::Increment)). The solver
//! keeps the length of the step.

/// Implements the lengths of steps by the keys `first_step` and `largest_step`.
macro_rules! step_lengths {
    () => {
        fn first_step(&self) -> f64 {
            self.first_step
        }

        fn largest_step(&self) -> f64 {
            self.largest_step.unwrap_or(f64::INFINITY)
        }
    };
}

pub mod arc_length;
pub mod crack_opening;
pub mod displacement_control;
pub mod dissipation;
pub mod load_control;

use voussoir_core::plugin::Keys;

/// Keys that strategies share.
#[derive(Debug, Keys)]
pub struct StepKeys {
    /// first step of a load step, as a share of the load's own size taken up elastically
    #[key(unit = "-", range = "> 0", default = 0.1)]
    first_step: f64,
    /// greatest movement in a step, as a share of the scene's size
    #[key(unit = "-", range = "> 0", optional = "without bound with small displacements, 0.002 with finite ones")]
    largest_step: Option<f64>,
}

/// Movement in a step with finite displacements if the strategy sets no bound, as a share of the size of the scene.
pub const LARGEST_FINITE_STEP: f64 = crate::settings::SETTINGS.largest_finite_step;

#[cfg(test)]
mod tests;
